"""The contract of brains, for all brains of the package and for a brain of the tests."""

import os
import subprocess
import sys
from hashlib import sha256
from typing import Any

import jax
import numpy as np
import pytest

from primordia.brains.contract import KNOWN, Brain, find
from primordia.compiled import shared
from primordia.errors import InputError
from primordia.settings.making import make
from primordia.testing import check_brain
from tests.commands import AFRESH, environment
from tests.toys import Sliding
from tests.worlds import MILL, config

TABLES: dict[str, dict[str, Any]] = {
    "recurrent": {"hidden": 12},
    "recurrent, biases": {"hidden": 12, "biases": True},
    "feed-forward": {"kind": "feed-forward", "hidden": 33},
    "feed-forward, biases": {"kind": "feed-forward", "hidden": 2, "biases": True},
    "gated": {"kind": "gated", "hidden": 32},
    "gated, biases": {"kind": "gated", "hidden": 7, "biases": True},
    "linear": {"kind": "linear"},
    "linear, biases": {"kind": "linear", "biases": True},
    "plastic": {"kind": "plastic", "hidden": 6, "gain": 0.5, "modulator_gain": 0.5},
    "plastic, few neurons, one rule": {
        "kind": "plastic",
        "hidden": 2,
        "coefficients": "layer",
        "activity": "graded",
        "gain": 0.5,
        "modulator_gain": 0.5,
    },
    "not ours": {"kind": "tests.toys:Sliding"},
}


def build(table: dict[str, Any]) -> Brain:
    """Return the brain that a table describes."""
    return make("brain", table, find)


BRAINS = {name: build(table) for name, table in TABLES.items()}
SENSES, OUTPUTS, MOST, TICKS = 5, 3, 1024, 6


@pytest.mark.parametrize(
    "brain",
    [
        pytest.param(brain, id=name, marks=() if name == "plastic" else pytest.mark.slow)
        for name, brain in BRAINS.items()
    ],
)
def test_a_brain_keeps_the_contract(brain: Brain) -> None:
    """`tests/engine/test_exactness.py` and `tests/testing/test_brain.py` have brains of other kinds."""
    check_brain(brain, SENSES, OUTPUTS)


def minds(brain: Brain) -> tuple[dict[str, Any], Any, Any]:
    """Return genomes and memories of MOST organisms, and their senses in some ticks (T, N, S)."""
    rng = np.random.default_rng(1)

    def normal(*shape: int) -> np.ndarray:
        return rng.normal(size=shape).astype(np.float32)

    layout = brain.layout(SENSES, OUTPUTS)
    genome = {name: normal(MOST, *shape) for name, shape in layout.blocks}
    memory = np.tanh(normal(MOST, brain.memory(SENSES, OUTPUTS)))
    return genome, memory, normal(TICKS, MOST, SENSES)


def lived(brain: Brain, genome: Any, memory: Any, senses: Any) -> tuple:
    """Think for some ticks in one compiled loop; return memory (N, M) and outputs (T, N, A)."""
    return jax.lax.scan(lambda memory, seen: brain(genome, memory, seen), memory, senses)


def fingerprint() -> str:
    """Return a hash of what brains think; the process below prints it."""
    digest = sha256()
    for brain in BRAINS.values():
        for each in jax.tree.leaves(shared(lived, brain)(*minds(brain))):
            digest.update(np.asarray(each).tobytes())
    return digest.hexdigest()


PROGRAM = """
import os, sys
os.sched_setaffinity(0, [int(cpu) for cpu in sys.argv[1:]])
from tests.brains.test_contract import fingerprint
print(fingerprint())
"""


@pytest.mark.slow
def test_brains_think_the_same_on_any_number_of_threads() -> None:
    if not hasattr(os, "sched_setaffinity") or len(os.sched_getaffinity(0)) < 2:
        pytest.skip("needs Linux and two processors")
    command = [sys.executable, "-c", PROGRAM, str(min(os.sched_getaffinity(0)))]
    variables = environment() | AFRESH
    done = subprocess.run(command, env=variables, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == fingerprint()


def test_brains_are_found_by_name_and_by_class() -> None:
    assert [find(name).__name__ for name in KNOWN] == [
        "Recurrent",
        "FeedForward",
        "Gated",
        "Linear",
        "Plastic",
    ]
    assert find("tests.toys:Sliding") is Sliding
    assert build({}) == build({"kind": "recurrent", "hidden": 32, "biases": False})


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (
            {"kind": "gatd"},
            "brain.kind: no brain named 'gatd'; known: recurrent, feed-forward, gated",
        ),
        ({"kind": 5}, "brain.kind: no brain named 5"),
        (
            {"kind": "tests.toys:Meadow"},
            "brain.kind: Meadow is not a brain: make it a subclass of primordia.brains",
        ),
        ({"kind": "tests.toys:Nothing"}, "'tests.toys:Nothing' cannot be loaded"),
        (
            {"kind": "primordia.brains.contract:Brain"},
            "brain: Can't instantiate abstract class Brain",
        ),
        ({"kind": "gated", "hiden": 3}, "no setting 'brain.hiden'; did you mean 'brain.hidden'"),
        ({"kind": "linear", "hidden": 3}, "there is no setting 'brain.hidden'"),
        (
            {"kind": "gated", "hidden": 0},
            "brain.hidden: input should be greater than or equal to 1",
        ),
        ({"kind": "gated", "biases": 1}, "brain.biases: input should be a valid boolean, not 1"),
        ({"kind": "tests.toys:Sliding", "width": 0}, "brain.width: .*, not 0"),
    ],
)
def test_a_brain_that_cannot_be_made_is_an_error_that_says_why(
    table: dict[str, Any], says: str
) -> None:
    with pytest.raises(InputError, match=says):
        build(table)
    with pytest.raises(InputError, match=f"^mill: .*{says}"):
        config({**MILL, "brain": table})
