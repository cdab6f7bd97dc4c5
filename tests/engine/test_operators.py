"""Operators of heredity over many generations, and where one kind follows another."""

from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia.history.rebuilding import descent
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.history.test_rebuilding import assert_rebuilt
from tests.strange import STRANGE, STRANGER
from tests.worlds import config

BASE: dict[str, Any] = {**STRANGE, "seed": 5, "recombination": None, "seasons": []}
GAUSSIAN: dict[str, Any] = {"scale": 0.2, "founder_scale": 0.5}

pytestmark = pytest.mark.slow


def test_another_kind_of_mutation_begins_with_a_fork(tmp_path: Path) -> None:
    """Notes and moments of the kind before have no meaning for it."""
    source = tmp_path / "source"
    loop.start(config({**BASE, "mutation": GAUSSIAN}, stop={"ticks": 50}), source)
    calibrated = STRANGE["mutation"]
    first = primordia.load(source).fork(
        50, tmp_path / "one", mutation=calibrated, stop={"ticks": 90}
    )
    heritable = {"kind": "heritable", "scale": 0.1}
    second = first.fork(90, tmp_path / "two", mutation=heritable, stop={"ticks": 120})
    for each in (first, second):
        assert each.verify() == []
        assert_rebuilt(each.path)
    births = second.table("births").to_pandas()
    assert (births.quarters[births.tick < 90] == 0).all()
    assert (births.quarters[births.tick > 90] != 0).any()


@pytest.mark.parametrize(
    "operator",
    [{"mutation": STRANGE["mutation"]}, {**STRANGER, "seasons": []}],
    ids=["calibrated", "heritable and recombined"],
)
def test_genomes_are_rebuilt_through_a_thousand_generations(
    operator: dict[str, Any], tmp_path: Path
) -> None:
    hasty: dict[str, Any] = {
        "hazard": 0.2,
        "replication": 1.0,
        "metabolism": None,
        "cells": 25,
        "seeds": 1,
        "placement": {"topology": "torus8", "rule": "empty-only"},
    }
    run = tmp_path / "run"
    loop.start(config({**BASE, **operator, **hasty}, stop={"ticks": 6_000}), run)
    opened = Archive(run)
    last = int(opened.lives.id[-1])
    assert len(descent(opened.lives, last, 0)) > 1_000
    assert_rebuilt(run)
