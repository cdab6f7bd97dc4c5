"""Recombination: units come whole from either parent; mates are living neighbours of the child."""

from typing import Any

import jax
import numpy as np
import pytest

from primordia.brains.layout import Layout
from primordia.compiled import shared
from primordia.law.placement import Placement
from primordia.law.recombination import Recombination
from primordia.mutations.contract import Draws
from primordia.random.keys import Purpose, streams
from primordia.random.wide import Wide, wide
from primordia.settings.islands import Islands
from tests.chance import binomial
from tests.worlds import MILL, Lived, config

LAYOUT = Layout((("input", (4, 7)), ("recurrent", (4, 4)), ("output", (2, 4)), ("bias", (4,))))
K = 3_000


def children(unit: Any) -> np.ndarray:
    """Return which weights of K children come from the mate, bool (K, P)."""
    drawn = streams(wide(np.arange(K)), wide(np.zeros(K)), Purpose.CROSS)
    draws = Draws(drawn, np.zeros(K, np.int32))
    zeros = np.zeros((K, LAYOUT.length), np.float32)
    recombined = shared(Recombination.recombined, Recombination(unit=unit), LAYOUT)
    return np.asarray(recombined(draws, zeros, zeros + 1)) == 1


def mates_of(word: Wide, candidates: np.ndarray, probability: float = 1.0) -> np.ndarray:
    return np.asarray(
        shared(Recombination.mates, Recombination(probability=probability))(word, candidates)
    )


@pytest.mark.parametrize(("unit", "count"), [("block", 4), ("row", 6)])
def test_units_are_whole_and_come_from_either_parent_alike(unit: str, count: int) -> None:
    units, mates = Recombination(unit=unit).units(LAYOUT), children(unit)
    assert units.max() + 1 == count
    for number in range(count):
        of = mates[:, units == number]
        assert (of.all(axis=1) | ~of.any(axis=1)).all()
        assert binomial(int(of[:, 0].sum()), K, 0.5)
    firsts = mates[:, [int(np.argmax(units == number)) for number in range(count)]]
    assert abs(np.corrcoef(firsts.T) - np.eye(count)).max() < 0.1


def test_a_row_of_all_blocks_of_its_height_is_one_unit() -> None:
    units = LAYOUT.split(Recombination().units(LAYOUT)[None])
    np.testing.assert_array_equal(units["input"][0], np.tile([[0], [1], [2], [3]], 7))
    np.testing.assert_array_equal(units["recurrent"][0][:, 0], [0, 1, 2, 3])
    np.testing.assert_array_equal(units["bias"][0], [0, 1, 2, 3])
    np.testing.assert_array_equal(units["output"][0], [[4] * 4, [5] * 4])


