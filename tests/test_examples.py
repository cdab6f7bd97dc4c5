"""Parts as users write them, each one file: they keep their contracts, live, and are lived again."""

import importlib
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples.brain import Leaky
from examples.habitat import Pasture
from examples.mutation import CEILING, FACTORS, FLOOR, SelfAdaptive

import primordia
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.archive import Archive
from primordia.testing import check_brain, check_habitat, check_mutation
from tests.commands import here
from tests.history.test_rebuilding import assert_rebuilt

TASK = "CartPole-survival"
SEASON = '{kind = "schedule", setting = "mutation.scale", at = 150, value = 0.02}'
PARTS: dict[str, Any] = {
    "habitat.name": "examples.habitat:Pasture",
    "habitat.reach": 0.2,
    "brain.kind": "examples.brain:Leaky",
    "brain.neurons": 6,
    "mutation.kind": "examples.mutation:SelfAdaptive",
    "mutation.stride": 3,
    "mutation.founder_scale": 0.5,
    "metabolism.store": 100.0,
    "metabolism.gain": 50.0,
    "cells": 16,
    "seeds": 2,
    "replication": 0.1,
    "hazard": 0.01,
    "seasons": f"[{SEASON}]",
}
"""A world of these parts together."""


@pytest.mark.slow
@pytest.mark.parametrize("part", ["brain", "habitat", "mutation"])
def test_they_keep_their_contracts(part: str) -> None:
    checks = {
        "brain": lambda: check_brain(Leaky(neurons=5)),
        "habitat": lambda: check_habitat(Pasture()),
        "mutation": lambda: check_mutation(SelfAdaptive()),
    }
    checks[part]()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Archive:
    """Live in the world of all parts."""
    out = tmp_path_factory.mktemp("examples") / "run"
    flags = [word for name, value in PARTS.items() for word in (f"--{name}", value)]
    done = here("run", TASK, *flags, "--ticks", 1000, "--until", "none", "--quiet", "--out", out)
    assert (done.returncode, done.stderr) == (0, "")
    return Archive(out)


def test_a_life_of_an_own_brain_is_lived_again(run: Archive) -> None:
    """The longest life; it raises Trouble if it ends otherwise than recorded."""
    own = {"kind": "examples.brain:Leaky", "efference": False, "interoception": False, "neurons": 6}
    assert run.config.brain == own
    assert run.law.heredity.layout.names == ["input", "recurrent", "keep", "output"]
    row = run.lives.oldest()
    life = RelivedLife.of(run, int(run.lives.id[row]), int(run.lives.world[row]))
    ticks = sum(len(stretch.tick) for stretch in life.stretches())
    assert ticks == run.lives.lifespan[row] > 10


def test_an_own_habitat_feeds_and_is_drawn(run: Archive, tmp_path: Path) -> None:
    deaths = run.table("deaths")
    assert {"fatal", "starved"} <= set(deaths["cause"].to_pylist())
    assert max(deaths["food"].to_pylist()) >= 1
    seen = here("replay", run.path, "--to", 5, "--out", tmp_path / "life.gif")
    assert (seen.returncode, seen.stderr) == (0, "")
    assert (tmp_path / "life.gif").stat().st_size > 1000


def test_what_an_own_mutation_lets_inherit_is_on_record(run: Archive) -> None:
    """Copies have their parent's exponent; mutants are up to a stride away; founders have none."""
    births = run.table("births").to_pylist()
    exponent = {(each["world"], each["id"]): each["octaves8"] for each in births}
    assert {cause for each in births if (cause := each["cause"])} == {"founder", "copy", "mutant"}
    for each in births:
        own = each["octaves8"]
        if each["cause"] == "founder":
            assert own == 0
            continue
        step = abs(own - exponent[each["world"], each["parent"]])
        assert step <= (3 if each["cause"] == "mutant" else 0)
    assert min(exponent.values()) < -5
    assert max(exponent.values()) > 5


@pytest.mark.slow
def test_genomes_come_back_from_records(run: Archive) -> None:
    assert_rebuilt(run.path)


def test_genomes_come_back_across_a_fork_and_it_is_verified(run: Archive, tmp_path: Path) -> None:
    original = primordia.load(run.path)
    assert original.verify() == []
    fork = original.fork(200, tmp_path / "fork", seed=9, stop={"ticks": 500})
    assert fork.verify() == []
    assert_rebuilt(fork.path)
    assert Archive(fork.path).origin is not None
    before, after = (
        {(b["world"], b["id"]): b["octaves8"] for b in each.table("births").to_pylist()
         if b["tick"] <= 200}
        for each in (original, fork)
    )  # fmt: skip
    assert after.items() <= before.items()
    assert set(after.values()) != {0}


def test_the_table_of_factors_is_of_eighths_of_octaves() -> None:
    assert len(FACTORS) == CEILING - FLOOR + 1
    np.testing.assert_allclose(FACTORS, 2.0 ** (np.arange(FLOOR, CEILING + 1) / 8), rtol=1e-7)
    for one, other in pairwise(FACTORS[::8]):
        assert other == 2 * one


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        (
            ["--brain.kind", "examples.brain:Leaky"],
            "--brain.neurons neurons in the hidden layer [16]",
        ),
        (["--mutation.kind", "examples.mutation:SelfAdaptive"], "--mutation.stride most eighths"),
        (
            ["--habitat.name", "examples.habitat:Pasture"],
            "--habitat.reach distance at which a tuft",
        ),
    ],
)
def test_help_shows_the_settings_of_a_part_that_is_named(words: list[str], shown: str) -> None:
    done = here("run", TASK, *words, "--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert shown in " ".join(done.stdout.split())


@pytest.mark.slow
def test_a_network_is_trained_in_a_world_of_ours() -> None:
    """After two improvements it still acts, and it has changed."""
    pytest.importorskip("optax")
    ppo = importlib.import_module("examples.ppo")
    before, after = ppo.network(4, 2), ppo.train(0.001)
    assert not np.array_equal(before["policy"][0][0], after["policy"][0][0])
    lived = ppo.lifespans(lambda senses: int(ppo.through(after["policy"], senses).argmax()))
    assert len(lived) == ppo.LIVES
    assert 5 < np.median(lived) <= ppo.LONGEST
