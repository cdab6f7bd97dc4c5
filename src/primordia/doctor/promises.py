"""Trials of the promises with the versions and on a device of this machine.

Each trial is small: lives alone and beside others, in chunks, on one thread, killed and resumed, and
lived again from the records. All of them together take about half a minute on a CPU.
"""

import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia import device
from primordia.brains.contract import KNOWN, Brain, Genome, find
from primordia.compiled import jit
from primordia.config import load
from primordia.engine.engine import Engine
from primordia.habitats.cartpole.habitat import CartPole
from primordia.history.births import genome_in
from primordia.history.pedigree import genomes
from primordia.law.motor import argmax
from primordia.organism.reliving.compare import relive
from primordia.random.trials import normal, words
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.digest import digests
from primordia.settings import doors
from primordia.testing import check_brain, check_habitat

TASK, CELLS, SEED = "CartPole-survival", 31, 5
TICKS, FEW = 3000, 400
COUNTS, MOST = (1, 7, 31, 32), 1000
"""Numbers of organisms whose lives must be the same as among MOST."""
ENVIRONMENT = "gymnax:Pendulum-v1"
"""An environment in JAX whose lives depend on sums, products and trigonometry."""


class Trial(NamedTuple):
    """The result of a trial."""

    name: str
    fault: str
    """what was found, in one line; "" if the promise held"""


def trials() -> Iterator[Trial]:
    """Try each promise on the device that JAX computes on, and yield each result when it is known."""
    device.prepare()
    for name, attempt in _attempts():
        try:
            fault = attempt()
        except Exception as error:  # a trial that fails in any way is a fault of this installation
            fault = f"{type(error).__name__}: {' '.join(str(error).split())}"
        yield Trial(name, fault)


def _attempts() -> Iterator[tuple[str, Callable[[], str]]]:
    yield "arithmetic is computed as it is written", _arithmetic
    for kind in KNOWN:
        yield f"brain {kind}: the same alone, beside others and in a loop", partial(_brain, kind)
    counts = ", ".join(map(str, COUNTS))
    yield f"CartPole: the same among {counts} and {MOST:,}", _bodies
    if find_spec("gymnax"):
        yield f"{ENVIRONMENT}: the same alone, beside others and in a loop", _environment
    alone: list[str] = []
    yield "a world beside others is the same as alone", partial(_beside, alone)
    yield "a world in chunks of 7 ticks is the same", _in_chunks
    if _platform() == device.CPU:
        yield "a world on one thread is the same as on all", partial(_on_one_thread, alone)
    yield "a run that is killed and resumed is the same", partial(_killed, alone)
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "run"
        yield "lives that are lived again end as recorded", partial(_lived_again, run)
        yield "genomes that the CPU rebuilds are those of the run", partial(_rebuilt, run)


def _arithmetic() -> str:
    """Compare a product and a sum, and two products, with NumPy's, for each number of numbers."""
    a, b, c = np.asarray(normal(0, 3, MOST))

    def compute(a: Array, b: Array, c: Array) -> tuple[Array, Array]:
        return a * b + c * b, c * np.float32(0.05) / np.float32(1.1) * np.float32(0.02)

    compiled = jit(compute)
    for count in (*COUNTS, MOST):
        given = a[:count], b[:count], c[:count]
        for found, expected in zip(compiled(*given), compute(*given), strict=True):
            if np.asarray(found).tobytes() != np.asarray(expected).tobytes():
                return f"{count} numbers are rounded in another way than by NumPy"
    return ""


def _brain(kind: str) -> str:
    check_brain(find(kind)())
    return ""


def _environment() -> str:
    check_habitat(load(doors.full(ENVIRONMENT)).build_habitat())
    return ""


def _bodies() -> str:
    """Compare lives of poles and brains in one loop, for each number of organisms."""
    habitat, brain = CartPole(), find("recurrent")()
    layout = brain.layout(habitat.senses_size, habitat.action.size)
    genome = {name: normal(at, MOST, *shape) for at, (name, shape) in enumerate(layout.blocks)}
    birth, live = words(9, MOST, habitat.words), jit(partial(_lived, brain, habitat))
    whole = live(genome, birth)
    for count in COUNTS:
        some = live({name: block[:count] for name, block in genome.items()}, birth[:count])
        if np.asarray(some).tobytes() != np.asarray(whole)[:count].tobytes():
            return f"{count} bodies move in another way than among {MOST:,}"
    return ""


def _lived(brain: Brain, habitat: CartPole, genome: Genome, words: Array) -> Array:
    """Return bodies (N, 4) after 50 ticks with brains that begin without memory."""
    memory = jnp.zeros((len(words), brain.memory(habitat.senses_size, habitat.action.size)))

    def tick(carry: tuple[Array, Array], _: None) -> tuple[tuple[Array, Array], None]:
        memory, bodies = carry
        memory, output = brain(genome, memory, habitat.sense(bodies))
        return (memory, habitat.step(bodies, argmax(output))[0]), None

    return lax.scan(tick, (memory, habitat.reset(words)), None, length=50)[0][1]


