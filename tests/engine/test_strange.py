"""A strange world keeps the first promise under any chunk, interruption and environment."""

import hashlib
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.organism.evaluation import evaluate
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests import commands
from tests.history.test_lineage import assert_rebuilt
from tests.worlds import MILL, Lived, config

TICKS = 200
SEEDS = [2**64 - 2, 2**64 - 1]
STRANGE: dict[str, Any] = {
    **MILL,
    "cells": 37,
    "seed": SEEDS[0],
    "seeds": 2,
    "brain": {"hidden": 3},
    "placement": {"rule": "replacing", "topology": "ring"},
    "mutation": {
        **MILL["mutation"],
        "blocks": {
            "input": {"scale": 0.3, "founder_scale": 0.7},
            "output": {"probability": 0.9, "scale": 0.05},
        },
    },
    "seasons": [
        {"kind": "ratchet", "setting": "mutation.blocks.output.scale", "when": "mean_age",
         "above": 5.0, "factor": 1.1, "every": 13},
        {"kind": "ratchet", "setting": "metabolism.gain", "when": "food", "above": 0.01,
         "factor": 0.99, "every": 17},
    ],
}  # fmt: skip
"""A prime number of cells, the last two seeds, copies that replace neighbours, settings of a block."""


@pytest.fixture(scope="module")
def whole() -> Lived:
    return Lived(config(STRANGE), TICKS)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("strange") / "run"
    loop.start(config(STRANGE, stop={"ticks": TICKS}), path)
    return path


def digests(run: Path) -> list[str]:
    return [world["digest"] for world in primordia.load(run).info()["worlds"]]


def test_the_world_is_strange_enough(whole: Lived) -> None:
    """Both worlds turn their ratchets, replace the living, and differ."""
    deaths, metrics = whole.table("deaths"), whole.table("metrics")
    assert whole.config.world_seeds.tolist() == SEEDS
    for world in range(2):
        causes = set(deaths["cause"][deaths["world"] == world])
        assert {"replaced", "starved"} <= causes
        here = metrics["world"] == world
        for name in ("mutation.blocks.output.scale", "metabolism.gain"):
            assert len(set(metrics[name][here].tolist())) > 2
    assert len(set(whole.digests())) == 2


@pytest.mark.parametrize("chunk", [1, 11])
def test_chunks_of_any_length_make_the_same_run(whole: Lived, chunk: int) -> None:
    assert Lived(config(STRANGE), TICKS, chunk).digests() == whole.digests()


def test_each_world_is_the_same_alone(whole: Lived) -> None:
    for world, seed in enumerate(SEEDS):
        alone = Lived(config(STRANGE, seed=seed, seeds=1), TICKS)
        assert alone.digests() == [whole.digests()[world]]


def test_a_run_that_was_stopped_goes_on_as_if_it_had_not_been(
    whole: Lived, run: Path, tmp_path: Path
) -> None:
    parts = tmp_path / "parts"

    def press(_: loop.Status) -> None:
        signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        loop.start(config(STRANGE, stop={"ticks": TICKS}), parts, listen=press)
    loop.resume(parts, {"ticks": 101})
    loop.resume(parts, {"ticks": TICKS})
    assert digests(parts) == digests(run) == whole.digests()
    assert primordia.load(parts).verify() == []


def test_genomes_lives_and_games_follow_from_such_seeds(run: Path) -> None:
    assert_rebuilt(run)
    opened = Archive(run)
    lives = opened.lives
    for world in range(2):
        here = np.flatnonzero((lives.world == world) & (lives.lifespan > 3))
        for row in (here[0], here[len(here) // 2], here[-1]):
            life = RelivedLife.of(opened, int(lives.id[row]), world)
            assert [*life.stretches()][-1].tick[-1] == life.ends
    one, other = evaluate(opened, [(0, 0), (0, 1)], games=3, ticks=60)
    assert one.lived.course.tolist() != other.lived.course.tolist()
    (again,) = evaluate(opened, [(0, 1)], games=3, ticks=60)
    assert again.to_dict() == other.to_dict()


PROGRAM = f"""
from {__name__} import described
print(described())
"""


def described() -> str:
    """Return the digests of the worlds, a hash of their samples, and the settings, as one line."""
    lived = Lived(config(STRANGE), TICKS)
    metrics = lived.table("metrics")
    sums = hashlib.sha256(b"".join(np.ascontiguousarray(metrics[name]).tobytes()
                                   for name in sorted(metrics))).hexdigest()  # fmt: skip
    return json.dumps([lived.digests(), sums, lived.config.to_toml()])


ENVIRONMENT = {
    "XLA_FLAGS": f"{os.environ['XLA_FLAGS']} --xla_cpu_multi_thread_eigen=false", "OMP_NUM_THREADS": "1",
    "LANG": "C", "LC_ALL": "C", "TZ": "Asia/Kathmandu", "PYTHONHASHSEED": "7", "PYTHONUTF8": "0",
    "COLUMNS": "20", "PYTHONOPTIMIZE": "2",
}  # fmt: skip


@pytest.mark.slow
def test_a_run_does_not_depend_on_the_environment(tmp_path: Path) -> None:
    variables = commands.environment() | commands.AFRESH | ENVIRONMENT
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], env=variables, cwd=tmp_path, capture_output=True,
        text=True, check=True, encoding="utf-8",
    )  # fmt: skip
    assert done.stdout.strip() == described()
