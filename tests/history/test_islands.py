"""The numbers of islands, counted again one organism at a time, and the natives of an island."""

from dataclasses import replace
from statistics import median
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.history.families import families, families_by_world
from primordia.history.heredity import heredity
from primordia.history.islands import (
    born_on,
    champions,
    late_born,
    names_of,
    number_of,
    oldest,
    on_islands,
)
from primordia.history.threshold import threshold
from primordia.runs.lives import Lives, joined
from primordia.settings.islands import Islands
from tests.pedigrees import moran

ISLANDS = Islands(("sea", "lagoon", "pond"), (0, 4, 6, 12))
PLAIN = Islands(("",), (0, 12))


def scattered(name: int) -> Lives:
    """Return the lives of one world, in random cells of which the last island has none."""
    lives = moran(12, 90, name)
    return replace(
        lives, cell=np.random.default_rng(name).integers(0, 6, len(lives)).astype(np.int32)
    )


def run_of(lives: Lives, islands: Islands = ISLANDS, worlds: int = 2) -> Any:
    config = SimpleNamespace(islands=islands, seeds=worlds, act=None)
    return SimpleNamespace(lives=lives, config=config)


TWO = joined([scattered(1), scattered(2)], np.array([0, 1]))
FORKED = TWO.recorded_since(25)


@pytest.mark.parametrize("lives", [TWO, FORKED], ids=["run", "fork"])
def test_the_numbers_of_an_island_are_those_of_its_organisms(lives: Lives) -> None:
    home, late = ISLANDS.of_cells(lives.cell), lives.late()
    seen = 0
    for found in on_islands(run_of(lives)):
        island = ISLANDS.names.index(found.name)
        own = [
            row
            for row in range(len(lives))
            if lives.world[row] == found.world and home[row] == island
        ]
        alive = [row for row in own if not lives.died[row]]
        born = [row for row in own if not lives.inherited[row]]
        parents = [lives.rows_of(lives.world[[row]], lives.parent[[row]])[0] for row in born]
        ages = [lives.ended[row] - lives.born[row] for row in alive]
        spans = [lives.lifespan[row] for row in own if lives.died[row] and late[row]]
        assert found.cells == ISLANDS.sizes[island]
        assert (found.living, found.births) == (len(alive), len(born))
        assert found.immigrants == sum(up >= 0 and home[up] != island for up in parents)
        assert found.mean_age == (pytest.approx(np.mean(ages)) if ages else None)
        assert found.median_lifespan == (median(spans) if spans else None)
        seen += len(born)
    assert seen == (~lives.inherited).sum()
    empty = on_islands(run_of(lives))[-1].to_dict()
    assert empty == {
        "world": 1, "name": "pond", "cells": 6, "living": 0, "births": 0, "immigrants": 0,
        "mean_age": None, "median_lifespan": None,
    }  # fmt: skip


def test_plain_worlds_have_no_islands() -> None:
    run = run_of(TWO, PLAIN)
    assert on_islands(run) == []
    assert born_on(run, None).all()
    assert names_of(PLAIN, TWO.cell) is None
    assert names_of(ISLANDS, np.array([0, 11, 4])) == ["sea", "pond", "lagoon"]


def test_an_unknown_island_is_refused() -> None:
    words = "--island lagon: there is no island 'lagon'; known: sea, lagoon, pond; did you mean 'lagoon'"
    with pytest.raises(InputError, match=words):
        born_on(run_of(TWO), "lagon")
    with pytest.raises(
        InputError, match="--island sea: there is no island 'sea'; the worlds of this"
    ):
        born_on(run_of(TWO, PLAIN), "sea")
    with pytest.raises(
        InputError, match=r"^--on ice: there is no island 'ice'; known: sea, lagoon, pond$"
    ):
        number_of(ISLANDS, "ice", "--on")


def test_champions_of_an_island_are_its_longest_lived_natives() -> None:
    """Births are late among all births of their world."""
    run, late = run_of(TWO), TWO.late()
    native = ISLANDS.of_cells(TWO.cell) == 1
    np.testing.assert_array_equal(born_on(run, "lagoon"), native)
    np.testing.assert_array_equal(late_born(run, island="lagoon"), np.flatnonzero(native & late))
    rows = champions(run, "lagoon").tolist()
    for world, row in enumerate(rows):
        there = np.flatnonzero(native & late & (TWO.world == world))
        assert row in there
        assert TWO.lifespan[row] == TWO.lifespan[there].max()
        assert oldest(run, world, island="lagoon") == row
    assert champions(run).tolist() == TWO.champions().tolist()
    assert champions(run, "sea").tolist() != rows
    with pytest.raises(InputError, match="nothing has been born late on this island"):
        oldest(run, 0, island="pond")


def test_parents_and_children_are_both_natives() -> None:
    run, home = run_of(TWO), ISLANDS.of_cells(TWO.cell)
    for world, found in enumerate(families_by_world(run, island="sea")):
        lives, late = TWO.of_world(world), TWO.of_world(world).late()
        own = home[TWO.world == world]
        pairs = [
            (row, up)
            for row, up in enumerate(lives.parent_row.tolist())
            if late[row] and up >= 0 and own[row] == own[up] == 0
        ]
        assert len(pairs) > 5
        assert [
            *zip(found.lives.id[found.child], found.lives.id[found.parent], strict=True)
        ] == pairs
        assert len(found.born) == (late & (own == 0)).sum()
    for plain, island in zip(families_by_world(run), TWO.by_world(), strict=True):
        np.testing.assert_array_equal(plain.child, families(island).child)
    assert heredity(run, island="sea")[1].both.pairs < heredity(run)[1].both.pairs
    assert [each.both.pairs for each in heredity(run, island="pond")] == [0, 0]
    assert [each.mutated for each in threshold(run, island="pond")] == [None, None]
