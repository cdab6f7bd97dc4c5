"""The contract of brains, for all brains of the package and for a brain of the tests."""

from typing import Any

import pytest

from primordia.brains.contract import KNOWN, Brain, find
from primordia.errors import InputError
from primordia.settings.making import make
from primordia.testing import check_brain
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
SENSES, OUTPUTS = 5, 3


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
