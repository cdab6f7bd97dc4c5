"""Metrics of runs, written for dashboards by a reader beside them.

Runs are read as `info` reads them: from their files, as of their newest checkpoints. The process that
lives them is not asked, and none of their code is executed.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from primordia import interrupts
from primordia.errors import InputError
from primordia.tracking.reader import Reader, Row, World
from primordia.tracking.tensorboard import TensorBoard
from primordia.tracking.weights_and_biases import WeightsAndBiases

MOMENT = 0.2
"""Longest time, in seconds, after which a signal is noticed."""


class Dashboard(Protocol):
    """Files that a program for looking at curves reads."""

    def add(self, world: World, rows: list[Row]) -> None:
        """Append rows of a world."""

    def finish(self) -> None:
        """Complete the files of all worlds so far; no row of these follows."""

    def close(self) -> None:
        """Finish, and release everything."""


@dataclass(frozen=True)
class Sources:
    """The runs that are to be read."""

    runs: Mapping[str, Sequence[Path]]
    """directories by arm; "" names an arm that is alone"""
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

    What an earlier call has written of a world into the same folder is replaced.

    Args:
        look: returns the runs as they stand.
        group: a name for them all.
        tensorboard: folder for TensorBoard, in which each world has a folder.
        wandb: folder for Weights & Biases, whose runs are then in the folder `wandb` there. It never
            connects to the network; its reports of its own errors are switched off in this process.
        follow: go on as the runs go on, until they have stopped.
        every: seconds from one look to the next.
        seen: called after each look with the number of rows written so far.

    Raises:
        InputError: no folder is given, a package is missing, there is nothing to write, or a folder holds
            files of others.
        Trouble: a run is damaged, or a folder cannot be written.
        KeyboardInterrupt: on Ctrl-C; what was read until then is written.
    """
    if not every > 0:
        raise InputError(f"--every: seconds, more than 0, not {every}")
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
            f"{group} has no row of metrics yet: there is one every `sample_every` ticks"
        )


def _opened(tensorboard: str | Path | None, wandb: str | Path | None) -> list[Dashboard]:
    if tensorboard is None and wandb is None:
        raise InputError("name a folder to write into: --tensorboard DIR, --wandb DIR, or both")
    opened: list[Dashboard] = []
    if tensorboard is not None:
        opened.append(TensorBoard(Path(tensorboard)))
    if wandb is not None:
        opened.append(WeightsAndBiases(Path(wandb)))
    return opened


def _wait(seconds: float, noted: list[int]) -> None:
    """Wait, but not longer than until a signal comes."""
    end = time.monotonic() + seconds
    while not noted and (left := end - time.monotonic()) > 0:
        time.sleep(min(left, MOMENT))
