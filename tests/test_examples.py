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
from primordia.habitats.on_host import OnHost
from primordia.organism.policy import Policy
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.archive import Archive
from primordia.testing import check_brain, check_habitat, check_mutation
from tests.commands import here
from tests.history.test_rebuilding import assert_rebuilt
from tests.worlds import law_of

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
GENOME = np.random.default_rng(3).normal(size=3 * (4 + 3 + 1 + 2)).astype(np.float32)


@pytest.mark.slow
@pytest.mark.parametrize("part", ["brain", "habitat", "mutation"])
def test_they_keep_their_contracts(part: str) -> None:
    checks = {
        "brain": lambda: check_brain(Leaky(neurons=5)),
        "habitat": lambda: check_habitat(Pasture()),
        "mutation": lambda: check_mutation(SelfAdaptive()),
    }
    checks[part]()


def test_an_own_brain_keeps_a_share_of_its_memory() -> None:
    policy = Policy(law_of(brain={"kind": "examples.brain:Leaky", "neurons": 3}), GENOME)
    (w, u, keep, v), memory = policy.weights.values(), np.zeros(3, np.float32)
    for senses in np.random.default_rng(1).normal(size=(3, 4)).astype(np.float32):
        share = 1 / (1 + np.exp(-keep))
        memory = share * memory + (1 - share) * np.tanh(w @ senses + memory @ u)
        assert policy(senses) == np.argmax(v @ memory)
        np.testing.assert_allclose(policy.memory, memory, rtol=1e-4, atol=1e-5)


def test_an_own_habitat_feeds_who_seeks_tufts_and_kills_who_leaves() -> None:
    """The first body goes to its tufts, the second goes right."""
    pasture = OnHost(Pasture(reach=0.2))
    pasture.open(2)
    senses, eaten = pasture.reset(np.arange(2), np.array([[7, 8]] * 2, np.uint32)), 0.0
    for tick in range(1, 99):
        way, near = 32 * senses[0, :2], np.abs(senses[0, :2]).max()
        senses, outcome = pasture.step(np.float32([way, [1, 0]]), np.ones(2, bool))
        assert outcome.fatal.tolist() == [False, tick > 32]
        if outcome.food[0]:
            assert near < 0.2 + 1 / 32 <= 2 * np.abs(senses[0, :2]).max()
        eaten += outcome.food[0]
    assert eaten >= 3


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Archive:
    """Live in the world of all parts."""
    out = tmp_path_factory.mktemp("examples") / "run"
    flags = [word for name, value in PARTS.items() for word in (f"--{name}", value)]
    done = here("run", TASK, *flags, "--ticks", 1000, "--until", "none", "--quiet", "--out", out)
    assert (done.returncode, done.stderr) == (0, "")
    return Archive(out)


@pytest.mark.slow
def test_a_life_of_an_own_brain_is_lived_again(run: Archive) -> None:
    """The longest life; it raises Trouble if it ends otherwise than recorded."""
    own = {"kind": "examples.brain:Leaky", "efference": False, "interoception": False, "neurons": 6}
    assert run.config.brain == own
    assert run.law.heredity.layout.names == ["input", "recurrent", "keep", "output"]
    row = run.lives.oldest()
    life = RelivedLife.of(run, int(run.lives.id[row]), int(run.lives.world[row]))
    ticks = sum(len(stretch.tick) for stretch in life.stretches())
    assert ticks == run.lives.lifespan[row] > 10


@pytest.mark.slow
def test_an_own_habitat_feeds_and_is_drawn(run: Archive, tmp_path: Path) -> None:
    deaths = run.table("deaths")
    assert {"fatal", "starved"} <= set(deaths["cause"].to_pylist())
    assert max(deaths["food"].to_pylist()) >= 1
    seen = here("replay", run.path, "--to", 5, "--out", tmp_path / "life.gif")
    assert (seen.returncode, seen.stderr) == (0, "")
    assert (tmp_path / "life.gif").stat().st_size > 1000


@pytest.mark.slow
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
def test_genomes_come_back_from_records_and_across_a_fork(run: Archive, tmp_path: Path) -> None:
    original = primordia.load(run.path)
    assert original.verify() == []
    assert_rebuilt(run.path)
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
        (["--brain.kind", "examples.brain:Leaky"], "--brain.neurons neurons in the hidden layer [16]"),
        (["--habitat.name", "examples.habitat:Pasture"], "--habitat.reach distance at which a tuft"),
    ],
)  # fmt: skip
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