def _beside(alone: list[str]) -> str:
    """Compare a world with itself between two others; keep its digest in `alone`."""
    alone += _digests(TICKS, seed=SEED)
    middle = _digests(TICKS, seed=SEED - 1, seeds=3)[1]
    return "" if alone[0] == middle else f"{alone[0][:16]}... alone, {middle[:16]}... beside others"


def _in_chunks() -> str:
    whole, parts = _digests(FEW, seed=SEED), _digests(FEW, longest=7, seed=SEED)
    return "" if whole == parts else f"{parts[0][:16]}... in chunks, {whole[0][:16]}... in one"


def _on_one_thread(alone: list[str]) -> str:
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "run"
        process = _begun(run, PRIMORDIA_CORES="1")
        return _compared(run, alone, "on one thread") if process.wait() == 0 else _said(run)


def _killed(alone: list[str]) -> str:
    """Kill a run after its first checkpoint, and compare it when it has been resumed."""
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "run"
        process = _begun(run, "--checkpoint-every", "0", "--speed", f"{TICKS}")
        while process.poll() is None and not list(run.glob("checkpoints/*/manifest.json")):
            time.sleep(0.05)
        process.send_signal(signal.SIGKILL)
        if process.wait() not in (0, -signal.SIGKILL):
            return _said(run)
        loop.resume(run)
        return _compared(run, alone, "resumed")


def _lived_again(run: Path) -> str:
    """Begin a run, and live the oldest of the living and the longest life of the dead again."""
    loop.start(load(TASK, {"cells": CELLS, "seed": SEED, "stop": {"ticks": FEW}}), run)
    archive = Archive(run)
    lives = archive.lives
    for died in (False, True):
        (rows,) = np.nonzero(lives.died == died)
        longest = rows[lives.lifespan[rows].argmax()]
        found = relive(archive, int(lives.id[longest]))
        if not found.agrees:
            names = ", ".join(each.name for each in found.respects if not each.agrees)
            return f"organism {lives.id[longest]} differs in {names}"
    return ""


def _rebuilt(run: Path) -> str:
    """Rebuild the genomes of the living on the CPU, and compare them with those of the checkpoint."""
    archive = Archive(run)
    (living,) = np.nonzero(~archive.lives.died)
    with device.selected(device.CPU):
        rebuilt = genomes(archive, living)
    numbers = archive.lives.id[living].tolist()
    stored = [genome_in(archive.state, archive.layout, number, 0) for number in numbers]
    differ = (rebuilt.view(np.uint32) != np.stack(stored).view(np.uint32)).any(axis=1).sum()
    return f"{differ} of {len(living)} genomes differ" if differ else ""


def _platform() -> str:
    """Return the platform that JAX computes on."""
    return device.default().platform


def _begun(run: Path, *flags: str, **variables: str) -> subprocess.Popen[bytes]:
    """Begin the run of the world in a process of its own, which compiles for itself."""
    command = [sys.executable, "-m", "primordia", "run", TASK, "--quiet", *flags]
    command += ["--device", _platform(), "--out", str(run)]
    settings = f"--seed {SEED} --cells {CELLS} --ticks {TICKS} --until none".split()
    with run.with_suffix(".said").open("wb") as said:
        return subprocess.Popen(
            [*command, *settings],
            env=os.environ | {"JAX_ENABLE_COMPILATION_CACHE": "false"} | variables,
            stdout=subprocess.DEVNULL,
            stderr=said,
        )


def _said(run: Path) -> str:
    """Return the end of what the process of a run has said."""
    return (
        run.with_suffix(".said").read_text(encoding="utf-8", errors="replace")[-200:]
        or "the process ended"
    )


def _compared(run: Path, alone: list[str], how: str) -> str:
    archive = Archive(run)
    last, _ = archive.newest
    assert last is not None
    (found,) = digests(last.digests, archive.state, 1, archive.config.islands)
    return "" if [found] == alone else f"{found[:16]}... {how}, {alone[0][:16]}... in this process"


def _digests(ticks: int, longest: int | None = None, **settings: Any) -> list[str]:
    """Return the digest of each world of a run in memory, with chunks of at most `longest` ticks."""
    engine = Engine(load(TASK, {"cells": CELLS, **settings}))
    engine.longest, recorder = longest, loop.recorder_for(engine, None)
    limits = engine.limits({"ticks": ticks})
    while engine.any_running(limits):
        recorder.append(engine.advance(limits))
    return digests(recorder.digests(), engine.arrays(), engine.config.seeds, engine.law.islands)
