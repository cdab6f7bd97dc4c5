"""Every operator of heredity keeps the promises: any chunk, other worlds, stops, forks, the host."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.history.lineage import descent
from primordia.history.pedigree import genomes
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.history.test_lineage import assert_rebuilt
from tests.worlds import MILL, Lived, config

TICKS = 300
BASE: dict[str, Any] = {
    **MILL,
    "brain": {"hidden": 3},
    "seed": 5,
    "seeds": 2,
    "replication": 0.5,
    "hazard": 0.1,
    "seasons": [],
}
SOME: dict[str, Any] = {
    "kind": "calibrated",
    "probability": 0.7,
    "founder_scale": 0.5,
    "remembered": 5,
    "every": 3,
}
FIRST = "calibrated, recombined by rows, replacing"
RECOMBINED = "heritable by cell, recombined by blocks"
OPERATORS: dict[str, dict[str, Any]] = {
    FIRST: {
        "mutation": SOME,
        "recombination": {"probability": 0.6},
        "placement": {"rule": "replacing", "topology": "torus8"},
    },
    RECOMBINED: {
        "mutation": {"kind": "heritable", "scale": 0.2, "founder_scale": 0.5, "belongs": "cell"},
        "recombination": {"unit": "block", "probability": 0.9},
        "placement": {"topology": "well-mixed"},
    },
}


@pytest.fixture(scope="module", params=[FIRST, pytest.param(RECOMBINED, marks=pytest.mark.slow)])
def settings(request: pytest.FixtureRequest) -> dict[str, Any]:
    return {**BASE, **OPERATORS[request.param]}


@pytest.fixture(scope="module")
def whole(settings: dict[str, Any]) -> Lived:
    return Lived(config(settings), TICKS)


@pytest.fixture(scope="module")
def run(settings: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Live the run in parts, on disk. A moment is due at the first stop, and a sample at the second."""
    path = tmp_path_factory.mktemp("operators") / "run"
    assert (99 % SOME["every"], 100 % BASE["sample_every"]) == (0, 0)
    loop.start(config(settings, stop={"ticks": 99}), path)
    for ticks in (100, TICKS):
        loop.resume(path, {"ticks": ticks})
    return path


def digests(run: Path) -> list[str]:
    return [world["digest"] for world in primordia.load(run).info()["worlds"]]


def test_the_operator_acts(whole: Lived) -> None:
    births = whole.table("births")
    mutant = births["cause"] == "mutant"
    assert 0.3 < mutant.mean() < 0.9
    assert len(set(births["quarters"][mutant].tolist())) > 5
    if "mate" in births:
        mate = births["mate"]
        assert 0.1 < np.isfinite(mate).mean() < 0.95
        assert (mate != births["parent"])[np.isfinite(mate)].all()


def test_no_chunk_changes_anything(whole: Lived, settings: dict[str, Any]) -> None:
    assert Lived(config(settings), TICKS, 7).digests() == whole.digests()


@pytest.mark.slow
def test_no_other_world_changes_anything(whole: Lived, settings: dict[str, Any]) -> None:
    alone = Lived(config(settings, seed=6, seeds=1), TICKS)
    assert alone.digests() == whole.digests()[1:]


def test_what_is_remembered_in_a_quiet_time_does_not_depend_on_chunks() -> None:
    """Organisms remember moments also if nothing is born and nothing dies for many ticks."""
    rare = {"hazard": 0.004, "replication": 0.02}
    quiet = {**OPERATORS[FIRST], **rare, "metabolism": {"store": 1e5, "cap": 1e6}}
    whole = Lived(config(BASE, **quiet), TICKS)
    births = whole.table("births")
    assert np.max(np.diff(births["tick"][births["world"] == 0])) > SOME["every"]
    assert (births["quarters"] != 0).any()
    assert Lived(config(BASE, **quiet), TICKS, 7).digests() == whole.digests()


def test_a_run_that_was_stopped_goes_on_and_is_rebuilt(whole: Lived, run: Path) -> None:
    assert digests(run) == whole.digests()
    assert primordia.load(run).verify() == []
    assert_rebuilt(run)


def test_a_fork_keeps_what_lived(run: Path, tmp_path: Path) -> None:
    same = primordia.load(run).fork(200, tmp_path / "same", stop={"ticks": TICKS})
    other = same.fork(250, tmp_path / "other", seed=9, stop={"ticks": TICKS})
    assert other.verify() == []
    assert_rebuilt(same.path)
    assert_rebuilt(other.path)
    ages = [Archive(each).state["world.organisms.born.lo"] for each in (run, same.path)]
    np.testing.assert_array_equal(*ages)


def test_a_shadow_has_the_recorded_notes_and_other_weights(run: Path) -> None:
    """Notes that depend on lives or cells cannot be drawn again."""
    opened = Archive(run)
    rows = np.arange(len(opened.lives))[-40:]
    recorded, redrawn = genomes(opened, rows), genomes(opened, rows, redrawn=True)
    assert (recorded != redrawn).any(axis=1).all()
    assert np.isfinite(redrawn).all()
    assert redrawn.tobytes() == genomes(opened, rows, redrawn=True).tobytes()


def test_the_host_lives_the_same(settings: dict[str, Any], whole: Lived) -> None:
    habitat = {"name": "tests.toys:Mirror", "inner": "mill"}
    # Lives stop at tick 30, in which a moment is due, and go on.
    on_host = Lived(config(settings, habitat=habitat), 30)
    on_host.advance_to(60)
    here = Lived(config(settings), 60)
    for name in ("births", "deaths"):
        one, other = (np.concatenate(each.rows[name]) for each in (on_host, here))
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(on_host.genomes(), here.genomes())


@pytest.mark.slow
def test_another_kind_of_mutation_begins_with_a_fork(tmp_path: Path) -> None:
    """Notes and moments of the kind before have no meaning for it."""
    source = tmp_path / "source"
    loop.start(config(BASE, stop={"ticks": 50}), source)
    first = primordia.load(source).fork(50, tmp_path / "one", mutation=SOME, stop={"ticks": 90})
    heritable = {"kind": "heritable", "scale": 0.1}
    second = first.fork(90, tmp_path / "two", mutation=heritable, stop={"ticks": 120})
    for each in (first, second):
        assert each.verify() == []
        assert_rebuilt(each.path)
    births = second.table("births").to_pandas()
    assert (births.quarters[births.tick < 90] == 0).all()
    assert (births.quarters[births.tick > 90] != 0).any()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["calibrated", pytest.param(RECOMBINED, marks=pytest.mark.slow)])
def test_genomes_are_rebuilt_through_a_thousand_generations(name: str, tmp_path: Path) -> None:
    operator = {"mutation": SOME} if name == "calibrated" else OPERATORS[name]
    hasty: dict[str, Any] = {
        "hazard": 0.2,
        "replication": 1.0,
        "metabolism": None,
        "cells": 25,
        "seeds": 1,
    }
    hasty["placement"] = {"topology": "torus8", "rule": "empty-only"}
    run = tmp_path / "run"
    loop.start(config({**BASE, **operator, **hasty}, stop={"ticks": 6_000}), run)
    opened = Archive(run)
    last = int(opened.lives.id[-1])
    assert len(descent(opened.lives, last, 0)) > 1_000
    assert_rebuilt(run)