def test_every_candidate_is_as_likely_to_be_the_mate() -> None:
    candidates = np.zeros((K, 6), bool)
    candidates[:, [1, 4, 5]] = True
    candidates[: K // 2, 5] = False
    candidates[0] = False
    word = Wide(*np.random.default_rng(2).integers(0, 2**32, (2, K), np.uint32))
    mates = mates_of(word, candidates)
    assert mates[0] == -1
    assert set(mates[1 : K // 2]) == {1, 4}
    for cell in (1, 4, 5):
        assert binomial(int((mates[K // 2 :] == cell).sum()), K // 2, 1 / 3)
    few = mates_of(word, candidates, 0.25)
    assert binomial(int((few[1:] >= 0).sum()), K - 1, 0.25)
    with_all = few[K // 2 :]
    for cell in (1, 4, 5):
        assert binomial(int((with_all == cell).sum()), int((with_all >= 0).sum()), 1 / 3)


def test_a_mate_is_chosen_by_the_high_word_and_refused_by_the_low_one() -> None:
    """The high word picks one of the candidates. A low word below the probability brings a mate."""
    random = np.random.default_rng(6)
    candidates = random.random((200, 7)) < 0.5
    high, low = random.integers(0, 2**32, (2, 200), np.uint32)
    low[:4] = 2**31 - 1, 2**31, 0, 2**32 - 1
    candidates[:4] = True
    for probability in (0.0, 0.5, 1.0):
        found = mates_of(Wide(high, low), candidates, probability)
        for row, mate in enumerate(found.tolist()):
            cells = np.flatnonzero(candidates[row]).tolist()
            wanted = cells and int(low[row]) < probability * 2**32
            assert mate == (cells[int(high[row]) * len(cells) >> 32] if wanted else -1)


def test_rows_of_blocks_of_equal_height_share_units_and_other_rows_have_their_own() -> None:
    layout = Layout((("a", (3, 2)), ("b", (1, 5)), ("c", (2, 2, 2)), ("d", (3,)), ("e", (4, 1))))
    rows = [0, 0, 1, 1, 2, 2, *[3] * 5, *[4] * 4, *[5] * 4, 0, 1, 2, 6, 7, 8, 9]
    assert Recombination(unit="row").units(layout).tolist() == rows
    blocks = [0] * 6 + [1] * 5 + [2] * 8 + [3] * 3 + [4] * 4
    assert Recombination(unit="block").units(layout).tolist() == blocks


@pytest.mark.parametrize(
    ("topology", "cells", "near"),
    [
        ("ring", 6, {1, 5}),
        ("ring", 2, {1}),
        ("torus4", 9, {1, 2, 3, 6}),
        ("torus8", 9, {1, 2, 3, 4, 5, 6, 7, 8}),
        ("well-mixed", 4, {1, 2, 3}),
    ],
)
def test_neighbours_are_those_of_the_topology(topology: Any, cells: int, near: set[int]) -> None:
    near_of = jax.jit(Placement(topology=topology).near, static_argnums=1)
    found = np.asarray(near_of(np.int32([0, cells - 1]), Islands(("",), (0, cells))))
    assert set(np.flatnonzero(found[0]).tolist()) == near
    assert found[1].sum() == len(near)
    assert not found[1, cells - 1]


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["blind", pytest.param("replacing", marks=pytest.mark.slow)])
def test_a_child_is_made_of_parent_and_mate_as_they_are_when_it_is_born(rule: str) -> None:
    """Without mutation each weight of a child is its parent's or its mate's."""
    settings = {
        **MILL,
        "brain": {"hidden": 3},
        "mutation": {"probability": 0.0, "founder_scale": 0.5},
        "recombination": {"probability": 0.8},
        "placement": {"topology": "torus8", "rule": rule},
        "genesis": "fill",
        "hazard": 0.1,
        "replication": 0.2,
        "seasons": [],
    }
    lived, mixed = Lived(config(settings), 1), 0
    genomes: dict[int, np.ndarray] = {}
    for tick in range(2, 80):
        lived.advance_to(tick)
        organisms = lived.engine.state.world.organisms
        numbers = np.asarray(organisms.number.lo)[np.asarray(organisms.alive)]
        genomes.update(zip(numbers.tolist(), lived.genomes(), strict=True))
    births, deaths = lived.table("births"), lived.table("deaths")
    died = dict(zip(deaths["id"], zip(deaths["tick"], deaths["cause"], strict=True), strict=True))
    for number, tick, parent, mate in zip(
        *(births[name] for name in ("id", "tick", "parent", "mate")), strict=True
    ):
        if np.isnan(parent) or number not in genomes:
            continue
        own, of_parent = genomes[number], genomes[int(parent)]
        if np.isnan(mate):
            np.testing.assert_array_equal(own, of_parent)
            continue
        assert mate not in (parent, number)
        end, cause = died.get(mate, (tick + 1, ""))
        assert end > tick or (end == tick and cause == "replaced")
        of_mate = genomes[int(mate)]
        assert ((own == of_parent) | (own == of_mate)).all()
        mixed += bool((own != of_parent).any() and (own != of_mate).any())
    assert mixed > 10
