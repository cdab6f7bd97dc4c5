"""Common ancestors, coalescence times and the tree of the living, beside walks up every line."""

from collections import Counter
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.law.world import Cause
from primordia.phylogeny.coalescence import Genealogy, neutral, observed
from primordia.phylogeny.diversity import hill_numbers, phylogenetic_diversity
from primordia.phylogeny.living import Turnover, last_era
from primordia.runs.lives import Lives
from tests.pedigrees import HISTORY, Event, line_to, lives_of, living_after, moran, walked


def parted(lives: Lives, one: int, other: int) -> int | None:
    """Return the tick at which the lines of two organisms part; None if they have no common ancestor."""
    lines = [line_to(lives, row)[::-1] for row in (one, other)]
    shared = sum(a == b for a, b in zip(*lines, strict=False))
    rest = [line[shared] for line in lines if len(line) > shared]
    return min(int(lives.born[row]) for row in rest) if shared else None


@given(history=HISTORY, founders=st.integers(1, 3))
def test_each_pair_of_the_living_coalesces_where_its_lines_part(
    history: list[Event], founders: int
) -> None:
    lives = walked(history, founders)
    living, end = living_after(lives, len(history)), int(lives.ended.max())
    ticks = [parted(lives, *pair) for pair in combinations(living, 2)]
    counted = Counter(end - tick for tick in ticks if tick is not None)
    times = observed(Genealogy.of(lives))
    shares = np.diff(times.share, prepend=0) * max(len(ticks), 1)
    assert (
        dict(zip(times.back.tolist(), shares.round().astype(int).tolist(), strict=True)) == counted
    )
    if counted:
        assert times.mean == pytest.approx(np.mean(list(counted.elements())))
    if len(counted) and counted.total() == len(ticks):
        assert times.median == np.quantile(list(counted.elements()), 0.5, method="inverted_cdf")


@given(history=HISTORY, founders=st.integers(1, 3))
def test_the_common_ancestor_is_the_youngest_on_all_lines(
    history: list[Event], founders: int
) -> None:
    lives = walked(history, founders)
    lines = [line_to(lives, row) for row in living_after(lives, len(history))]
    common = [row for row in lines[0] if all(row in line for line in lines)]
    genealogy = Genealogy.of(lives)
    assert genealogy.common_ancestor == (common[0] if common else None)
    assert set(genealogy.rows.tolist()) == {row for line in lines for row in line}
    assert len(genealogy.roots) == len({line[-1] for line in lines})
    trunk = genealogy.trunk().tolist()
    assert trunk[::-1] in lines
    assert set(common) <= set(trunk)


def tree_length(lives: Lives, tick: int) -> int:
    """Return the length of the tree of those alive after a tick: who carries their lines in each tick."""
    length, parents = 0, lives.parent_row.tolist()
    for then in range(tick):
        carriers = set()
        for row in living_after(lives, tick):
            while row >= 0 and lives.born[row] > then:
                row = parents[row]
            carriers |= {row} - {-1}
        length += len(carriers)
    return length


@given(history=HISTORY, founders=st.integers(1, 3), since=st.integers(0, 9))
def test_the_tree_of_the_living_is_as_long_as_their_lines(
    history: list[Event], founders: int, since: int
) -> None:
    """The tree of a fork begins with the births of those alive at it."""
    since = min(since, len(history))
    lives = walked(history, founders).recorded_since(since)
    ticks = np.arange(since, len(history) + 1, 3)
    expected = [tree_length(lives, tick) for tick in ticks.tolist()]
    assert phylogenetic_diversity(lives, ticks).tolist() == expected


def test_drift_gives_the_times_of_a_moran_process() -> None:
    """With n + 1 alive after each birth, two lines meet at it with probability 2 / (n (n + 1))."""
    size, births = 12, 4000
    lives = moran(size, births)
    expected = neutral(lives, Turnover.of(lives))
    assert expected.mean == pytest.approx(size * (size + 1) / 2 - 1, rel=0.01)
    means = [observed(Genealogy.of(moran(size, 600, name=10 + 2 * k))).mean for k in range(60)]
    assert np.mean([each for each in means if each is not None]) == pytest.approx(
        expected.mean, rel=0.2
    )


