"""The loop: advance, record, checkpoint; and how a run begins and goes on.

A run is a directory. Everything in it is a function of `config.toml`; see `record` and `checkpoint`.
"""

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from primordia.config import Config, checked
from primordia.config import limits as valid_limits
from primordia.engine.engine import Engine
from primordia.engine.state import Limits
from primordia.errors import InputError
from primordia.runs import checkpoint, directory
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import Checkpoint, Progress
from primordia.runs.record import Recorder
from primordia.runs.schema import Schema


@dataclass
class Status:
    """The argument of a listener, which is called after each chunk."""

    engine: Engine
    wall_s: float
    """seconds since this process started or resumed the run"""
    limits: Limits | None = None
    """when each world stops; None if unknown"""


Listener = Callable[[Status], None]


def start(
    config: Config, run: Path, *, checkpoint_every: float = 60.0, listen: Listener | None = None
) -> None:
    """Begin a run in a new directory and drive it until it stops or is interrupted.

    Args:
        config: all settings.
        run: the run's directory; it must be missing or empty.
        checkpoint_every: seconds from one checkpoint to the next.
        listen: called after each chunk.

    Raises:
        InputError: the directory is taken.
        Trouble: a file cannot be written.
    """
    _check_interval(checkpoint_every)
    if config.fork is not None:
        raise InputError(f"these are the settings of a fork of {config.fork.run}; fork that again")
    with directory.create(run, config):
        engine = Engine(config)
        recorder = recorder_for(engine, run)
        progress = Progress(config.stop.model_dump(), 0.0, engine.chunks.exact)
        drive(engine, recorder, run, progress, checkpoint_every, listen)


def resume(
    run: Path,
    limits: dict[str, Any] | None = None,
    *,
    inexact: bool = False,
    checkpoint_every: float = 60.0,
    listen: Listener | None = None,
) -> list[str]:
    """Go on where a run stopped, was interrupted, or was killed.

    Args:
        run: the run's directory.
        limits: new values of `ticks`, `births` or `until`.
        inexact: go on although versions differ from those recorded; the run is then marked inexact.
        checkpoint_every: seconds from one checkpoint to the next.
        listen: called after each chunk.

    Returns:
        Notes for the user: damaged checkpoints that were not used, or that there was nothing to do.

    Raises:
        InputError: this is no run, one in use, or one of other versions; a limit makes no sense.
        Trouble: a file cannot be written, or no checkpoint is whole.
    """
    _check_interval(checkpoint_every)
    given, archive = valid_limits(limits or {}), Archive(run)
    _check_same(run, archive.changed_code, inexact)
    archive.admit()
    config = checked(archive.config, source=str(run / "config.toml"))
    differ = archive.other_versions
    _check_same(run, differ, inexact)
    with directory.locked(run):
        last, faults = archive.newest  # read under the lock, since another writer could change it
        if last is None and faults:
            raise checkpoint.no_whole_checkpoint(run, faults)
        if last is None and config.fork is not None:
            raise InputError(
                f"{run} is a fork that was cut off before it began; remove it and fork again"
            )
        directory.make_folders(run)
        checkpoint.remove_leftovers(run, last)
        engine = Engine(config)
        recorder = recorder_for(engine, run)
        progress = Progress(config.stop.model_dump(), 0.0, engine.chunks.exact)
        if last is not None:
            restore(engine, recorder, last)
            progress = last.progress
        progress.limits |= given
        progress.exact &= not differ and engine.chunks.exact
        notes = [f"a damaged checkpoint was not used: {fault}" for fault in faults]
        if not engine.any_running(engine.limits(progress.limits)):
            notes.append(_nothing_to_do(run, progress))
        drive(engine, recorder, run, progress, checkpoint_every, listen)
    return notes


def recorder_for(engine: Engine, run: Path | None) -> Recorder:
    """Return a recorder for an engine's events; without a directory it keeps digests only."""
    config = engine.config
    return Recorder(run, config.seeds, Schema.of(engine.law, engine.tallies))


def restore(engine: Engine, recorder: Recorder, stored: Checkpoint) -> None:
    """Load a checkpoint into an engine and a recorder."""
    arrays = dict(stored.arrays())
    recorder.resume(stored.manifest["segments"], stored.digests, arrays)
    engine.load(arrays)


def _nothing_to_do(run: Path, progress: Progress) -> str:
    limits = ", ".join(f"{name} {value}" for name, value in progress.limits.items() if value)
    return (
        f"nothing to do: every world of {run} has reached a limit ({limits}); to go on, set"
        " another with --ticks, --births or --until, such as --ticks 1000000 --until none"
    )


def drive(
    engine: Engine,
    recorder: Recorder,
    run: Path,
    progress: Progress,
    checkpoint_every: float,
    listen: Listener | None,
) -> None:
    """Advance, record and checkpoint until every world stops, or Ctrl-C; see `start`.

    Raises:
        KeyboardInterrupt: on Ctrl-C or SIGTERM, after a checkpoint.
    """
    limits, before = engine.limits(progress.limits), progress.wall_s
    began = saved = time.perf_counter()

    def save() -> None:
        progress.wall_s = before + time.perf_counter() - began
        checkpoint.save(run, engine.arrays(), recorder, progress)

    with interruptible() as interrupted:
        while engine.any_running(limits) and not interrupted:
            recorder.append(engine.advance(limits))
            if listen is not None:
                listen(Status(engine, time.perf_counter() - began, limits))
            if time.perf_counter() - saved >= checkpoint_every:
                save()
                saved = time.perf_counter()
        if not interrupted:
            recorder.finish()
        save()
    if interrupted:
        raise KeyboardInterrupt


def _check_same(run: Path, differ: list[str], inexact: bool) -> None:
    if differ and not inexact:
        raise InputError(
            f"{run} cannot go on bit for bit: {'; '.join(differ)}. Restore that, or add --inexact"
        )


def _check_interval(checkpoint_every: float) -> None:
    if not checkpoint_every >= 0:
        raise InputError(f"--checkpoint-every: seconds, 0 or more, not {checkpoint_every}")


@contextmanager
def interruptible() -> Iterator[list[int]]:
    """Yield a list that stays empty until Ctrl-C or SIGTERM."""
    received: list[int] = []

    def receive(number: int, _: object) -> None:
        received.append(number)

    signals = (signal.SIGINT, signal.SIGTERM)
    try:
        before = [signal.signal(each, receive) for each in signals]
    except ValueError:  # this is not the main thread, which alone receives signals
        yield received
        return
    try:
        yield received
    finally:
        for each, handler in zip(signals, before, strict=True):
            signal.signal(each, handler)
