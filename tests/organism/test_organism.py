"""An organism as users see it: its recorded values and its text."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import call, patch

import numpy as np
import pytest

from primordia.law.world import BirthCause, Cause
from primordia.organism import organism
from primordia.organism.organism import Organism
from primordia.runs.lives import ALIVE, Lives
from primordia.settings.islands import Islands


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
    run: Any = SimpleNamespace(lives=lives, config=SimpleNamespace(islands=Islands(("",), (0, 30))))
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
    assert Organism(run, 1).island is None
    run.config.islands = Islands(("sea", "lagoon"), (0, 21, 30))
    assert [Organism(run, row).island for row in range(3)] == ["sea", "lagoon", "lagoon"]


@pytest.fixture
def twelfth() -> Organism:
    """Return organism 12 of world 2, which has row 1 in the records."""
    lives = SimpleNamespace(id=np.array([5, 12]), world=np.array([0, 2]))
    run: Any = SimpleNamespace(lives=lives, law="a law")
    return Organism(run, 1)


def test_ancestors_genome_policy_and_games_are_those_of_the_organism(twelfth: Organism) -> None:
    with (
        patch.object(organism, "descent", return_value=np.array([0, 1])) as descent,
        patch.object(organism, "rebuild", return_value="a genome") as rebuild,
        patch.object(organism, "Policy") as policy,
        patch.object(organism, "evaluate", return_value=["an evaluation"]) as evaluate,
    ):
        assert twelfth.descent() == [5, 12]
        assert twelfth.genome() == "a genome"
        assert twelfth.policy() is policy.return_value
        assert twelfth.evaluate(games=3, sticky=0.5) == "an evaluation"
    descent.assert_called_once_with(twelfth.lives, 12, 2)
    assert rebuild.call_args_list == [call(twelfth.run, 12, 2)] * 2
    policy.assert_called_once_with("a law", "a genome")
    evaluate.assert_called_once_with(twelfth.run, [(12, 2)], games=3, sticky=0.5)


def test_videos_and_relived_lives_are_those_of_the_organism_with_the_given_options(
    twelfth: Organism,
) -> None:
    """A path may be given as a text."""
    with patch.object(organism, "replay") as replay, patch.object(organism, "relive") as relive:
        twelfth.replay("a.gif", (0, 9), (3, twelfth))
        twelfth.replay()
        twelfth.relive(0, "a.npz", Path("b.gif"))
        twelfth.relive()
    assert replay.call_args_list == [
        call(twelfth.run, 12, 2, Path("a.gif"), (0, 9), beside=[3, (twelfth.run, 12, 2)]),
        call(twelfth.run, 12, 2, None, (None, None), beside=[]),
    ]
    assert relive.call_args_list == [
        call(twelfth.run, 12, 2, since=0, save=Path("a.npz"), film=Path("b.gif")),
        call(twelfth.run, 12, 2, since=None, save=None, film=None),
    ]
