"""Tasks made from environments in JAX: the facts shown, and settings."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.habitats.contract import Continuous, Discrete
from primordia.habitats.gymnax import task
from primordia.habitats.gymnax.check import Measured


def replace_measurement(monkeypatch: pytest.MonkeyPatch, **found: Any) -> None:
    """Replace the measurement by given values. Of the three observed numbers, the last has bounds."""
    own = {
        "lifespan": 1234.4,
        "ended": 3,
        "largest": np.float32([1, 1, 900]),
        "faults": ["a fault"],
    }
    habitat = SimpleNamespace(
        action=found.pop("action", Discrete(3)),
        names={
            "obs": 3,
            "state": {"energy": "amount", "_private": "amount", "data._x": 2, "data.x": 2},
            "info": {},
        },
        simulator=SimpleNamespace(limits=found.pop("limits", [])),
        senses=SimpleNamespace(
            unbounded=lambda: np.array([True, True, False]), grid=found.pop("grid", None)
        ),
    )
    monkeypatch.setattr(task, "make", lambda *given: habitat)
    monkeypatch.setattr(task, "Gymnax", SimpleNamespace)
    monkeypatch.setattr(task, "measure", lambda of: Measured(**{**own, **found}))


@pytest.mark.parametrize(
    ("action", "shown"),
    [
        (Discrete(3), "one of 3"),
        (Continuous(1), "1 number"),
        (Continuous(2), "2 numbers"),
    ],
)
def test_the_facts_of_an_environment_have_its_figures(
    monkeypatch: pytest.MonkeyPatch, action: Any, shown: str
) -> None:
    replace_measurement(monkeypatch, action=action)
    _, facts, faults = task.task.__wrapped__("any:Env")
    assert facts == [
        "Observation: 3 numbers, obs[0] to obs[2] in conditions.",
        f"Action: {shown}.",
        'Numbers in state: state["energy"], state["data.x"].',
        "Numbers in info: none.",
        "The environment has no time limit.",
        "After an interruption, lives go on exactly from their saved states.",
        "With random actions, a life has 1,234 ticks on average.",
    ]
    assert faults == ["a fault"]
    replace_measurement(monkeypatch, ended=0, limits=["max_steps", "max_time"])
    _, facts, _ = task.task.__wrapped__("any:Env")
    assert facts[4].startswith("The environment's time limit (max_steps, max_time) is off;")
    assert facts[6].startswith("None of 32 lives ended in 500 ticks of random play:")


@pytest.mark.parametrize(
    ("grid", "said"), [((10, 8, 6), True), ((10, 5, 1), False), ((4, 64, 32), False)]
)
def test_the_facts_say_how_players_of_a_grid_perceive_what_is_near(
    monkeypatch: pytest.MonkeyPatch, grid: tuple[int, ...], said: bool
) -> None:
    """A matrix has no channel of its own for the player, and frames one behind the other are no grid."""
    replace_measurement(monkeypatch, grid=grid)
    _, facts, _ = task.task.__wrapped__("any:Env")
    assert ("The observation is a grid of 10 x 8 cells with 6 channels." in facts[1]) == said
    assert ("sight = 2" in facts[1]) == said


@pytest.mark.parametrize(
    ("largest", "squash"),
    [([5, 5, 900], False), ([5.1, 0, 0], True), ([0, 5.1, 0], True), ([0, 0, 900], False)],
)
def test_senses_are_squashed_if_a_number_without_bounds_is_large(
    monkeypatch: pytest.MonkeyPatch, largest: list[float], squash: bool
) -> None:
    replace_measurement(monkeypatch, largest=np.float32(largest), lifespan=50.0)
    table, _, _ = task.task.__wrapped__("any:Env")
    own = {"name": "gymnax", "env": "any:Env", "fatal": "done"}
    assert table["habitat"] == own | ({"squash": True} if squash else {})
    assert (table["task"], table["about"]) == ("Env", "any:Env: live until it is done")
