"""The loop of a run: begin or resume, then advance, record and checkpoint.

A run is a directory, whose records follow from the files that it began with; see `recorder`
and `checkpoint`.
"""

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, islice, repeat
from pathlib import Path
from typing import Any

import numpy as np

from primordia import interrupts
from primordia.config import Config, checked
from primordia.engine.engine import Engine
from primordia.engine.state import Limits
from primordia.errors import InputError
from primordia.law.events import Events
from primordia.runs import checkpoint, directory
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import Checkpoint
from primordia.runs.manifest import Progress
from primordia.runs.recorder import Recorder
from primordia.runs.schema import Schema
from primordia.settings import limits as stop

EARLY = (1.0, 4.0, 10.0)
"""Seconds to wait before each early checkpoint; these let a run be read soon."""


@dataclass
class Status:
    """The argument of a listener, which is called after each chunk."""

    engine: Engine
    wall_s: float
    """seconds since this process started or resumed the run"""
    limits: Limits | None = None
    """the limits at which each world stops; None if unknown"""


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
        raise InputError(
            f"these are the settings of a fork of {config.fork.run}; use `primordia fork` on that"
            " run"
        )
    with interrupts.noting(), directory.create(run, config):
        engine = Engine(config)
        recorder = recorder_for(engine, run)
        progress = Progress(limits=config.stop, wall_s=0.0, exact=engine.chunks.exact)
        drive(engine, recorder, run, progress, checkpoint_every, listen)


def begin_or_resume(
    config: Config, run: Path, *, checkpoint_every: float = 60.0, listen: Listener | None = None
) -> list[str]:
    """Begin a run, or resume it if it has begun; see `start` and `resume`.

    Raises:
        InputError: the run was begun with other settings; limits may differ.
    """
    if directory.clear_unbegun(run):
        start(config, run, checkpoint_every=checkpoint_every, listen=listen)
        return []
    directory.check_same_settings(config, run)
    limits = config.stop.model_dump()
    return resume(run, limits, checkpoint_every=checkpoint_every, listen=listen)


def resume(
    run: Path,
    limits: dict[str, Any] | None = None,
    *,
    inexact: bool = False,
    checkpoint_every: float = 60.0,
    listen: Listener | None = None,
) -> list[str]:
    """Go on with a run that stopped, was interrupted, or was killed.

    Args:
        run: the run's directory.
        limits: new values of `ticks`, `births` or `until`.
        inexact: go on although versions differ from those recorded; the run is then marked inexact.
        checkpoint_every: seconds from one checkpoint to the next.
        listen: called after each chunk.

    Returns:
        Notes for the user: on damaged checkpoints that were not used, or on a run that was already
        done.

    Raises:
        InputError: this is not a run, the run is in use or was made by other versions, or a limit
            is wrong.
        Trouble: a file cannot be written, or no checkpoint is whole.
    """
    _check_interval(checkpoint_every)
    given, archive = stop.checked(limits or {}), Archive(run)
    if archive.changed_code:
        _check_same(run, archive.changed_code, inexact)
        archive = Archive(run, edited=True)
    archive.admit()
    config = checked(archive.config, source=str(run / "config.toml"))
    differ = archive.other_versions
    _check_same(run, differ, inexact)
    with interrupts.noting(), directory.locked(run):
        # Read under the lock, so that no other writer can change the run.
        last, damaged = archive.newest
        if last is None and damaged:
            raise checkpoint.no_whole_checkpoint(run, damaged)
        if last is None and config.fork is not None:
            fault = "is a fork without a first checkpoint; remove this folder and fork again"
            raise InputError(f"{run} {fault}")
        directory.make_folders(run)
        checkpoint.remove_leftovers(run, last)
        engine = Engine(config)
        recorder = recorder_for(engine, run)
        progress = Progress(limits=config.stop, wall_s=0.0, exact=engine.chunks.exact)
        if last is not None:
            restore(engine, recorder, last, archive.arrays_of(last))
            progress = last.manifest.progress.gone_on(engine.chunks.exact)
        progress.limits = progress.limits.model_copy(update=given)
        progress.exact &= not differ and engine.chunks.exact
        notes = [f"a damaged checkpoint was not used: {fault}" for fault in damaged]
        if not engine.any_running(engine.limits(progress.limits.model_dump())):
            notes.append(_nothing_to_do(run, progress))
        drive(engine, recorder, run, progress, checkpoint_every, listen)
    return notes


