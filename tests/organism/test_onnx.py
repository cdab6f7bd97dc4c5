"""Brains as ONNX models, run by ONNX Runtime."""

import sys
from pathlib import Path
from typing import Any

import jax
import numpy as np
import onnxruntime
import pytest

import primordia
from primordia.law.law import Law
from primordia.organism.policy import Policy
from tests.brains.test_contract import TABLES
from tests.commands import complains, here
from tests.worlds import MILL, config

TICKS = 50
QUICK = ("plastic",)
"""A brain whose model has most operations of the others, which are slow."""


@pytest.fixture(autouse=True, scope="module")
def _examples() -> None:
    """Load jax2onnx without random numbers and equinox. Its examples with both compile for seconds."""

    def zeros(
        key: jax.Array, shape: tuple[int, ...] = (), dtype: Any = float, **_: Any
    ) -> jax.Array:
        return jax.numpy.asarray(np.zeros(shape, dtype))

    with pytest.MonkeyPatch.context() as patch, jax.default_prng_impl("unsafe_rbg"):
        for kind in ("uniform", "normal"):
            patch.setattr(jax.random, kind, zeros)
        patch.setitem(sys.modules, "equinox", None)
        import jax2onnx

        jax2onnx.to_onnx(lambda senses: senses, [(1,)])


def law_of(**values: object) -> Law:
    settings = config({**MILL, **values})
    return settings.build_law(settings.build_habitat())


def session(file: Path) -> onnxruntime.InferenceSession:
    return onnxruntime.InferenceSession(file, providers=["CPUExecutionProvider"])


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in TABLES],
)
def test_a_model_acts_tick_for_tick_as_the_policy_does(name: str, tmp_path: Path) -> None:
    """Rounding differs between programs, so each tick begins with the policy's memory."""
    law = law_of(brain=TABLES[name])
    random = np.random.default_rng(7)
    policy = Policy(law, random.normal(size=law.heredity.layout.length).astype(np.float32))
    policy.to_onnx(tmp_path / "brain.onnx")
    model = session(tmp_path / "brain.onnx")
    before = {"memory": np.zeros(law.memory, np.float32)} if law.memory else {}
    assert {each.name for each in model.get_inputs()} == {"senses", *before}
    for senses in random.normal(size=(TICKS, law.senses)).astype(np.float32):
        action, *memory = model.run(None, {"senses": senses, **before})
        np.testing.assert_allclose(action, policy(senses), rtol=1e-4, atol=1e-4)
        for after in memory:
            np.testing.assert_allclose(after, policy.memory, rtol=1e-4, atol=1e-4)
            before = {"memory": policy.memory}


def test_a_discrete_action_is_its_number(poles: Path, tmp_path: Path) -> None:
    run = primordia.load(poles)
    organism = run.oldest(0)
    done = here("export", run.path, "--organism", organism.id, tmp_path / "brain.onnx")
    assert done.returncode == 0, done.stderr
    model = session(tmp_path / "brain.onnx")
    about = model.get_modelmeta().custom_metadata_map
    assert about == {"task": "CartPole-survival", "seed": "3", "organisms": str(organism.id)}
    policy, memory = organism.policy(), np.zeros(32, np.float32)
    for senses in np.random.default_rng(1).normal(size=(TICKS, 4)).astype(np.float32):
        action, _ = model.run(None, {"senses": senses, "memory": memory})
        assert action.dtype == np.int32
        assert action == policy(senses)
        memory = policy.memory


def test_what_cannot_be_a_model_is_one_line(
    poles: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, file = primordia.load(poles), tmp_path / "brain.onnx"
    two = here("export", run.path, "--organism", 1, "--organism", 2, file)
    complains(two, 2, "one organism")
    monkeypatch.setitem(sys.modules, "jax2onnx", None)
    with pytest.raises(primordia.InputError, match=r"pip install 'primordia\[onnx\]'"):
        run.export(file)
    assert not file.exists()
