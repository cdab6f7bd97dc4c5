"""Metrics of runs, written for dashboards by a separate process that reads the runs.

Runs are read from their files, at their newest checkpoints. The process of a run is not disturbed,
and no code of a run is executed.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path

from primordia import interrupts
from primordia.errors import InputError
from primordia.tracking.reader import Reader
from primordia.tracking.tensorboard import TensorBoard
from primordia.tracking.weights_and_biases import WeightsAndBiases

MOMENT = 0.2
"""Longest time until a signal is noticed, in seconds."""


@dataclass(frozen=True)
class Sources:
    """The runs to read."""

    runs: Mapping[str, Sequence[Path]]
    """directories by arm; "" is the name of a single arm"""
    go_on: bool
    """whether there may be more to read later"""


def track(
    look: Callable[[], Sources],
    group: str,
    tensorboard: str | Path | None = None,
    wandb: str | Path | None = None,
    *,
    follow: bool = False,
    every: float = 30.0,
    seen: Callable[[int], object] | None = None,
) -> None:
    """Write the metrics of runs for dashboards, one series for each column, over ticks.

    The output of an earlier call for the same world in the same folder is replaced.

    Args:
        look: a function that returns the present runs.
        group: a name for all runs.
        tensorboard: folder for TensorBoard, in which each world has a folder.
        wandb: folder for Weights & Biases; its runs are in the subfolder `wandb`. Nothing connects
            to the network: wandb's error reports are switched off in this process.
        follow: read again until all runs have stopped.
        every: seconds between two readings.
        seen: a function that is called after each reading with the number of rows written so far.

    Raises:
        InputError: no folder is given, a package is missing, there is nothing to write, or a folder
            holds files of other worlds.
        Trouble: a run is damaged, or a folder cannot be written.
        KeyboardInterrupt: on Ctrl-C; all rows read so far are written.
    """
    if not every > 0:
        raise InputError(f"--every must be a number of seconds above 0, not {every}")
    with interrupts.noting() as noted, interrupts.deferred(), ExitStack() as stack:
        dashboards = [stack.enter_context(closing(each)) for each in _opened(tensorboard, wandb)]
        reader, count = Reader(group), 0
        while True:
            sources = look()
            patient = follow and sources.go_on
            for world, rows in reader.new(sources.runs, patient):
                count += len(rows)
                for each in dashboards:
                    each.add(world, rows)
                    if not follow:
                        each.finish()
                if noted:
                    raise KeyboardInterrupt
            if seen is not None:
                seen(count)
            if not patient:
                break
            _wait(every, noted)
            if noted:
                raise KeyboardInterrupt
    if not count:
        raise InputError(
            f"{group} has no row of metrics yet; a row is written every `sample_every` ticks"
        )


def _opened(
    tensorboard: str | Path | None, wandb: str | Path | None
) -> list[TensorBoard | WeightsAndBiases]:
    if tensorboard is None and wandb is None:
        raise InputError("name a folder to write into: --tensorboard DIR, --wandb DIR, or both")
    opened: list[TensorBoard | WeightsAndBiases] = []
    if tensorboard is not None:
        opened.append(TensorBoard(Path(tensorboard)))
    if wandb is not None:
        opened.append(WeightsAndBiases(Path(wandb)))
    return opened


def _wait(seconds: float, noted: list[int]) -> None:
    """Wait until the time is over or a signal comes."""
    end = time.monotonic() + seconds
    while not noted and (left := end - time.monotonic()) > 0:
        time.sleep(min(left, MOMENT))
