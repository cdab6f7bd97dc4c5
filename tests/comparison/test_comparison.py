"""Comparisons of invented runs: the lives, ticks and worlds that each number counts."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.comparison import comparison as module
from primordia.comparison.comparison import compare
from primordia.comparison.differing import differing
from primordia.comparison.measured import Measured
from primordia.comparison.moments import saturation
from primordia.comparison.pace import Gathering
from primordia.comparison.tables import comparison_tables
from primordia.errors import InputError
from primordia.runs.arrays import NEVER
from primordia.runs.lives import Lives, joined
from tests.synthetic import worlds_of
from tests.worlds import MEADOW, config

AGE, UNTIL = 20, 120
Saturated = dict[int, tuple[int, int]]
"""World -> births and ticks to its saturation."""


def lived(worlds: int, name: int) -> Lives:
    """Return lives. All but the last three of each world end before the tick UNTIL."""
    draw = np.random.default_rng(name)
    born = [np.sort(draw.integers(0, 90, 40)) for _ in range(worlds)]
    lives = [
        [(int(at), int(draw.integers(0, 29)), k < 37) for k, at in enumerate(each)] for each in born
    ]
    return worlds_of(*lives, until=UNTIL)


def run(
    name: str,
    lives: Lives,
    saturated: Saturated | None = None,
    rate: float | None = None,
    task: str = "meadow",
    path: Path | None = None,
    **settings: Any,
) -> Any:
    """Return a stand-in for a run with these lives, without food."""
    worlds = lives.worlds
    chosen = {"seeds": worlds, "saturation_ticks": AGE, **settings}
    counts = {
        "births": np.bincount(lives.world, minlength=worlds),
        "tick": [int(lives.of_world(world).ended.max()) for world in range(worlds)],
        "saturated": np.full(worlds, NEVER, np.uint64),
        "saturated_births": np.zeros(worlds, np.uint64),
        "food": np.zeros(worlds, np.uint64),
    }
    for world, (births, tick) in (saturated or {}).items():
        counts["saturated_births"][world], counts["saturated"][world] = births, tick
    where = path or Path("runs") / name
    settled = config({**MEADOW, "task": task}, **chosen)
    return SimpleNamespace(
        path=where,
        paths=(where,),
        config=settled,
        lives=lives,
        description=SimpleNamespace(rate=rate),
        world_seeds=settled.world_seeds,
        count=lambda name: np.array(counts[name.removeprefix("world.worlds.")], np.uint64),
    )


def mean_until(lives: Lives, age: int) -> list[float]:
    """Return the mean of the lives of each world, each cut at an age; no life is censored before it."""
    worlds = [lives.of_world(world) for world in range(lives.worlds)]
    return [float(np.minimum(world.lifespan, age).mean()) for world in worlds]


def test_lives_count_up_to_the_smallest_age_of_all_runs() -> None:
    one, two = lived(3, 1), lived(4, 2)
    compared = compare([run("a", one), run("b", two, saturation_ticks=15, seed=9)])
    assert compared.age == 15
    for arm, lives in zip(compared.arms, (one, two), strict=True):
        assert arm.survival.limit == 15
        np.testing.assert_allclose(arm.measured["lifespan"].value, mean_until(lives, 15))
        longest = [lives.of_world(world).lifespan.max() for world in range(lives.worlds)]
        assert arm.measured["longest"].value.tolist() == longest
    assert [arm.worlds for arm in compared.arms] == [3, 4]


def test_a_life_of_exactly_the_smallest_age_is_long() -> None:
    """Lives of the first world have 4, 15 and 31 ticks, and those of the second have 14 and 20."""
    living = (50, 0, False)
    one, two = [(0, 3, True), (1, 14, True), (2, 30, True)], [(0, 13, True), (1, 19, True)]
    lives = worlds_of([*one, living], [*two, living], until=UNTIL)
    for ages, first in (
        ((15, 20), [2, 2]),
        ((20, 16), [3, 2]),
        ((20, 20), [3, 2]),
        ((30, 21), [3, 3]),
    ):
        runs = [
            run(name, lives, saturation_ticks=age) for name, age in zip("ab", ages, strict=True)
        ]
        arms = compare(runs).arms
        for arm in arms:
            assert arm.measured["first"].value.tolist() == first
            assert arm.measured["first"].known.all()


def test_a_crash_depends_on_the_cells_of_its_own_run() -> None:
    """Four children are alive before the world dies out, which are half of 8 cells, and not of 16."""
    lives = worlds_of([(0, 9, True), *[(1, 8, True)] * 4, (10, 5, False)], until=60)
    lives.parent[1:5] = 0
    for cells, crashes in (((8, 16), [1, 0]), ((16, 8), [0, 1])):
        runs = [run(name, lives, cells=size) for name, size in zip("ab", cells, strict=True)]
        compared = compare(runs)
        assert [arm.extinctions.total.tolist() for arm in compared.arms] == [[1], [1]]
        assert [arm.extinctions.crashes.tolist() for arm in compared.arms] == [
            [each] for each in crashes
        ]
        runs = compared.to_dict()["runs"]
        assert [each["crashes"] for each in runs] == crashes
        assert [each["extinctions"] for each in runs] == [1, 1]


def test_all_worlds_are_compared_up_to_the_first_end() -> None:
    """One world of the second run ends first."""
    one, two = lived(2, 1), lived(3, 2)
    stopped = two.of_world(1).recorded_until(60)
    two = joined([two.of_world(0), stopped, two.of_world(2)], np.zeros(3, int))
    compared = compare([run("a", one), run("b", two)])
    for arm, lives in zip(compared.arms, (one, two), strict=True):
        assert arm.pace.edges.tolist() == np.linspace(0, 60, 13).tolist()
        cut = lives.recorded_until(60)
        longest = [cut.of_world(world).lifespan.max() for world in range(cut.worlds)]
        assert arm.measured["longest"].value.tolist() == longest
        late = [
            ((w.ended > 45) & (w.ended <= 60) & w.died).sum()
            for w in map(cut.of_world, range(cut.worlds))
        ]
        assert arm.pace.deaths[:, -3:].sum(axis=1).tolist() == late


@pytest.mark.parametrize(("saturated", "whole"), [(1, False), (2, True)])
def test_lives_are_cut_only_if_saturation_is_rare_in_all_runs(saturated: int, whole: bool) -> None:
    """Lives are cut if fewer than half of each run's worlds saturate."""
    one, two = lived(4, 1), lived(4, 2).recorded_until(70)
    some: Saturated = dict.fromkeys(range(saturated), (30, 60))
    compared = compare([run("a", one, some), run("b", two)])
    seen = one if whole else one.recorded_until(70)
    longest = [seen.of_world(world).lifespan.max() for world in range(4)]
    assert compared.arms[0].measured["longest"].value.tolist() == longest
    assert ("pace" in compared.outcomes, "longest" in compared.outcomes) == (not whole, not whole)
    assert [arm.saturated for arm in compared.arms] == [saturated, 0]