def recorder_for(engine: Engine, run: Path | None) -> Recorder:
    """Return a recorder for an engine's events; without a directory the recorder keeps only digests."""
    config = engine.config
    return Recorder(run, config.seeds, Schema.of(engine.law, engine.tallies))


def restore(
    engine: Engine, recorder: Recorder, stored: Checkpoint, arrays: Mapping[str, np.ndarray]
) -> None:
    """Load a checkpoint with its arrays into an engine and a recorder."""
    arrays = dict(arrays)
    recorder.resume(stored.manifest.segments, stored.digests, arrays)
    engine.load(arrays)


def _nothing_to_do(run: Path, progress: Progress) -> str:
    limits = ", ".join(f"{name} {value}" for name, value in progress.limits if value)
    return (
        f"nothing to do: every world of {run} has reached a limit ({limits}); to go on, set"
        " another limit with --ticks, --births or --until, such as --ticks 1000000 --until none"
    )


def drive(
    engine: Engine,
    recorder: Recorder,
    run: Path,
    progress: Progress,
    checkpoint_every: float,
    listen: Listener | None,
) -> None:
    """Advance, record and checkpoint until every world stops or a signal comes; see `start`.

    If a listener fails, a checkpoint is written before the listener's error is raised.

    Raises:
        KeyboardInterrupt: on Ctrl-C, SIGTERM or SIGHUP, after a checkpoint if the run has advanced.
    """
    limits = engine.limits(progress.limits.model_dump())
    with interrupts.noting() as noted, directory.held(run) as check:
        began, chunks = time.perf_counter(), _chunks(engine, limits, noted)
        # Compiling the first chunk takes seconds, during which a signal may end a command at once.
        first = list(islice(chunks, 1))
        saver = Saver(engine, recorder, run, progress, checkpoint_every, began, check)
        with interrupts.deferred():
            for events in chain(first, chunks):
                check()
                recorder.append(events)
                directory.note_faults(run, engine.faults)
                if listen is not None:
                    try:
                        listen(Status(engine, saver.seconds, limits))
                    except BaseException:
                        saver.save()
                        raise
                saver.save_if_due()
            if not noted:
                recorder.finish()
            if first or not noted:
                saver.save()
        if noted:
            raise KeyboardInterrupt


def _chunks(engine: Engine, limits: Limits, noted: list[int]) -> Iterator[Events]:
    """Advance, and yield the events of each chunk, until every world stops or a signal comes."""
    while engine.any_running(limits) and not noted:
        yield engine.advance(limits)


@dataclass
class Saver:
    """The checkpoints of a running run: some soon after the first chunk, then one in each interval."""

    engine: Engine
    recorder: Recorder
    run: Path
    progress: Progress
    every: float
    """seconds from one checkpoint to the next"""
    began: float
    """seconds of the clock at which this process started or resumed the run"""
    check: Callable[[], None]
    """raises Trouble if the run's folder was removed or replaced"""

    def __post_init__(self) -> None:
        self._before, self._saved = self.progress.wall_s, time.perf_counter()
        self._waits = chain(EARLY, repeat(self.every))
        self._wait = min(next(self._waits), self.every)

    @property
    def seconds(self) -> float:
        """Seconds since this process started or resumed the run."""
        return time.perf_counter() - self.began

    def save(self) -> None:
        """Write a checkpoint; raise Trouble if the run's folder was removed or replaced."""
        self.check()
        self.progress.wall_s = self._before + self.seconds
        checkpoint.save(self.run, self.engine.arrays(), self.recorder, self.progress)

    def save_if_due(self) -> None:
        """Write a checkpoint if the interval since the last one has passed."""
        if time.perf_counter() - self._saved >= self._wait:
            self.save()
            self._saved = time.perf_counter()
            self._wait = min(next(self._waits), self.every)


def _check_same(run: Path, differ: list[str], inexact: bool) -> None:
    if differ and not inexact:
        raise InputError(
            f"{run} cannot go on bit for bit: {'; '.join(differ)}. Undo these changes, or add --inexact"
        )


def _check_interval(checkpoint_every: float) -> None:
    if not checkpoint_every >= 0:
        raise InputError(
            f"--checkpoint-every must be a number of seconds, 0 or more, not {checkpoint_every}"
        )
