"""An organism as users see it: its recorded values and its text."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from primordia.law.world import BirthCause, Cause
from primordia.organism.organism import Organism
from primordia.runs.lives import ALIVE, Lives


def test_an_organism_has_the_values_of_its_row() -> None:
    """Row 0 is a founder, and row 1 its child, which dies. Row 2 is alive in another world."""
    lives = Lives(
        world=np.array([0, 0, 2]),
        id=np.array([0, 11, 12]),
        parent=np.array([-1, 0, 5]),
        cell=np.array([20, 21, 22]),
        birth_cause=np.array([BirthCause.FOUNDER, BirthCause.MUTANT, BirthCause.COPY]),
        born=np.array([0, 31, 32]),
        seen=np.array([0, 31, 40]),
        inherited=np.array([False, False, True]),
        ended=np.array([90, 72, 95]),
        cause=np.array([ALIVE, Cause.STARVED, ALIVE]),
    )
    run: Any = SimpleNamespace(lives=lives)
    names = "id", "world", "parent", "cell", "birth_cause", "born", "age", "cause"
    found = [tuple(getattr(Organism(run, row), name) for name in names) for row in range(3)]
    assert found == [
        (0, 0, None, 20, "founder", 0, 90, None),
        (11, 0, 0, 21, "mutant", 31, 41, "starved"),
        (12, 2, 5, 22, "copy", 32, 63, None),
    ]
    assert [repr(Organism(run, row)) for row in range(3)] == [
        "<organism 0 of world 0: born 0, age 90, alive>",
        "<organism 11 of world 0: born 31, age 41, starved>",
        "<organism 12 of world 2: born 32, age 63, alive>",
    ]
