"""The neutral shadow: it finds selection where there was some, and nothing where there was none."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st

import primordia
from primordia.assays import shadow as module
from primordia.assays.shadow import Shadow, _lifespans, _sample, shadow
from primordia.comparison.resample import resamples
from primordia.errors import InputError
from primordia.law.metabolism import Rates
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.lives import Lives
from primordia.settings.islands import Islands
from tests.commands import complains, here
from tests.synthetic import worlds_of


def six_worlds(folder: Path, **settings: Any) -> primordia.Run:
    """Return an arm of six worlds of poles."""
    for seed in range(6):
        own = {"seed": seed, "cells": 8, "hazard": 0.002, **settings}
        primordia.run("CartPole-survival", folder / str(seed), **own)
    return primordia.load(folder)


def of(original: list[list[int]], redrawn: list[list[int]], cut: int = 100) -> Shadow:
    """Return a result with these lives in each world."""
    world = np.repeat(np.arange(len(original)), [len(each) for each in original])
    lives = (np.concatenate(each).astype(np.int64) for each in (original, redrawn))
    return Shadow("run", len(world), world.astype(np.int32), *lives, cut)  # type: ignore[call-arg]


@pytest.mark.slow
def test_selection_is_found_where_children_inherit(tmp_path: Path) -> None:
    found = six_worlds(tmp_path, cells=32, stop={"ticks": 12_000}).shadow(40, 500)
    assert found.longer == (6, 0)
    assert found.p == 2 / 2**6
    assert found.ratio_interval is not None
    assert 1.5 < found.ratio_interval[0] <= found.ratio <= found.ratio_interval[1]


@pytest.mark.slow
def test_nothing_is_found_where_children_inherit_nothing(tmp_path: Path) -> None:
    """Founders are drawn, and no draw has anything to do with those before it."""
    arm = six_worlds(tmp_path, cells=32, inheritance="founder", stop={"ticks": 12_000})
    found = arm.shadow(40, 500)
    assert found.p > 0.05
    assert found.ratio_interval is not None
    assert found.ratio_interval[0] < 1 < found.ratio_interval[1]


def test_a_life_is_the_same_beside_any_others(poles: primordia.Run) -> None:
    run = poles.opened()
    rows = np.flatnonzero(run.lives.rank < 36)[::2]
    for redrawn in (False, True):
        together = _lifespans(run, rows, redrawn, 100)
        assert len(np.unique(together)) > 10
        alone = _lifespans(run, rows[1::2], redrawn, 100)
        np.testing.assert_array_equal(alone, together[1::2])


@given(st.lists(st.tuples(st.integers(1, 9), st.integers(1, 9)), min_size=1, max_size=30))
def test_the_sign_test_is_the_binomial_test(pairs: list[tuple[int, int]]) -> None:
    found = of([[one] for one, _ in pairs], [[other] for _, other in pairs])
    more, fewer = sum(a > b for a, b in pairs), sum(a < b for a, b in pairs)
    assert found.longer == (more, fewer)
    expected = scipy.stats.binomtest(more, more + fewer).pvalue if more + fewer else 1.0
    assert found.p == pytest.approx(expected)
    assert (found.ratio_interval is None) == (len(pairs) < 5)


def test_numbers_over_worlds_are_medians_of_their_ratios() -> None:
    """Six worlds of unequal size, with ratios 1/2, 1, 2, 3, 4 and 60; some lives reach the cut."""
    original = [[10], [10, 30], [40], [60, 60, 60], [20, 60], [600, 600]]
    shadow = [[20], [20, 20], [20], [20, 10, 30], [10, 10], [10, 10]]
    found = replace(of(original, shadow, cut=60), births=99)
    ratios = np.array([0.5, 1, 2, 3, 4, 60])
    assert found.longer == (4, 1)
    assert found.p == pytest.approx(12 / 32), "four or more of five, on either side"
    assert found.ratio == 2.5
    (drawn,) = resamples(6)
    medians = np.sort([np.median(ratios[rows]) for rows in drawn])
    assert found.ratio_interval == (medians[25], medians[-1 - 25])
    plain = found.to_dict()
    lives = [np.concatenate(each) for each in (original, shadow)]
    assert [plain[line]["mean"] for line in ("original", "shadow")] == [
        pytest.approx(each.mean()) for each in lives
    ]
    assert plain["original"]["reached_cut"] == 6
    assert plain["shadow"]["reached_cut"] == 0
    expected = {
        "name": "run", "worlds": 6, "births": 99, "organisms": 11, "cut": 60,
        "ticks": lives[0].sum() + lives[1].sum(), "worlds_longer": 4, "worlds_shorter": 1,
        "p": found.p, "ratio": 2.5, "interval": found.ratio_interval,
    }  # fmt: skip
    assert expected.items() <= plain.items()


def test_organisms_are_in_the_middle_of_equal_parts_of_all_births_but_the_last() -> None:
    """World 3 has nine births, world 5 three, world 6 one, and world 8 two."""
    worlds = np.repeat([3, 5, 6, 8], [9, 3, 1, 2])
    rows = 100 + 2 * np.arange(len(worlds))
    third, fifth, eighth = rows[:8], rows[9:11], rows[13:14]
    assert _sample(worlds, rows, 2).tolist() == [*third[[2, 6]], *fifth, *eighth]
    assert _sample(worlds, rows, 4).tolist() == [*third[[1, 3, 5, 7]], *fifth, *eighth]
    assert _sample(worlds, rows, 1).tolist() == [third[4], fifth[1], *eighth]
    assert _sample(worlds, rows, 100).tolist() == [*third, *fifth, *eighth]


def test_lives_are_cut_at_the_age_of_saturation_or_at_a_given_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Organisms that were alive at a fork are not counted. The second world has one birth, too few."""
    cuts: list[int] = []

    def lifespans(run: Any, rows: np.ndarray, redrawn: bool, cut: int) -> np.ndarray:
        cuts.append(cut)
        return rows + 1000 * redrawn

    monkeypatch.setattr(module, "_lifespans", lifespans)
    lives = worlds_of([(k, 0, True) for k in range(10)], [(3, 1, True)] * 4, until=50)
    lives.inherited[[0, 1, 2, 10, 11, 12]] = True
    run: Any = SimpleNamespace(
        config=SimpleNamespace(saturation_ticks=77), lives=lives, path=Path("runs/a"), made_on="cpu"
    )
    found = shadow(run)
    assert (found.name, found.births, found.cut) == ("a", 8, 77)
    assert found.original.tolist() == [*range(3, 9)]
    assert (found.shadow - found.original).tolist() == [1000] * 6
    assert found.world.tolist() == [0] * 6
    assert shadow(run, 3, 1).cut == 1
    assert cuts == [77, 77, 1, 1]
    for numbers in ((0, 1), (1, 0)):
        with pytest.raises(InputError, match="at least one organism and one tick"):
            shadow(run, *numbers)
    lives.inherited[:9] = True
    with pytest.raises(InputError, match="runs/a: shadow needs two births in a world"):
        shadow(run)


