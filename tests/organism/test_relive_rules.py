"""Living again: the state with which a life begins, the notes of a comparison, and the result."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.organism.reliving import compare
from primordia.runs import checkpoint

KEPT = ({"ticks": [9, 1200]}, {"ticks": [9, 1100]}, {"ticks": [9, 60]})
"""States of a run of two worlds, newest first; the first world has stopped at tick 9."""


def stored(
    monkeypatch: pytest.MonkeyPatch, since: int | None, born: int = 60, ended: int = 1300
) -> int | None:
    """Return the tick of the state with which a life begins; None if it begins at birth."""
    # the life of organism 3 of world 1
    lives = SimpleNamespace(
        row=lambda organism, world: {(3, 1): 2}[organism, world],
        born=np.array([0, 0, born]),
        ended=np.array([5, 5, ended]),
    )
    run: Any = SimpleNamespace(path="RUN", lives=lives, fault_in=None, arrays_of=dict)
    monkeypatch.setattr(checkpoint, "whole_checkpoints", lambda *given: iter(KEPT))
    monkeypatch.setattr(compare, "world_ticks", lambda arrays: arrays["ticks"])
    found = compare._stored(run, 3, 1, since)
    return None if found is None else int(found["ticks"][1])


@pytest.mark.parametrize(
    ("since", "begins"),
    [(None, None), (10**9, 1200), (1200, 1200), (1199, 1100), (1100, 1100), (1099, 60), (60, 60)],
)
def test_a_life_begins_with_the_newest_state_that_is_not_later(
    monkeypatch: pytest.MonkeyPatch, since: int | None, begins: int | None
) -> None:
    assert stored(monkeypatch, since) == begins


@pytest.mark.parametrize(
    ("born", "ended", "begins"), [(60, 61, 60), (60, 1100, 60), (61, 1101, 1100), (61, 1200, 1100)]
)
def test_a_life_begins_with_a_state_that_it_outlives(
    monkeypatch: pytest.MonkeyPatch, born: int, ended: int, begins: int
) -> None:
    """An organism may be born in the tick of the state, but must not die in it."""
    assert stored(monkeypatch, 10**9, born, ended) == begins


@pytest.mark.parametrize(
    ("since", "born", "ended", "says"),
    [
        (59, 60, 1300, "from tick 60 to 1,300; RUN keeps only later .*: 1,200 and 1,100 and 60$"),
        (1099, 61, 1300, "from tick 61 to 1,300; RUN keeps only later .*: 1,200 and 1,100$"),
        (500, 1101, 1200, "from tick 1,101 to 1,200, and RUN keeps no checkpoint of these"),
        (500, 61, 1100, "from tick 61 to 1,100, and RUN keeps no checkpoint of these"),
    ],
)
def test_if_no_state_is_early_enough_the_error_says_which_are_kept(
    monkeypatch: pytest.MonkeyPatch, since: int, born: int, ended: int, says: str
) -> None:
    with pytest.raises(InputError, match=f"^--from {since}: organism 3 lived {says}"):
        stored(monkeypatch, since, born, ended)
