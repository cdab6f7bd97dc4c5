"""Speed of the law, against the arithmetic limit and against a plain loop over objects."""

import tempfile
import time
from pathlib import Path

import jax

import published
from limit import limit
from primordia.config import Stop, load
from primordia.engine.engine import Engine
from primordia.runs.loop import drive
from primordia.runs.manifest import Progress
from primordia.runs.recorder import Recorder
from primordia.runs.schema import Schema
from worlds import median, organism_ticks, random_phase, random_rate, rate, saturated_phase

SHAPES = {"1 x 32": (32, 1), "16 x 32": (32, 16), "1 x 1,024": (1024, 1)}
ROUNDS = 5
SECONDS = 0.5


def against_the_limit() -> list[dict]:
    """Measure the limit, the saturated phase and the random phase, in turn, for each shape."""
    rows = []
    for name, (cells, worlds) in SHAPES.items():
        saturated, random = saturated_phase(cells, worlds), random_phase(cells, worlds)
        random_rate(random, 0)
        measured: dict[str, list[float]] = {"limit": [], "saturated": [], "random": []}
        for number in range(ROUNDS):
            measured["limit"].append(limit_rate(saturated))
            measured["saturated"].append(rate(saturated, SECONDS))
            measured["random"].append(random_rate(random, 1000 * (number + 1)))
        fraction = {
            phase: median([a / b for a, b in zip(measured[phase], measured["limit"], strict=True)])
            for phase in ("saturated", "random")
        }
        rates = {phase: median(values) for phase, values in measured.items()}
        rows.append({"worlds x cells": name, "rates": rates, "of limit": fraction})
    return rows


def limit_rate(made: Engine) -> float:
    """Return organism-ticks per second of an engine's brains and bodies without the law."""
    organisms, bodies = made.state.world.organisms, made.state.bodies + 0
    memory, cells = organisms.memory + 0, len(organisms.memory)
    ticks = max(int(2e6 / cells), 1)
    memory, bodies = jax.block_until_ready(limit(organisms.genome, memory, bodies, ticks))
    began, done = time.perf_counter(), 0
    while time.perf_counter() - began < SECONDS:
        memory, bodies = jax.block_until_ready(limit(organisms.genome, memory, bodies, ticks))
        done += ticks
    return cells * done / (time.perf_counter() - began)


def against_the_plain_loop() -> dict:
    """Measure a whole run on disk, with records and checkpoints, against one object per organism."""
    ratios, ours, theirs = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(ROUNDS):
            theirs.append(_plain(number))
            ours.append(_on_disk(Path(folder, str(number)), seed=number))
            ratios.append(ours[-1] / theirs[-1])
    return {"plain loop": median(theirs), "on disk": median(ours), "ratio": median(ratios)}


def _plain(seed: int) -> float:
    began = time.perf_counter()
    lived = published.organism_ticks(32, seed, 4000)
    return lived / (time.perf_counter() - began)


def _on_disk(run: Path, seed: int) -> float:
    """Return organism-ticks per second from genesis to tick 3,000,000, without compilation."""
    config = load("CartPole-survival", {"seed": seed})
    for name in ("births", "deaths", "metrics", "checkpoints"):
        (run / name).mkdir(parents=True)
    (run / "config.toml").write_text(config.to_toml())
    warm, made = Engine(config), Engine(config)
    warm.advance(warm.limits({}))
    recorder = Recorder(run, 1, Schema.of(made.law, ()))
    progress = Progress(limits=Stop(ticks=3_000_000), wall_s=0.0, exact=True)
    began = time.perf_counter()
    drive(made, recorder, run, progress, 1.0, None)
    return organism_ticks(made) / (time.perf_counter() - began)
