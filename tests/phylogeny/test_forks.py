"""The record of a run up to a fork, joined with the record of the fork, for forks at each tick."""

from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.errors import InputError
from primordia.phylogeny import forks
from primordia.phylogeny.forks import AS_INHERITED
from primordia.phylogeny.phylogeny import Phylogeny
from primordia.runs.lives import Lives, joined
from tests.pedigrees import walked

LIVED: list = [
    ([0, 1], []),
    ([1], [0]),
    ([], []),
    ([0, 1, 2], [1]),
    ([2], [0, 3]),
    ([0], []),
    ([], [1]),
]
OTHER: list = [([0], []), ([], []), ([0, 1], [1]), ([1], []), ([0, 2], [0]), ([], [2]), ([1], [0])]
WHOLE = joined([walked(LIVED, 2), walked(OTHER, 2)], np.array([0, 1]))
END = len(LIVED)


def with_facts(lives: Lives, more: float) -> Phylogeny:
    """Return lives with a fact of each birth and of each death, different in each record."""
    number = lives.id + 1000.0 * lives.world + more
    food = pa.array(number / 2, mask=~lives.died)
    return Phylogeny(lives, {"note": pa.array(number)}, {"food": food})


def source(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a run that has gone on after its forks."""
    monkeypatch.setattr(forks, "recorded", lambda _: with_facts(WHOLE, 0.25))
    return SimpleNamespace(path=Path("run"), ends=np.array([END, END]))


def births_by(tick: int) -> np.ndarray:
    """Return the number of births of each world up to a tick."""
    return np.bincount(WHOLE.world[WHOLE.born <= tick], minlength=2)


def check_lives(found: Lives, expected: Lives) -> None:
    for each in fields(Lives):
        np.testing.assert_array_equal(getattr(found, each.name), getattr(expected, each.name))


def forked(tick: int, monkeypatch: pytest.MonkeyPatch, more: int = 0) -> Any:
    """Return a fork with the births until its tick, and `more` births in the second world."""
    counted = np.add(births_by(tick), [0, more])
    monkeypatch.setattr(forks, "read_count", lambda *_: counted)
    return SimpleNamespace(config=SimpleNamespace(fork=SimpleNamespace(tick=tick)), origin={})


@pytest.mark.parametrize("tick", range(1, END + 1))
def test_a_run_until_its_fork_and_the_fork_are_the_whole_life(
    tick: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Births until the fork are those of the run. Lives end as the fork records."""
    run, fork = source(monkeypatch), forked(tick, monkeypatch)
    later = with_facts(WHOLE.recorded_since(tick), 0.75)
    found = forks._joined(forks._until(run, tick), later, fork)
    assert found is not None
    check_lives(found.lives, WHOLE)
    number = WHOLE.id + 1000.0 * WHOLE.world
    notes = np.where(WHOLE.born <= tick, number + 0.25, number + 0.75)
    assert found.of_births["note"].to_pylist() == notes.tolist()
    early = WHOLE.died & (WHOLE.ended <= tick)
    food = np.where(early, number + 0.25, number + 0.75) / 2
    assert found.of_deaths["food"].to_pylist() == [
        value if died else None for value, died in zip(food.tolist(), WHOLE.died, strict=True)
    ]


def test_worlds_with_large_numbers_keep_their_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """The numbers of the two worlds are 0 and 256, which have the same last eight bits."""
    births = np.zeros(257, int)
    births[[0, 256]] = births_by(4)
    fork = forked(4, monkeypatch)
    monkeypatch.setattr(forks, "read_count", lambda *_: births)
    whole = replace(WHOLE, world=WHOLE.world * 256)
    earlier, later = whole.recorded_until(4), whole.recorded_since(4)
    found = forks._joined(with_facts(earlier, 0.25), with_facts(later, 0.75), fork)
    assert found is not None
    check_lives(found.lives, whole)


def test_a_run_is_not_cut_at_a_tick_that_a_world_has_not_reached(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = source(monkeypatch)
    for ends in ([END, END - 1], [END - 1, END]):
        run.ends = np.array(ends)
        assert len(forks._until(run, END - 1)) == (WHOLE.born < END).sum()
        with pytest.raises(InputError, match=f"run has not reached tick {END}"):
            forks._until(run, END)


@pytest.mark.parametrize("column", AS_INHERITED)
def test_a_fork_of_another_run_is_recognised_by_any_of_its_inherited_columns(
    column: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    run, fork = source(monkeypatch), forked(4, monkeypatch)
    lives = WHOLE.recorded_since(4)
    values = getattr(lives, column).copy()
    values[np.flatnonzero(lives.inherited)[-1]] += 1
    later = with_facts(replace(lives, **{column: values}), 0.75)
    assert forks._joined(forks._until(run, 4), later, fork) is None


def test_a_fork_of_another_run_is_recognised_by_its_birth_numbers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run, later = source(monkeypatch), with_facts(WHOLE.recorded_since(4), 0.75)
    for more, same in ((-1, False), (0, True), (1, False)):
        fork = forked(4, monkeypatch, more)
        assert (forks._joined(forks._until(run, 4), later, fork) is not None) == same
    fork.origin = None
    assert forks._joined(forks._until(run, 4), later, fork) is None
    fork = forked(4, monkeypatch)
    monkeypatch.setattr(forks, "read_count", lambda *_: np.array([99]))
    assert forks._joined(forks._until(run, 4), later, fork) is None