def test_a_world_counts_as_saturated_only_before_both_horizons() -> None:
    lives = lived(4, 1)
    moments: Saturated = {0: (29, 59), 1: (30, 59), 2: (29, 60), 3: (40, 100)}
    for horizons, known in (
        ({}, {"births": [1, 1, 1, 1], "ticks": [1, 1, 1, 1]}),
        ({"births": 30}, {"births": [1, 0, 1, 0], "ticks": [1, 1, 1, 1]}),
        ({"ticks": 60}, {"births": [1, 1, 1, 1], "ticks": [1, 1, 0, 0]}),
        ({"births": 30, "ticks": 60}, {"births": [1, 0, 1, 0], "ticks": [1, 1, 0, 0]}),
    ):
        compared = compare([run("a", lives, moments), run("b", lives, moments)], **horizons)
        assert (compared.births, compared.ticks) == (horizons.get("births"), horizons.get("ticks"))
        for arm in compared.arms:
            for unit, place in (("births", 0), ("ticks", 1)):
                assert arm.measured[unit].known.tolist() == known[unit]
                limit = horizons.get(unit, 10**6)
                values = [min(each[place], limit) for each in moments.values()]
                assert arm.measured[unit].value.tolist() == values
            both = np.array(known["births"]) & known["ticks"]
            assert arm.saturated == both.sum()
    words = r"--births 41: in runs/c, world 2 stopped at 40 before it saturated.* at 41"
    with pytest.raises(InputError, match=words):
        compare([run("a", lives, moments), run("c", lives, {0: (29, 59), 1: (30, 59)})], births=41)


