"""Worlds of games without sticky buttons, against the same worlds with every life emulated.

In such games no course is emulated twice (`habitats/atari/tree.py`). How many lives share a course
depends on the world: on the share of exact copies, and on how alike mutants and parents act. So each
world is lived from genesis to the same tick in both ways, in this process and on one core.
"""

from itertools import product

import numpy as np

from primordia.config import load
from primordia.engine.engine import Engine
from primordia.habitats.atari import tree
from primordia.habitats.atari.simulator import Arcade
from primordia.habitats.atari.tree import TreeArcade
from tapes import replaced
from worlds import early_rate, median

TASKS = "Pong-survival", "Boxing-survival-fight", "BattleZone-survival-forager"
INHERITANCE = "parent", "founder"
TICKS = 10_000
ROUNDS = 3


def against_every_life() -> list[dict]:
    """Measure organism-ticks a second in both ways, in turn, for each task with and without heredity."""
    return [_measured(*world) for world in product(TASKS, INHERITANCE)]


def _measured(task: str, inheritance: str) -> dict:
    world = task, inheritance
    for kind in (TreeArcade, Arcade):  # compile
        early_rate(_engine(*world, kind), 0, 500)
    pairs = [
        [early_rate(_engine(*world, kind), seed, TICKS) for kind in (TreeArcade, Arcade)]
        for seed in range(1, ROUNDS + 1)
    ]
    once, each = np.transpose(pairs)
    return {
        "task": task,
        "inheritance": inheritance,
        "organism-ticks per s": {
            "courses emulated once": round(median(once)),
            "every life emulated": round(median(each)),
        },
        "times as fast": median(once / each),
    }


def _engine(task: str, inheritance: str, kind: type[Arcade]) -> Engine:
    """Return a world before genesis, with emulators of a kind in this process."""
    with replaced(tree, "TreeArcade", kind):
        return Engine(load(task, {"inheritance": inheritance, "habitat": {"workers": 0}}))
