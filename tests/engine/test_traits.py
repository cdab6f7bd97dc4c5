"""Worlds whose bodies are inherited keep the promises."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.habitats.archipelago import joined
from primordia.organism.playing.games import lifespans
from primordia.organism.playing.players import players_of
from primordia.organism.reliving.compare import relive
from primordia.runs.archive import Archive
from tests.engine.test_strange import digests, live_in_parts
from tests.history.test_rebuilding import assert_rebuilt
from tests.strange import TICKS
from tests.worlds import Lived, config

GUSTS = {"kind": "parameter", "of": "force", "range": [0.3, 3.0], "every": [5, 20]}
POLES: dict[str, Any] = {
    "task": "poles",
    "habitat": {
        "name": "cartpole",
        "change": [GUSTS],
        "traits": {
            "pole": {"of": ["pole-length", "pole-mass"], "least": 0.1, "most": 4.0, "founder": 0.5},
            "gravity": {"least": 0.5, "most": 2.0},
        },
        "islands": [
            {"name": "moon", "habitat": {"factors": {"gravity": 0.3}}},
            {"name": "earth", "share": 2.0, "hazard": 0.02},
        ],
    },
    "brain": {"hidden": 2},
    "cells": 24,
    "seeds": 2,
    "replication": 0.4,
    "placement": {"topology": "ring"},
    "recombination": {"probability": 0.5},
    "mutation": {"scale": 0.2, "founder_scale": 0.5, "blocks": {"body": {"scale": 1.0}}},
    "sample_every": 100,
}
"""Two worlds of two islands. Poles and gravity are inherited; the force changes within each life."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("traits") / "run"
    live_in_parts(POLES, path)
    return path


@pytest.fixture(scope="module")
def lived() -> Lived:
    return Lived(config(POLES), TICKS, chunk=11)


def test_parts_and_chunks_of_any_length_make_the_same_run(run: Path, lived: Lived) -> None:
    assert digests(run) == lived.digests()
    assert primordia.load(run).verify() == []
    assert_rebuilt(run)


def test_a_habitat_on_the_host_lives_the_same_lives(lived: Lived) -> None:
    held = {**POLES["habitat"], "name": "tests.habitats.test_parameters:HeldPoles"}
    hosted = Lived(config({**POLES, "habitat": held}), TICKS)
    for name in ("births", "deaths", "metrics"):
        mine, other = lived.table(name), hosted.table(name)
        for column, values in mine.items():
            np.testing.assert_array_equal(values, other[column], column)


def test_the_living_and_the_dead_live_again_in_their_bodies(run: Path, tmp_path: Path) -> None:
    opened = Archive(run)
    fork = Archive(primordia.load(run).fork(200, tmp_path / "fork", stop={"ticks": TICKS}).path)
    for died in (True, False):
        rows = np.flatnonzero(opened.lives.died == died)
        assert len(rows) > 5
        for row in rows[-6:]:
            life = relive(opened, int(opened.lives.id[row]), int(opened.lives.world[row]))
            assert life.agrees, life.respects
    row = np.flatnonzero(fork.lives.inherited & (fork.lives.ended > 200))[-1]
    assert relive(fork, int(fork.lives.id[row]), int(fork.lives.world[row])).agrees


def test_bodies_are_what_the_genes_of_the_living_say(lived: Lived) -> None:
    traits, (world, parts) = config(POLES).traits, lived.engine.state
    assert traits is not None
    alive = np.asarray(world.organisms.alive)
    factors = traits.factors(np.asarray(world.organisms.genome["body"]))
    bodies = joined([island.inner.traits for island in parts.island], parts.sizes)
    np.testing.assert_array_equal(np.asarray(bodies)[alive], factors[alive])
    assert len(np.unique(factors, axis=0)) > 10


def test_games_are_played_in_the_bodies_of_the_players(run: Path) -> None:
    """Of equal brains, those with other bodies live other lives."""
    opened = Archive(run)
    players = players_of(opened, [(int(opened.lives.of_world(0).id[-1]), 0)] * 4)
    genomes = np.repeat(players.genomes[:1], 4, axis=0)
    genomes[:, -2:] = [[-2, -1], [0, 0], [2, 0], [2, 1]]
    lives = lifespans(players._replace(genomes=genomes), 300)
    assert len(set(lives.tolist())) > 1
