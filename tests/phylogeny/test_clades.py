"""Lines of descent follow their rule, checked one organism and one tick at a time."""

from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from primordia.errors import Trouble
from primordia.law.events import BIRTHS, DEATHS, Events, Rows
from primordia.phylogeny.clades import (
    DIES,
    NO_PARENT,
    BirthsAndDeaths,
    Lines,
    births_and_deaths,
    clades_of,
    crowd_size,
)
from tests.pedigrees import HISTORY, Event, line_to, living_after, walked
from tests.synthetic import world_of

Happened = tuple[int, int, int]
"""tick, birth number, and parent or DIES"""
FOUNDERS = st.integers(1, 3)


@given(history=HISTORY, founders=FOUNDERS, crowd=st.integers(1, 4))
@example(history=[], founders=1, crowd=1)
@example(history=[([0, 0], []), ([1], [0]), ([], [1, 2]), ([0], [])], founders=1, crowd=3)
def test_lines_begin_with_the_organisms_alive_when_lines_were_last_distinguished(
    history: list[Event], founders: int, crowd: int
) -> None:
    lives = walked(history, founders)
    clades = clades_of(lives, crowd)
    takeovers = dict(zip(clades.renewals.tolist(), clades.by_takeover.tolist(), strict=True))
    since, young = -1, True
    for tick in range(len(history) + 1):
        living = living_after(lives, tick)
        new = np.flatnonzero(lives.born == tick)
        young |= bool((lives.parent[new] < 0).any())
        lines = [
            next(
                (each for each in line_to(lives, row) if lives.born[each] <= since),
                line_to(lives, row)[-1],
            )
            for row in living
        ]
        if (len(new) or (lives.ended[lives.died] == tick).any()) and (
            len(living) >= crowd if young else len({*lines}) == 1
        ):
            assert takeovers.pop(tick) is not young
            since, young, lines = tick, False, living
        assert clades.lines_at(np.array(living), np.array(tick)).tolist() == lines
    assert not takeovers, "lines were distinguished at no other time"


def followed(lines: Lines, *events: Happened) -> Lines:
    """Follow lines through a turnover, as the live view does."""
    deaths = [event for event in events if event[2] == DIES]
    births = [event for event in events if event[2] != DIES]
    ticks, born, parent = np.array(births, np.int64).reshape(-1, 3).T
    dead_at, dead, _ = np.array(deaths, np.int64).reshape(-1, 3).T
    lines.follow(BirthsAndDeaths(born, parent, ticks, dead, dead_at))
    return lines


@given(HISTORY, FOUNDERS, st.lists(st.integers(0, 30), max_size=4), st.integers(1, 4))
def test_lines_do_not_depend_on_the_cuts_of_a_history(
    history: list[Event], founders: int, cuts: list[int], crowd: int
) -> None:
    lives, lines = walked(history, founders), Lines([], crowd)
    rows = range(len(lives))
    events = [(int(lives.born[row]), row, int(lives.parent[row])) for row in rows]
    events += [(int(lives.ended[row]), row, DIES) for row in rows if lives.died[row]]
    for first, last in zip([-1, *sorted(cuts)], [*sorted(cuts), 30], strict=True):
        followed(lines, *(event for event in events if first < event[0] <= last))
    whole, living = clades_of(lives, crowd), living_after(lives, 30)
    now = whole.lines_at(np.array(living), np.array(30)).tolist()
    assert lines.line_of == dict(zip(living, now, strict=True))
    assert lines.takeovers == whole.renewals[whole.by_takeover].tolist()


def test_each_organism_alive_at_the_start_is_a_line() -> None:
    lines = followed(Lines([3, 5], crowd=2), (9, 7, 3), (9, 3, DIES), (12, 8, 7))
    assert lines.line_of == {5: 5, 7: 3, 8: 3}
    followed(lines, (13, 5, DIES))
    assert lines.line_of == {7: 7, 8: 8}
    assert lines.takeovers == [13]


@pytest.mark.parametrize(("most", "crowd"), [(1, 1), (5, 2), (31, 15), (33, 16), (100, 16)])
def test_a_crowd_is_16_or_half_of_the_largest_population(most: int, crowd: int) -> None:
    """The population is largest in tick 2. Later, the same number is born, one after another."""
    lived = [(2, 1, True)] * most + [(10 + 3 * later, 0, True) for later in range(most)]
    assert crowd_size(world_of(lived, until=400)) == crowd


def test_the_events_of_a_chunk_are_divided_among_its_worlds() -> None:
    """Three worlds of four cells; the second has no event. Rows beyond the filled do not count."""
    founder, high = -1, 2**32
    births = np.array([(0, 5, founder, 1), (3, 6, 5, 9), (8, 5, high + 4, high + 2), (11, 6, 5, 9)])
    deaths = np.array([(11, 6, 12), (3, 5, 12), (2, high + 7, 13)])
    cell, number, parent, tick = births.T
    born = BIRTHS.rows(cell=cell, id=number, parent=parent, tick=tick, cause=0 * cell)
    cell, number, tick = deaths.T
    rest = dict.fromkeys(("cause", "energy", "food"), 0 * cell)
    died = DEATHS.rows(cell=cell, id=number, tick=tick, **rest)
    noise = np.full((2, born.shape[1]), 7, np.uint32), np.full((2, died.shape[1]), 1, np.uint32)
    rows = [np.concatenate(each) for each in zip((born, died), noise, strict=True)]
    events: Any = Events(Rows(rows[0], np.int32(4)), Rows(rows[1], np.int32(3)), None)
    found = [[column.tolist() for column in each] for each in births_and_deaths(events, 4, 3)]
    assert found == [
        [[5, 6], [NO_PARENT, 5], [1, 9], [5, high + 7], [12, 13]],
        [[], [], [], [], []],
        [[5, 6], [high + 4, 5], [high + 2, 9], [6], [12]],
    ]


@pytest.mark.parametrize("late", [(3, 2, 0), (3, 0, DIES)])
def test_a_record_of_what_the_dead_do_is_damaged(late: Happened) -> None:
    with pytest.raises(Trouble, match="has a child or dies while it is not alive"):
        followed(Lines([], crowd=2), (1, 0, NO_PARENT), (1, 1, NO_PARENT), (2, 0, DIES), late)