def test_births_and_ticks_to_saturation_count_from_the_fork() -> None:
    """A world was saturated before the fork in tick 50, one is saturated after it, and one is not."""
    lives, moments = lived(3, 1), {0: (12, 40), 1: (36, 70)}
    before = [int((lives.of_world(world).born <= 50).sum()) for world in range(3)]
    assert len(set(before)) > 1
    assert before[0] > 12
    assert before[1] < 36
    found = saturation(run("a", lives, moments), lives.recorded_since(50), 50, None, None)
    assert found["births"].value.tolist() == [0, 36 - before[1], 40 - before[2]]
    assert found["ticks"].value.tolist() == [0, 20, UNTIL - 50]
    assert [each.known.tolist() for each in found.values()] == [[True, True, False]] * 2
    found = saturation(run("a", lives, moments), lives.recorded_since(95), 95, None, None)
    assert found["births"].value.tolist() == [0, 0, 0], "nothing is born after tick 89"
    assert found["ticks"].value.tolist() == [0, 0, UNTIL - 95]


def test_runs_are_named_by_their_folders_or_whole_paths() -> None:
    lives = lived(1, 1)
    paths = (Path("x/a"), Path("y/a"), Path("y/b"))
    compared = compare([run("", lives, path=path) for path in paths])
    assert [arm.name for arm in compared.arms] == ["x/a", "y/a", "b"]
    turned = compare([run("", lives, path=path) for path in paths[::-1]])
    assert [arm.name for arm in turned.arms] == ["b", "y/a", "x/a"]
    assert compared.contrasts == 2


def test_plain_values_have_the_quartiles_of_each_outcome() -> None:
    """The second run has other seeds; the first is the reference."""
    one, two = lived(5, 1), lived(6, 2)
    moments: Saturated = {world: (30 + world, 60 + 2 * world) for world in range(4)}
    compared = compare([run("a", one, moments), run("b", two, moments, seed=50)])
    plain = compared.to_dict()
    assert {name: plain[name] for name in ("task", "age", "begin", "births", "ticks")} == {
        "task": "meadow", "age": AGE, "begin": 0, "births": None, "ticks": None,
    }  # fmt: skip
    first, second = plain["runs"]
    assert (first["worlds"], second["worlds"]) == (5, 6)
    assert (first["saturated"], second["saturated"]) == (4, 4)
    assert (first["settings"], second["settings"]) == (
        {"seeds": 5, "seed": 0},
        {"seeds": 6, "seed": 50},
    )
    assert first["births"] == {"q1": [31, 31], "median": [32, 32], "q3": [33, 33]}
    assert {k: second["ticks"][k] for k in ("q1", "median", "q3")} == {
        "q1": [62, 62], "median": [64, 64], "q3": [120, None],
    }  # fmt: skip
    for outcome in compared.arms[0].measured:
        assert "against" not in first[outcome]
        against = compared.contrast(compared.arms[1], outcome)
        assert second[outcome]["against"] == against.to_dict()
        assert against.worlds == 5


