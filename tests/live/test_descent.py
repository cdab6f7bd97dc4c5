"""Lines of descent in the live view: takeovers, and when the view stops following lines to save time."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.law.world import World
from primordia.live import descent
from primordia.live.descent import Descent
from primordia.phylogeny.clades import NO_PARENT, BirthsAndDeaths
from tests.live.posed import posed

EMPTY = posed([[0] * 64] * 3, [[0] * 64] * 3, [1] * 3)


def births(*numbers: int, parent: int = NO_PARENT, tick: int = 0) -> BirthsAndDeaths:
    """Return births in one tick, without deaths."""
    born, none = np.array(numbers, np.int64), np.zeros(0, np.int64)
    return BirthsAndDeaths(born, np.full(len(born), parent), np.full(len(born), tick), none, none)


def deaths(*numbers: int, tick: int) -> BirthsAndDeaths:
    """Return deaths in one tick, without births."""
    dead, none = np.array(numbers, np.int64), np.zeros(0, np.int64)
    return BirthsAndDeaths(none, none, none, dead, np.full(len(dead), tick))


def status(
    happened: list[BirthsAndDeaths], world: World = EMPTY, cells: int = 64, wall_s: float = 0.0
) -> Any:
    """Return the status of a run after a chunk with these events of each world."""
    engine = SimpleNamespace(
        law=SimpleNamespace(cells=cells), state=SimpleNamespace(world=world), events=happened
    )
    return SimpleNamespace(engine=engine, wall_s=wall_s)


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Descent, "EVENTS", 10)
    monkeypatch.setattr(descent, "births_and_deaths", lambda events, cells, shown: events)


def test_lines_are_given_up_after_too_many_births_and_deaths() -> None:
    """Ten in a second may happen, and ten before the first second has passed."""
    followed = Descent()
    for new, wall_s in (
        (births(*range(6)), 0.0),
        (deaths(0, 1, 2, 3, tick=1), 0.0),
        (births(*range(6, 16)), 1.0),
        (births(*range(16, 26)), 2.0),
    ):
        followed.follow(status([new], wall_s=wall_s), 1)
        assert followed.takeovers([0]) is not None
    assert set(followed.lines[0].line_of) == set(range(4, 26))
    followed.follow(status([deaths(4, tick=2)], wall_s=2.0), 1)
    assert (followed.lines, followed.takeovers([0])) == ({}, None)


def test_takeovers_that_were_missed_stay_unknown_when_lines_are_followed_again() -> None:
    followed = Descent()
    followed.follow(status([births(*range(11))]), 1)
    assert followed.lines == {}
    later = status([births(11, tick=5)], posed([[1] * 64], [[0] * 64], [5]), wall_s=9.0)
    followed.follow(later, 1)
    assert set(followed.lines[0].line_of) == set(range(64))
    assert followed.takeovers([0]) is None


def test_takeovers_are_counted_in_the_named_worlds_and_known_only_of_worlds_that_are_shown() -> (
    None
):
    """Each world has four cells, so lines begin with two organisms."""
    followed = Descent()
    followed.follow(status([births(0, 1)] * 3, cells=4), 3)
    followed.follow(status([deaths(0, tick=1), births(), deaths(1, tick=1)], cells=4), 3)
    assert [followed.takeovers(worlds) for worlds in ([0], [1], [2], [0, 1, 2])] == [1, 0, 1, 2]
    followed.follow(status([births()] * 2, cells=4), 2)
    assert set(followed.lines) == {0, 1}
    assert followed.takeovers([0, 1]) == 1
    assert followed.takeovers([0, 1, 2]) is None
    world = posed([[1] * 4] * 3, [[0] * 4] * 3, [5] * 3)
    followed.follow(status([births()] * 3, world, cells=4), 3)
    assert set(followed.lines) == {0, 1, 2}
    assert followed.takeovers([0, 1]) == 1
    assert followed.takeovers([0, 1, 2]) is None, "world 2 was not followed for a chunk"


def test_the_lines_of_a_resumed_run_begin_with_its_living_organisms() -> None:
    """In the second world, organisms 9 and 8 are alive. The line of 9 takes over when 8 has died."""
    world = posed(
        [[1, 0, 0, 0], [0, 1, 1, 0]], [[0] * 4] * 2, [5, 5], number=[[7, 0, 0, 0], [9, 9, 8, 0]]
    )
    followed = Descent()
    followed.follow(status([births(), births()], world, cells=4), 2)
    assert [set(lines.line_of) for lines in followed.lines.values()] == [{7}, {8, 9}]
    followed.follow(status([births(), deaths(8, tick=6)], cells=4), 2)
    assert [followed.takeovers([each]) for each in (0, 1)] == [0, 1]


def test_lines_begin_with_sixteen_organisms_or_with_half_of_the_cells() -> None:
    for cells, crowd in ((1, 1), (31, 15), (64, 16)):
        followed, world = Descent(), posed([[0] * cells], [[0] * cells], [1])
        followed.follow(status([births(0)], world, cells), 1)
        for number in range(1, crowd):
            assert followed.lines[0].renewals == []
            child = births(number, parent=0, tick=number)
            followed.follow(status([child], cells=cells, wall_s=9.0), 1)
        assert followed.lines[0].renewals == [crowd - 1]


@pytest.mark.parametrize(
    ("most", "shown", "takeovers"),
    [(64, 1, 0), (127, 2, None), (128, 2, 0)],
)
def test_lines_of_large_worlds_are_not_followed(
    most: int, shown: int, takeovers: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each world has 64 cells."""
    monkeypatch.setattr(Descent, "CELLS", most)
    followed = Descent()
    followed.follow(status([births(*range(3))] * shown), shown)
    assert followed.takeovers(range(shown)) == takeovers
