"""Lines of descent follow their rule, checked one organism and one tick at a time."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from primordia.law.world import Cause
from primordia.phylogeny.clades import Clades, clades_of, crowd_size
from primordia.runs.lives import ALIVE
from tests.synthetic import world_of

FEW = st.lists(st.integers(0, 30), max_size=3)
HISTORY = st.lists(st.tuples(FEW, FEW), max_size=30)
"""For each tick: which of the living have a child, and which of them die."""


class Walked:
    """The lives of a small world, and the living after each tick."""

    def __init__(self, history: list[tuple[list[int], list[int]]]) -> None:
        self.parent, self.born, self.ended = [-1], [0], [-1]
        self.living = {0: [0]}
        now = [0]
        for tick, (mothers, dying) in enumerate(history, 1):
            children = [self.birth(now[each % len(now)], tick) for each in mothers]
            dead = {now[each % len(now)] for each in dying}
            for each in dead:
                self.ended[each] = tick
            now = [each for each in now + children if each not in dead] or [self.birth(-1, tick)]
            self.living[tick] = now

    def birth(self, parent: int, tick: int) -> int:
        self.parent.append(parent)
        self.born.append(tick)
        self.ended.append(-1)
        return len(self.born) - 1

    def line(self, row: int, since: int) -> int:
        """Return the organism's ancestor after the tick `since`, or the founder born later."""
        while self.born[row] > since and self.parent[row] >= 0:
            row = self.parent[row]
        return row

    def lines(self, crowd: int) -> Clades:
        parent, born, ended = map(np.array, (self.parent, self.born, self.ended))
        cause = np.where(ended >= 0, Cause.FATAL, ALIVE).astype(np.int8)
        blank = world_of([(0, 0, True)] * len(born))
        lives = replace(blank, parent=parent, born=born, seen=born, ended=ended, cause=cause)
        return clades_of(lives, crowd)


@given(history=HISTORY, crowd=st.integers(1, 4))
@example(history=[], crowd=1)
@example(history=[([0, 0], []), ([1], [0]), ([], [1, 2]), ([0], [])], crowd=3)
def test_lines_begin_with_the_organisms_alive_when_lines_were_last_distinguished(
    history: list[tuple[list[int], list[int]]], crowd: int
) -> None:
    world = Walked(history)
    lines = world.lines(crowd)
    takeovers = dict(zip(lines.renewals.tolist(), lines.by_takeover.tolist(), strict=True))
    since, young = -1, True
    for tick, living in world.living.items():
        of_tick = lines.lines_at(np.array(living), np.array(tick))
        young |= any(world.born[row] == tick and world.parent[row] < 0 for row in living)
        left = {world.line(row, since) for row in living}
        eventful = tick in world.born or tick in world.ended
        if eventful and (len(living) >= crowd if young else len(left) == 1):
            assert takeovers.pop(tick) is not young
            since, young = tick, False
        assert of_tick.tolist() == [world.line(row, since) for row in living]
    assert not takeovers, "lines were distinguished at no other time"


def test_the_last_line_takes_over_and_its_members_become_lines() -> None:
    first, second, grandchild, nephew = 1, 2, 3, 4
    world = Walked([([0, 0], []), ([1], [0]), ([1], [0, 2])])
    assert world.parent == [-1, 0, 0, first, second]
    lines = world.lines(crowd=3)
    assert lines.renewals.tolist() == [1, 3]
    assert lines.by_takeover.tolist() == [False, True]
    assert lines.lines_at(np.array([first, second, grandchild]), np.array(2)).tolist() == [1, 2, 1]
    assert lines.birth_line[nephew] == second
    assert lines.lines_at(np.array([second, nephew]), np.array(3)).tolist() == [second, nephew]


def test_rows_and_ticks_broadcast() -> None:
    world = Walked([([0], [])] * 3)
    lines = world.lines(crowd=2)
    rows, ticks = np.arange(2), np.array([[1], [3]])
    assert lines.lines_at(rows, ticks).tolist() == [[0, 1], [0, 1]]


def test_lines_of_a_world_that_was_never_crowded_are_its_founders() -> None:
    world = Walked([([0], []), ([], [0, 1]), ([0], [])])
    lines = world.lines(crowd=5)
    assert lines.renewals.tolist() == []
    assert lines.lines_at(np.arange(4), np.array([0, 1, 2, 3])).tolist() == [0, 0, 2, 2]


@pytest.mark.parametrize(
    ("most", "crowd"), [(1, 1), (2, 1), (3, 1), (5, 2), (31, 15), (32, 16), (33, 16), (100, 16)]
)
def test_a_crowd_is_16_or_half_of_the_largest_population(most: int, crowd: int) -> None:
    """The population is largest in tick 2. Later, the same number is born, one after another."""
    lived = [(2, 1, True)] * most + [(10 + 3 * later, 0, True) for later in range(most)]
    assert crowd_size(world_of(lived, until=400)) == crowd
