"""Weights that were made elsewhere become genomes, and weights of organisms go elsewhere."""

from pathlib import Path

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


def test_numbers_that_are_no_weights_are_an_error_that_says_so(
    tmp_path: Path, state: dict[str, np.ndarray]
) -> None:
    """`test_files.py` has blocks of other shapes, and numbers that are not finite."""
    path, says = tmp_path / "state.safetensors", "output has the type I64; weights have F32"
    save_file({**state, "output": np.ones((2, 32), np.int64)}, path)
    chosen = load(TASK)
    with pytest.raises(InputError, match=says):
        genomes.of_state(path, chosen.build_layout(chosen.build_habitat()))
    complains(here("import", path, tmp_path / "no", "--task", TASK), 2, says)
    assert not (tmp_path / "no").exists()
