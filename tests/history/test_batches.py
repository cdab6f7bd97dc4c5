"""Births repeated in batches, with an invented heredity: a genome holds the numbers of its parents."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.errors import Trouble
from primordia.history import pedigree
from primordia.history.pedigree import genomes
from primordia.history.rebuilding import changes, descent
from primordia.random.wide import to_host
from primordia.runs.lives import joined
from tests.assays.lives import COPY, FOUNDER, MUTANT, lives

FIRST = lives(
    *[(-1, FOUNDER, 9)] * 2,
    *[(0, COPY, 9), (1, MUTANT, 9), (0, MUTANT, 9), (2, COPY, 9), (1, COPY, 9), (5, MUTANT, 9)],
    *[(7, COPY, 9), (-1, FOUNDER, 9), (9, MUTANT, 9), (8, MUTANT, 9), (3, COPY, 9)],
)
SECOND = lives((-1, FOUNDER, 9), *[(number, MUTANT, 9) for number in range(9)])
"""A line of ten organisms."""
LIVES = joined([FIRST, SECOND], np.array([0, 1]))
SEEDS = np.array([40, 2**63], np.uint64)
MATES = np.array([-1, -1, 1, 0, 3, 0, -1, 6, 0, -1, 0, 10, 11, *[-1] * 10])
"""The mate of each organism. Some mates are in a later generation than the parent."""


def climate_of(births: Any, ticks: np.ndarray) -> dict[str, np.ndarray]:
    assert ticks.tolist() == births.born.tolist()
    return {"any": 100 * births.world + births.id}


def a_run(mates: np.ndarray | None = None) -> Any:
    """Return a stand-in for a run; the note of each birth is ten times its number."""

    def of(column: Any, some: Any) -> np.ndarray:
        return column[LIVES.rows_of(some.world, some.id)]

    return SimpleNamespace(
        lives=LIVES,
        schema=SimpleNamespace(mates=mates is not None),
        config=SimpleNamespace(fork=None),
        layout=SimpleNamespace(length=4, names=("all",)),
        heredity="the run's",
        world_seeds=SEEDS,
        origin=None,
        notes_of=lambda some: of(10 * LIVES.id[:, None], some),
        mates_of=lambda some: of(mates, some),
    )


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> int:
    """Repeat three births in one call, or one: generations have up to six, and lines up to ten."""
    monkeypatch.setattr(pedigree, "FEW", 1)
    monkeypatch.setattr(pedigree, "AT_ONCE", 3)
    monkeypatch.setattr(pedigree, "PastClimate", lambda _: SimpleNamespace(of_lives=climate_of))
    return 3


@pytest.mark.parametrize("redrawn", [False, True])
def test_each_birth_of_a_pedigree_has_its_own_parents_and_notes(
    redrawn: bool, at_once: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A genome is the number of the newborn, of its parent and of its mate, and its note.

    The number of a missing parent is 0, and that of a missing mate is -1.
    """
    births: list[int] = []

    def repeat(counts: tuple, marks: tuple, climate: dict, of: tuple, notes: np.ndarray) -> Any:
        (seed, number, tick), (cell, _) = counts, marks
        number = to_host(number).astype(int)
        assert len(number) in {1, at_once}
        assert number.tolist() == to_host(tick).tolist() == cell.tolist()
        world = climate["any"] // 100
        assert (climate["any"] % 100).tolist() == number.tolist()
        assert (to_host(seed) == SEEDS[world]).all()
        births.extend(set((100 * world + number).tolist()))
        genome = [number, of[0][:, 0], np.where(of[2], of[1][:, 0], -1), notes[:, 0]]
        return np.stack(genome, axis=1).astype(np.float32)

    def shared(function: Any, *fixed: Any) -> Any:
        assert (function, *fixed) == (pedigree._repeat, "the run's", redrawn)
        return repeat

    monkeypatch.setattr(pedigree, "shared", shared)
    rows = np.array([22, 12, 4, 0, 8, 12, 11, 20])
    expected = [
        [LIVES.id[row], max(LIVES.parent[row], 0), MATES[row], note]
        for row, note in zip(rows, 10 * LIVES.id[rows], strict=True)
    ]
    assert genomes(a_run(MATES), rows, redrawn).tolist() == expected
    assert len(births) == len(set(births)), "no birth is repeated twice"


def test_the_changes_of_a_line_are_those_from_parent_to_child(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The genome of an organism is its row. Organisms alive at a fork, and the first, have no change."""
    monkeypatch.setattr(pedigree, "genomes", lambda run, rows: np.float32(rows[:, None]))
    run = a_run()
    run.layout.split = lambda genomes: {"all": genomes[:, :, None]}
    for organism, world, line in ((9, 1, [1] * 9), (11, 0, [2, 3, 2, 1, 3]), (0, 0, [])):
        found = changes(run, organism, world)
        assert np.isnan(found[0, 0])
        assert found[1:, 0].tolist() == line
    inherited = np.isin(np.arange(len(LIVES)), [0, 2])
    run.lives = replace(LIVES, inherited=inherited)
    np.testing.assert_array_equal(changes(run, 11, 0)[:, 0], [np.nan, np.nan, 3, 2, 1, 3])


@pytest.mark.parametrize(("organism", "mate"), [(4, 4), (12, 13), (1, 2**40)])
def test_a_mate_that_was_not_born_before_its_child_is_damage(organism: int, mate: int) -> None:
    mates = MATES.copy()
    mates[organism] = mate
    with pytest.raises(Trouble, match=f"the mate of organism {organism} was not born before it"):
        genomes(a_run(mates), np.array([12]))


def test_a_line_of_descent_begins_with_its_last_founder() -> None:
    """Without heredity, children are founders that have a mother."""
    line = lives((-1, FOUNDER, 9), (0, COPY, 9), (1, FOUNDER, 9), (2, MUTANT, 9), (3, COPY, 9))
    assert [descent(line, last, 0).tolist() for last in (1, 2, 4)] == [[0, 1], [2], [2, 3, 4]]