@pytest.mark.parametrize(("rate", "unit", "span"), [(50.0, "second", 50), (None, "tick", 1)])
def test_food_is_compared_in_the_unit_of_its_title(
    rate: float | None, unit: str, span: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Food is counted in all worlds of each run, from the first to the last common tick."""
    asked = []

    def gathering(run: Any, worlds: int, *rest: float) -> Gathering:
        asked.append((run.path.name, worlds, *rest))
        return Gathering(np.ones((worlds, 12)), Measured(np.ones(worlds), np.ones(worlds, bool)))

    monkeypatch.setattr(module, "gathering", gathering)
    one, two = lived(3, 1), lived(2, 2).recorded_until(70)
    compared = compare([run("a", one, rate=rate), run("b", two, rate=rate)])
    assert (compared.span, compared.outcomes["food"]) == (unit, f"food a {unit}, late")
    assert asked == [("a", 3, 0, 70, span), ("b", 2, 0, 70, span)]


def test_the_run_that_cannot_be_compared_is_named() -> None:
    lives = lived(1, 1)
    first, second, third = (run(name, lives) for name in "abc")
    words, other = "runs/a is a run of meadow, runs/d one of pond", run("d", lives, task="pond")
    for runs in ([first, second, other], [first, other, second]):
        with pytest.raises(InputError, match=words):
            compare(runs)
    with pytest.raises(InputError, match=r"runs/c is given twice"):
        compare([first, third, second, third])
    arm = run("e", lives)
    arm.paths = (Path("runs/e/1"), Path("runs/b"))
    with pytest.raises(InputError, match=r"runs/b is given twice"):
        compare([first, second, arm])
    named = [run("a", lives), run("b", lives), run("b", lives)]
    named[2].paths = (Path("elsewhere"),)
    with pytest.raises(InputError, match="two runs are named runs/b; name"):
        compare(named)


@pytest.mark.parametrize(("end", "common"), [(50, False), (51, True)])
def test_a_fork_and_a_run_that_ended_have_no_ticks_in_common(end: int, common: bool) -> None:
    fork = {"run": "runs/a", "tick": 50, "began": 0}
    whole = lived(2, 1)
    late = run("late", whole.recorded_since(50))
    dumped = {"fork": fork, "habitat": {}}
    late.config = SimpleNamespace(**{name: getattr(late.config, name) for name in ("task", "cells")},
        begins=50, saturation_ticks=AGE, model_dump=lambda **_: dict(dumped))  # fmt: skip
    early = run("early", whole.recorded_until(end))
    other = run("other", whole)
    if common:
        compared = compare([other, late, early])
        assert compared.begin == 50
        assert [arm.pace.edges[[0, -1]].tolist() for arm in compared.arms] == [[50, 51]] * 3
        return
    words = "runs/late was forked at tick 50, runs/early ends at 50: they have no ticks in common"
    with pytest.raises(InputError, match=words):
        compare([other, late, early])


def test_a_setting_that_only_some_runs_have_differs() -> None:
    """A run without metabolism has none of its settings. Texts and names of folders do not count."""
    forked = [{"run": name, "tick": tick} for name, tick in (("runs/a", 50), ("runs/b", 70))]
    changed: list[dict[str, Any]] = [
        {"metabolism": None, "fork": forked[0], "about": "one"},
        {"metabolism": {"store": 5.0, "gain": 0.0}, "fork": forked[1], "about": "two"},
    ]
    for order in ((0, 1), (1, 0)):
        found = differing([config(MEADOW, **changed[place]) for place in order])
        bare, fed = found[order.index(0)], found[order.index(1)]
        assert (bare["fork.tick"], fed["fork.tick"]) == (50, 70)
        assert (bare["metabolism.store"], fed["metabolism.store"]) == (None, 5)
        assert (bare["metabolism.gain"], fed["metabolism.gain"]) == (None, 0)
        assert bare.keys() == fed.keys()
        assert not {"about", "fork.run"} & bare.keys()


def isles(hazard: float = 0.5) -> dict[str, Any]:
    """Return settings of two islands; the second, `lagoon`, has the cells from 8 on."""
    islands = [{"name": "sea"}, {"name": "lagoon", "share": 4, "hazard": hazard}]
    return {"cells": 40, "habitat": {"islands": islands}}


def test_natives_of_an_island_are_compared_alone() -> None:
    """Organism k of a world is in cell k. Its life does not count beyond the common time."""
    one, two = lived(3, 1), lived(3, 2)
    runs = [run("a", one, {0: (4, 30)}, **isles()), run("b", two, seed=9, **isles(0.25))]
    compared = compare(runs, island="lagoon")
    natives = [lives.take(np.flatnonzero(lives.cell >= 8)) for lives in (one, two)]
    for arm, lives in zip(compared.arms, natives, strict=True):
        np.testing.assert_allclose(arm.measured["lifespan"].value, mean_until(lives, AGE))
        longest = [world.lifespan.max() for world in lives.by_world()]
        assert arm.measured["longest"].value.tolist() == longest
        assert arm.pace.deaths.sum() == lives.died.sum()
    assert list(compared.outcomes) == ["first", "lifespan", "longest", "pace"]
    told = compared.to_dict()
    assert told["island"] == "lagoon"
    assert not {"births", "ticks", "food", "saturated", "extinctions"} & told["runs"][0].keys()
    assert [each["settings"] for each in told["runs"]] == [
        {"seed": 0, "lagoon.hazard": 0.5}, {"seed": 9, "lagoon.hazard": 0.25}
    ]  # fmt: skip
    text = comparison_tables(compared)
    assert "Only organisms that were born on the island lagoon count" in text
    assert "saturated" not in text.splitlines()[0]
    assert "saturated" in comparison_tables(compare(runs)).splitlines()[0]
    assert "island" not in compare(runs).to_dict()


def test_an_island_without_natives_or_with_a_horizon_is_refused() -> None:
    lives = lived(2, 1)
    lives.cell[lives.world == 1] = 0
    runs = [run("a", lives, **isles()), run("b", lived(2, 2), seed=9, **isles())]
    with pytest.raises(
        InputError, match="nothing has lived there in world 1 of runs/a up to tick 120"
    ):
        compare(runs, island="lagoon")
    with pytest.raises(
        InputError, match="--island: --births and --ticks are horizons of saturation"
    ):
        compare(runs, ticks=50, island="lagoon")
    with pytest.raises(InputError, match="there is no island 'pond'; known: sea, lagoon"):
        compare(runs, island="pond")
