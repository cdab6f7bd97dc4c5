"""A run in numbers, counted again from its records."""

from collections import Counter
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.history import info as module
from primordia.history.info import _world, info
from primordia.history.threshold import Threshold
from primordia.law.world import Cause
from primordia.runs import loop
from primordia.runs.arrays import NEVER
from primordia.settings.islands import Islands
from tests.worlds import HERD, config

SETTINGS: dict[str, Any] = {
    **HERD,
    "seed": 4,
    "replication": 0.04,
    "hazard": 0.02,
    "metabolism": {"store": 50.0, "drain": 1.0, "gain": 0.25},
    "stop": {"ticks": 300, "births": 76},
}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Make a run in which some worlds die out."""
    folder = tmp_path_factory.mktemp("info") / "run"
    loop.start(config(SETTINGS), folder)
    made = primordia.load(folder)
    assert any(world["extinctions"] for world in made.info()["worlds"])
    return made


@pytest.mark.parametrize("number", range(3))
def test_the_numbers_of_a_world_are_those_of_its_records(run: primordia.Run, number: int) -> None:
    world, cells = run.info()["worlds"][number], SETTINGS["cells"]
    born, died = (run.table(name).to_pylist() for name in ("births", "deaths"))
    born, died = ([row for row in rows if row["world"] == number] for rows in (born, died))
    ends = {row["id"]: row["tick"] for row in died}
    last = world["ticks"]
    ages = [last - row["tick"] for row in born if row["id"] not in ends]
    lived = sum(ends.get(row["id"], last) - row["tick"] for row in born)
    beginnings = {row["tick"] for row in born if row["parent"] is None}
    assert np.mean(ages) != pytest.approx(np.median(ages), rel=0.01)
    assert {
        "seed": 4 + number,
        "births": len(born),
        "deaths": len(died),
        "alive": len(ages),
        "extinctions": len(beginnings) - 1,
        "cell_ticks": last * cells,
        "organism_ticks": lived,
        "mean_age": pytest.approx(np.mean(ages)),
        "oldest_age": max(ages),
        "tries_per_life": pytest.approx(0.04 * lived / len(born)),
        "break_even": {"food_per_tick": 4.0, "food_per_second": None},
    }.items() <= world.items()
    causes = Counter(row["cause"] for row in died)
    assert {cause: count for cause, count in world["deaths_by_cause"].items() if count} == causes
    assert len(born) >= 76
    assert last < 300
    assert max(row["tick"] for row in born) == last


def stored() -> Any:
    """Return a stand-in for a run of two worlds of three cells, with all numbers different."""
    counts = {
        "tick": [900, 700], "births": [60, 90], "organism_ticks": [1200, 1350],
        "extinctions": [4, 6], "saturated": [800, NEVER], "saturated_births": [51, 0],
        "fixed": [NEVER, 650], "fixed_births": [0, 82],
        "deaths": [[k + 1 for k, _ in enumerate(Cause)], [10 * k + 1 for k, _ in enumerate(Cause)]],
    }  # fmt: skip
    climate = {
        "replication": [0.5, 0.25], "metabolism.drain": [1.0, 3.0], "metabolism.gain": [2.0, 4.0],
    }  # fmt: skip
    every = {f"world.worlds.{name}": np.array(values, np.uint64) for name, values in counts.items()}
    every["world.organisms.born"] = np.array([890, 100, 600, 690, 0, 697], np.uint64)
    return SimpleNamespace(
        config=SimpleNamespace(
            cells=3,
            metabolism=True,
            act=None,
            traits=None,
            seasons=["any"],
            islands=Islands(("",), (0, 3)),
        ),
        description=SimpleNamespace(tallies=("score", "kills"), rate=50.0),
        world_seeds=np.array([7, 2**63], np.uint64),
        count=every.__getitem__,
        state={
            "world.organisms.alive": np.array([1, 1, 1, 1, 0, 1], bool),
            "bodies.tally": np.array([[1, 9], [2, 0], [9, 6], [5, 4], [99, 99], [8, 1]], np.int32),
            **{f"world.worlds.climate.{k}": np.array(v, np.float32) for k, v in climate.items()},
        },
    )


def test_each_number_is_that_of_its_own_world() -> None:
    first, second = (_world(stored(), world, 10 + world, {"held": world}) for world in (0, 1))
    labels = [cause.label for cause in Cause]
    assert first == {
        "seed": 7, "ticks": 900, "alive": 3, "births": 60,
        "deaths": sum(range(1, len(labels) + 1)),
        "deaths_by_cause": {label: k + 1 for k, label in enumerate(labels)},
        "extinctions": 4, "crashes": 10, "cell_ticks": 2700, "organism_ticks": 1200,
        "mean_age": pytest.approx((10 + 800 + 300) / 3), "oldest_age": 800,
        "tries_per_life": 0.5 * 1200 / 60, "saturation": {"tick": 800, "births": 51},
        "fixation": None, "threshold": {"held": 0},
        "tallies": {"score": {"median": 2, "best": 9}, "kills": {"median": 6, "best": 9}},
        "break_even": {"food_per_tick": 0.5, "food_per_second": 25.0},
        "climate": {"replication": 0.5, "metabolism.drain": 1.0, "metabolism.gain": 2.0},
    }  # fmt: skip
    assert second == {
        "seed": 2**63, "ticks": 700, "alive": 2, "births": 90,
        "deaths": sum(10 * k + 1 for k in range(len(labels))),
        "deaths_by_cause": {label: 10 * k + 1 for k, label in enumerate(labels)},
        "extinctions": 6, "crashes": 11, "cell_ticks": 2100, "organism_ticks": 1350,
        "mean_age": pytest.approx((10 + 3) / 2), "oldest_age": 10,
        "tries_per_life": 0.25 * 1350 / 90, "saturation": None,
        "fixation": {"tick": 650, "births": 82}, "threshold": {"held": 1},
        "tallies": {"score": {"median": 6.5, "best": 8}, "kills": {"median": 2.5, "best": 4}},
        "break_even": {"food_per_tick": 0.75, "food_per_second": 37.5},
        "climate": {"replication": 0.25, "metabolism.drain": 3.0, "metabolism.gain": 4.0},
    }  # fmt: skip


def test_numbers_of_an_empty_world_are_unknown() -> None:
    run = stored()
    run.state["world.organisms.alive"][:3] = False
    run.count("world.worlds.births")[0] = 0
    run.config.metabolism, run.config.seasons = None, []
    found = _world(run, 0, 0, {})
    unknown = ("mean_age", "oldest_age", "tries_per_life")
    assert [found[name] for name in unknown] == [None] * 3
    assert found["alive"] == 0
    assert not {"tallies", "break_even", "climate"} & found.keys()


def test_numbers_of_zero_are_known() -> None:
    """Counts may be below zero; without drain no food is needed."""
    run = stored()
    run.state["bodies.tally"][:3] = 0
    run.state["bodies.tally"][3:] = [[-5, -4], [99, 99], [-8, -1]]
    run.state["world.worlds.climate.metabolism.drain"][1] = 0
    first, second = (_world(run, world, 0, {}) for world in (0, 1))
    none, below = {"median": 0, "best": 0}, {"median": -6.5, "best": -5}
    assert first["tallies"] == {"score": none, "kills": none}
    assert second["tallies"] == {"score": below, "kills": {"median": -2.5, "best": -1}}
    assert second["break_even"] == {"food_per_tick": 0, "food_per_second": 0}
    run.state["world.worlds.climate.metabolism.gain"][1] = 0
    run.description.rate = None
    assert _world(run, 0, 0, {})["break_even"] == {"food_per_tick": 0.5, "food_per_second": None}
    unknown = {"food_per_tick": None, "food_per_second": None}
    assert _world(run, 1, 0, {})["break_even"] == unknown
    run.config.metabolism = None
    assert _world(run, 0, 0, {})["climate"] == first["climate"]


@pytest.mark.parametrize("seeds", [(2, 2), (1, 2), (1,)])
def test_the_numbers_of_runs_are_those_of_all_their_worlds(
    seeds: tuple[int, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing has been born in the last world of the last run. Its error threshold is unknown."""
    parts = []
    for number, worlds in enumerate(seeds):
        part, last = stored(), number == len(seeds) - 1
        part.config.seeds, part.lives = worlds, SimpleNamespace(worlds=worlds - last)
        part.row_digests, part.crashed = f"run {number}", 10 * number + np.arange(worlds)
        parts.append(part)

    def threshold(part: Any) -> list[Threshold]:
        return [Threshold(world, 0.5, 0.0, 4.0 + world) for world in range(part.lives.worlds)]

    def digests(rows: str, state: Any, count: int, islands: Any) -> list[str]:
        (own,) = (part for part in parts if part.row_digests == rows)
        assert state is own.state
        return [f"{rows}, world {world}" for world in range(count)]

    monkeypatch.setattr(
        module, "extinctions_of", lambda part: SimpleNamespace(crashes=part.crashed)
    )
    monkeypatch.setattr(module, "threshold", threshold)
    monkeypatch.setattr(module, "digests", digests)
    total = sum(seeds)
    progress = {"wall_s": 12.5, "exact": False, "restarts": total - 1}
    of_all = {"inheritance": "founder", "cells": 3, "seeds": total, "task": "pond"}
    run: Any = SimpleNamespace(
        config=SimpleNamespace(**of_all),
        progress=SimpleNamespace(
            **progress, limits=SimpleNamespace(model_dump=lambda: {"ticks": 9})
        ),
        damaged=["one", "other"],
        versions={"jax": "1"},
        parts=lambda: iter(parts),
    )
    found = info(run)
    rest = {"damaged": ["one", "other"], "versions": {"jax": "1"}, "limits": {"ticks": 9}}
    assert {**of_all, **progress, **rest}.items() <= found.items()
    places = [(number, world) for number, count in enumerate(seeds) for world in range(count)]
    assert [each["digest"] for each in found["worlds"]] == [
        f"run {number}, world {world}" for number, world in places
    ]
    assert [each["crashes"] for each in found["worlds"]] == [10 * n + world for n, world in places]
    assert [each["births"] for each in found["worlds"]] == [(60, 90)[world] for _, world in places]
    held = [2.0 + world / 2 for _, world in places[:-1]]
    assert [each["threshold"]["held"] for each in found["worlds"]] == [*held, None]
    assert all("world" not in each["threshold"] for each in found["worlds"])
    single = {"seed": 7, "births": 60, "digest": "run 0, world 0"} if total == 1 else {}
    assert {name: found[name] for name in ("seed", "births", "digest") if name in found} == single