def test_hill_numbers_are_those_of_even_and_uneven_shares() -> None:
    counts = np.array([[5, 5, 5, 5], [10, 0, 0, 0], [0, 0, 0, 0], [6, 3, 1, 0]])
    found = hill_numbers(counts)
    share = np.array([0.6, 0.3, 0.1])
    uneven = [3, np.exp(-(share * np.log(share)).sum()), 1 / (share**2).sum()]
    assert pytest.approx(np.array([[4, 4, 4], [1, 1, 1], [0, 0, 0], uneven])) == found.T


@given(history=HISTORY, founders=st.integers(1, 3))
def test_an_era_begins_with_the_last_founders(history: list[Event], founders: int) -> None:
    lives = walked(history, founders)
    era = last_era(lives)
    first = max(row for row in range(len(lives)) if lives.parent[row] < 0) - founders + 1
    assert era.id.tolist() == list(range(first, len(lives)))


def test_all_organisms_of_a_fork_are_of_its_era() -> None:
    """In the first fork the founder is alive, but a dead organism has living children."""
    for fork in (walked(GROWN).recorded_since(3), moran(7, 70, name=3).recorded_since(60)):
        assert ((fork.parent >= 0) & (fork.parent_row < 0)).any()
        assert last_era(fork).id.tolist() == fork.id.tolist()


def test_the_trunk_follows_the_most_living_descendants() -> None:
    """It follows the larger of two trees. The largest branch is neither the first nor the last."""
    #                 0   1  2  3  4  5  6  7  8  9
    lives = lives_of(
        parent=[-1, -1, -1, 1, 1, 1, 4, 4, 2, 5],
        born=[0, 0, 0, 1, 2, 3, 4, 5, 6, 7],
        ended=[9] * 10,
        died=[False, True, False, False, False, False, False, False, False, False],
    )
    assert Genealogy.of(lives).trunk()[:2].tolist() == [1, 4]


def chance_to_have_met(lives: Lives, since: int) -> dict[int, float]:
    """Return the chance that a pair has met, by ticks back from the end, at births after a tick."""
    births = [
        (int(lives.born[row]), row)
        for row in range(len(lives))
        if lives.parent[row] >= 0 and lives.born[row] > since
    ]
    apart, found = 1.0, {}
    for tick, row in sorted(births, reverse=True):
        before = living_after(lives, tick - 1)
        older = [each for at, each in births if at == tick and each <= row]
        alive = len(before) + len(older)  # children are born before others die
        apart *= 1 - 2 / (alive * (alive - 1))
        found[int(lives.ended.max()) - tick] = 1 - apart
    return found


GROWN: list[Event] = [([0], []), ([0, 1], []), ([2], [1]), ([1, 3], []), ([], [2, 0]), ([1], [])]


def test_times_by_drift_alone_follow_from_births_and_population_since_the_founding() -> None:
    """The population grows and shrinks. Founders, and births before an extinction or up to the tick
    of a fork, do not count."""
    died_out: list[Event] = [([0], []), ([], [0, 1])]
    fork = walked(GROWN + GROWN).recorded_since(8)
    assert (fork.born == 8).any()
    for lives, since, births in (
        (walked(GROWN), 0, 5),
        (walked(died_out + GROWN), 2, 5),
        (fork, 8, 3),
    ):
        expected = chance_to_have_met(lives, since)
        assert len(expected) == births
        era = last_era(lives)
        times = neutral(era, Turnover.of(era))
        found = dict(zip(times.back.tolist(), times.share.tolist(), strict=True))
        assert found == pytest.approx(expected)
        reached = [back for back, share in expected.items() if share >= 0.5]
        assert times.median == next(iter(reached), None)


def test_times_in_a_world_without_life_count_back_from_its_last_tick() -> None:
    """The last organism dies at tick 8, two ticks after the last birth."""
    lives = walked([*GROWN, ([], []), ([], [])])
    dead = replace(lives, cause=np.full(len(lives), Cause.FATAL, np.int8))
    times = neutral(dead, Turnover.of(dead))
    assert times.back.tolist() == neutral(lives, Turnover.of(lives)).back.tolist()
    assert times.back[0] == 2
    assert len(observed(Genealogy.of(dead)).back) == 0


def test_founders_have_no_times_by_drift_alone() -> None:
    """Founders that are born one after another have no common ancestor."""
    lives = lives_of([-1] * 3, [0, 4, 6], [9] * 3, [False] * 3)
    times = neutral(lives, Turnover.of(lives))
    assert (times.share.tolist(), times.mean, times.median) == ([0, 0], None, None)
    observed_times = observed(Genealogy.of(lives))
    assert (observed_times.mean, observed_times.median) == (None, None)