def test_the_command_prints_what_python_gives(poles: primordia.Run) -> None:
    words = "shadow", poles.path, "--organisms", 10, "--ticks", 100
    done = here(*words, "--json")
    assert json.loads(done.stdout) == {"arms": [poles.shadow(10, 100).to_dict()]}
    complains(here("shadow", poles.path, "--organisms", 0), 2, "--organisms", "0")
    complains(here("shadow", poles.path.parent / "no"), 2, "no")


@pytest.mark.parametrize("redrawn", [False, True])
def test_an_organism_is_born_again_with_keys_of_its_world_and_birth_number(
    redrawn: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Birth numbers of a fork have gaps. An original and its shadow have the same keys."""
    lives = worlds_of([(k, 0, True) for k in range(4)], [(3, 1, True)] * 3, until=50)
    lives.id[:] = [3, 5, 8, 9, 3, 4, 7]
    rows, seeds = np.array([1, 3, 4, 6]), np.array([40, 2**63], np.uint64)
    climate = {f"metabolism.{name}": np.arange(4.0) for name in Rates._fields}
    asked: list[Any] = []

    def of_lives(births: Lives, ticks: np.ndarray) -> dict[str, np.ndarray]:
        assert births.id.tolist() == [5, 9, 3, 7]
        assert ticks.tolist() == births.born.tolist(), "the climate is that of the birth"
        return climate

    def genomes(*given: Any) -> str:
        asked.append(given[1:])
        return "genomes"

    monkeypatch.setattr(module, "PastClimate", lambda _: SimpleNamespace(of_lives=of_lives))
    monkeypatch.setattr("primordia.history.pedigree.genomes", genomes)
    monkeypatch.setattr(module, "lifespans", lambda players, cut: (players, cut))
    run: Any = SimpleNamespace(
        lives=lives,
        world_seeds=seeds,
        law="law",
        config=SimpleNamespace(
            saturation_ticks=77, build_habitat=lambda: "habitat", islands=Islands(("",), (0, 99))
        ),
    )
    found: Any = _lifespans(run, rows, redrawn, 9)
    (law, habitat, made, keys, rates, island), cut = found
    assert island.tolist() == [0] * 4
    assert (law, habitat, made, cut, asked) == ("law", "habitat", "genomes", 9, [(rows, redrawn)])
    expected = stream(wide(seeds[[0, 0, 1, 1]]), Purpose.REBIRTH, wide(np.array([5, 9, 3, 7])))
    for half in ("hi", "lo"):
        np.testing.assert_array_equal(getattr(keys, half), getattr(expected, half))
    assert rates.drain.tolist() == [0, 1, 2, 3]
