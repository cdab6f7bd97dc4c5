"""Lines of descent, as the live view follows them, obey their rule."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.errors import Trouble
from primordia.law.events import BIRTHS, DEATHS, Events, Rows
from primordia.phylogeny.clades import DIES, NO_PARENT, BirthsAndDeaths, Lines, births_and_deaths

Event = tuple[int, int, int]
"""tick, birth number, and parent or DIES"""


@st.composite
def histories(draw: st.DrawFn) -> list[Event]:
    """Draw the events of a small world, which starts and restarts with one or several founders."""
    events: list[Event] = []
    living: list[int] = []
    born = 0
    for tick in range(draw(st.integers(1, 40))):
        parents = draw(st.lists(st.sampled_from(living), max_size=3)) if living else []
        dying = draw(st.lists(st.sampled_from(living), unique=True)) if living else []
        left = [each for each in living if each not in dying]
        founders = 0 if left or parents else draw(st.integers(1, 3))
        for parent in [*parents, *[NO_PARENT] * founders]:
            events.append((tick, born, parent))
            left.append(born)
            born += 1
        events += [(tick, number, DIES) for number in sorted(dying)]
        living = left
    return events


def followed(events: list[Event], lines: Lines) -> Lines:
    """Follow the lines through a turnover, as the view does."""
    births = [event for event in events if event[2] != DIES]
    deaths = [event for event in events if event[2] == DIES]
    ticks, born, parent = np.array(births, np.int64).reshape(-1, 3).T
    dead_at, dead, _ = np.array(deaths, np.int64).reshape(-1, 3).T
    lines.follow(BirthsAndDeaths(born, parent, ticks, dead, dead_at))
    return lines


def by_the_rule(events: list[Event], crowd: int) -> tuple[dict[int, int], int]:
    """Return the line of each living organism, and takeovers, from every ancestry after every tick."""
    parent = {number: of for _, number, of in events if of != DIES}
    living: set[int] = set()
    roots: set[int] = set()
    takeovers, young = 0, True
    for tick in sorted({tick for tick, _, _ in events}):
        now = [event for event in events if event[0] == tick]
        founders = {number for _, number, of in now if of == NO_PARENT}
        living |= {number for _, number, of in now if of != DIES}
        living -= {number for _, number, of in now if of == DIES}
        roots |= founders
        young |= bool(founders)
        lines = {_root(number, parent, roots) for number in living}
        if len(living) >= crowd if young else len(lines) == 1:
            takeovers += not young
            roots, young = set(living), False
    return {number: _root(number, parent, roots) for number in living}, takeovers


def _root(number: int, parent: dict[int, int], roots: set[int]) -> int:
    while number not in roots:
        number = parent[number]
    return number


@given(histories(), st.lists(st.integers(0, 40), max_size=4), st.integers(1, 4))
def test_lines_follow_the_rule_for_any_cut_of_a_history(
    events: list[Event], cuts: list[int], crowd: int
) -> None:
    lines, since = Lines([], crowd), -1
    for cut in [*sorted(cuts), 40]:
        followed([event for event in events if since < event[0] <= cut], lines)
        since = cut
    assert (lines.line_of, len(lines.takeovers)) == by_the_rule(events, crowd)


def test_each_organism_alive_at_the_start_is_a_line() -> None:
    lines = followed([(9, 7, 3), (9, 3, DIES), (12, 8, 7)], Lines([3, 5], crowd=2))
    assert lines.line_of == {5: 5, 7: 3, 8: 3}
    followed([(13, 5, DIES)], lines)
    assert lines.line_of == {7: 7, 8: 8}
    assert lines.takeovers == [13]


def test_a_founder_after_extinction_takes_nothing_over() -> None:
    events = [
        (0, 0, NO_PARENT),
        (3, 1, 0),
        (5, 2, NO_PARENT),
        (5, 0, DIES),
        (5, 1, DIES),
        (6, 3, 2),
    ]
    assert followed(events[:2], Lines([], crowd=2)).line_of == {0: 0, 1: 1}
    assert followed(events[:2], Lines([], crowd=3)).line_of == {0: 0, 1: 0}
    lines = followed(events, Lines([], crowd=3))
    assert lines.line_of == {2: 2, 3: 2}
    assert lines.takeovers == []


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
def test_a_record_of_what_the_dead_do_is_damaged(late: Event) -> None:
    events = [(1, 0, NO_PARENT), (1, 1, NO_PARENT), (2, 0, DIES), late]
    with pytest.raises(Trouble, match="has a child or dies while it is not alive"):
        followed(events, Lines([], crowd=2))
