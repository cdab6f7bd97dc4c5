"""Invented runs to compare."""

from typing import Any

import numpy as np

from primordia.comparison.comparison import ComparedArm, Comparison
from primordia.comparison.measured import Measured
from primordia.comparison.pace import WINDOWS, Gathering, Pace
from primordia.comparison.survival import survival
from primordia.history.extinctions import Extinctions
from tests.synthetic import worlds_of

OUTCOMES = ("first", "births", "ticks", "lifespan", "longest", "pace", "food")


def arm(
    name: str, values: list[float], known: list[bool] | None = None, seed: int = 0, **counts: Any
) -> ComparedArm:
    """Return a run whose worlds have these values of `births`, and others of the other outcomes."""
    worlds = len(values)
    is_known = np.array(known or [True] * worlds)
    measured = {
        outcome: Measured(np.array(values, float) * 10**k, is_known)
        for k, outcome in enumerate(OUTCOMES, -1)
    }
    lost = [np.array(counts.get(each, [0] * worlds)) for each in ("total", "crashes")]
    lives = worlds_of(*([(0, 5, True)] for _ in range(worlds)), until=20)
    nothing = np.zeros((worlds, WINDOWS))
    return ComparedArm(
        name,
        counts.get("settings", {}),
        np.arange(seed, seed + worlds, dtype=np.uint64),
        measured,
        survival(lives, worlds, 10),
        Pace(np.linspace(0, 20, WINDOWS + 1), nothing, nothing.astype(int)),
        Gathering(nothing, measured["food"]),
        Extinctions(*lost),
    )


def side_by_side(*arms: ComparedArm, **changed: Any) -> Comparison:
    """Return the comparison of runs, with some of its values changed."""
    values = {"age": 12_000, "begin": 0, "births": None, "ticks": None, "span": "second", **changed}
    return Comparison("meadow", arms, **values)
