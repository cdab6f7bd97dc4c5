"""Weights that were made elsewhere become genomes, and weights of organisms go elsewhere."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from primordia.brains import genomes
from primordia.config import load
from primordia.errors import InputError
from tests.commands import complains, here

TASK = "CartPole-survival"


@pytest.fixture
def state() -> dict[str, np.ndarray]:
    chosen = load(TASK)
    rng = np.random.default_rng(0)
    blocks = chosen.build_layout(chosen.build_habitat()).blocks
    return {name: rng.normal(size=shape) for name, shape in blocks}


def test_a_state_dictionary_becomes_a_genome(tmp_path: Path, state: dict[str, np.ndarray]) -> None:
    path, file = tmp_path / "state.safetensors", tmp_path / "genome.safetensors"
    save_file(state, path)
    assert here("import", path, file, "--task", TASK).returncode == 0
    for name, block in load_file(file).items():
        np.testing.assert_array_equal(block, state[name][None].astype(np.float32))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"input": "turned"}, "transpose the block"),
        ({"output": np.full((2, 32), np.nan)}, "not finite numbers"),
        ({"output": np.ones((2, 32), np.int64)}, "output has the type I64; weights have F32"),
    ],
)
def test_what_does_not_fit_is_named(
    tmp_path: Path, state: dict[str, np.ndarray], change: dict[str, Any], says: str
) -> None:
    for name, value in change.items():
        turned = isinstance(value, str)
        state[name] = np.ascontiguousarray(state[name].T) if turned else value
    path = tmp_path / "state.safetensors"
    save_file(state, path)
    chosen = load(TASK)
    with pytest.raises(InputError, match=says):
        genomes.of_state(path, chosen.build_layout(chosen.build_habitat()))
    complains(here("import", path, tmp_path / "no", "--task", TASK), 2, says)
    assert not (tmp_path / "no").exists()
