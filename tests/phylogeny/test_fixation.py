"""Fixation along a line of descent, and sweeps, beside pedigrees walked one organism at a time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.phylogeny.fixation import UNKNOWN, first_ticks
from primordia.phylogeny.living import Turnover, branches
from primordia.phylogeny.sweeps import sweeps
from tests.pedigrees import (
    HISTORY,
    Event,
    common_after,
    line_to,
    lives_of,
    living_after,
    moran,
    share_after,
    walked,
)


@given(history=HISTORY, founders=st.integers(1, 3), which=st.integers(0, 99))
def test_shares_of_the_living_are_those_of_a_count(
    history: list[Event], founders: int, which: int
) -> None:
    lives = walked(history, founders)
    line = np.array(line_to(lives, which % len(lives))[::-1])
    branch = branches(lives.parent_row, line)
    found = first_ticks(Turnover.of(lives), branch, len(line), (0.1, 0.5, 1))
    for share, ticks in zip((0.1, 0.5, 1), found, strict=True):
        for ancestor, tick in zip(line.tolist(), ticks.tolist(), strict=True):
            shares = [share_after(lives, ancestor, each) for each in range(len(history) + 1)]
            above = [each > share or each == share == 1 for each in shares]
            assert tick == (above.index(True) if any(above) else UNKNOWN)


def test_nothing_is_fixed_by_the_death_of_all() -> None:
    """The lines of two siblings end in the same tick, so neither was ever alone."""
    lives = lives_of([-1, 0, 0], [0, 2, 3], [5, 9, 9], [True] * 3)
    line = np.array([0, 1])
    found = first_ticks(Turnover.of(lives), branches(lives.parent_row, line), 2, (1, 0.5))
    assert [each.tolist() for each in found] == [[0, UNKNOWN], [0, UNKNOWN]]


@pytest.mark.parametrize("size", [2, 40])
def test_a_long_line_is_looked_at_in_parts(size: int) -> None:
    """The parts are shorter than the pedigree, and there are more ancestors than fit into one."""
    lives = moran(size, 5000)
    line = np.array(line_to(lives, len(lives) - 1)[::-1])
    branch = branches(lives.parent_row, line)
    (fixed,) = first_ticks(Turnover.of(lives), branch, len(line), (1,))
    lowest = np.full(5001, len(line))  # the first place at which one of the living left the line
    for row in range(len(lives)):
        end = lives.ended[row] if lives.died[row] else 5001
        lowest[lives.born[row] : end] = np.minimum(lowest[lives.born[row] : end], branch[row])
    for place in range(len(line)):
        reached = np.flatnonzero(lowest[lives.born[line[place]] :] >= place)
        expected = lives.born[line[place]] + reached[0] if len(reached) else UNKNOWN
        assert fixed[place] == expected


@given(history=HISTORY, founders=st.integers(1, 3))
def test_sweeps_are_the_changes_of_the_common_ancestor(history: list[Event], founders: int) -> None:
    lives = walked(history, founders)
    began = max(int(lives.born[row]) for row in range(len(lives)) if lives.parent[row] < 0)
    expected: dict[int, int] = {}
    for tick in range(began, len(history) + 1):
        row = common_after(lives, tick)
        if row is not None and lives.born[row] > began:
            expected.setdefault(row, tick)
    found = sweeps(lives)
    done = {each.organism: each.fixed for each in found if each.fixed is not None}
    assert done == expected
    for each in found:
        assert each.half is not None
        assert share_after(lives, each.organism, each.half) > 0.5
        assert share_after(lives, each.organism, each.half - 1) <= 0.5
        assert (each.birth_cause, each.born) == ("mutant", lives.born[each.organism])
        then = each.half if each.fixed is None else each.fixed
        assert each.living == len(living_after(lives, then))
        assert each.duration == (None if each.fixed is None else each.fixed - each.born)


def test_of_two_sweeps_under_way_the_younger_counts() -> None:
    """Of seven, five descend from organism 1 of tick 1, and four from its child of tick 2."""
    lives = lives_of([-1, 0, 1, 0, 2, 2, 2], [0, 1, 2, 3, 4, 5, 6], [9] * 7, [False] * 7)
    (only,) = sweeps(lives)
    assert (only.organism, only.half, only.fixed, only.living) == (2, 6, None, 7)


def test_sweeps_of_a_fork_are_those_of_organisms_born_after_it() -> None:
    """Two of three sweeps began before the fork or in its tick."""
    lives = lives_of(
        parent=[-1, 0, 1, 1, 2, 4],
        born=[0, 4, 10, 10, 15, 17],
        ended=[11, 16, 30, 20, 30, 30],
        died=[True, True, False, True, False, False],
    )
    fork = lives.recorded_since(10)
    assert fork.id.tolist() == [0, 1, 2, 3, 4, 5]
    assert [each.organism for each in sweeps(lives)] == [1, 2, 4]
    (under_way,) = sweeps(fork)
    assert (under_way.organism, under_way.fixed, under_way.half) == (4, None, 20)


def test_in_a_world_without_life_sweeps_end_with_the_last_death() -> None:
    """Organism 1 and its children outlive the founder; the last of three dies at tick 9."""
    lives = lives_of([-1, 0, 1, 1], [0, 2, 3, 4], [5, 7, 9, 8], [True] * 4)
    found = sweeps(lives)
    assert [(each.organism, each.half, each.fixed) for each in found] == [(1, 3, 5), (2, 8, 8)]
