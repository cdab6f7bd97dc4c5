"""The display of a run that advances: a view in a terminal with colours, plain lines elsewhere."""

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console

from primordia import interrupts
from primordia.live.census import Census, Speed
from primordia.live.pace import Pace
from primordia.live.panel import with_prefix
from primordia.live.terminal import Keyboard, show_cursor
from primordia.live.view import View
from primordia.runs.loop import Listener, Status


@contextmanager
def watching(quiet: bool, speed: float | None = None) -> Iterator[Listener | None]:
    """Yield the listener that suits this terminal, or plain lines without a terminal or without colours.

    Args:
        quiet: show nothing.
        speed: limit of the speed, in ticks a second; None for no limit.
    """
    pace = Pace(speed)
    # not the stream that spells out escapes
    console = Console(highlight=False, file=sys.__stdout__)
    if quiet:
        yield pace if speed else None
    elif not sys.stdout.isatty() or console.no_color or console.is_dumb_terminal:
        yield Plain(pace)
    else:
        with (
            Keyboard() as keyboard,
            interrupts.before_end(show_cursor),
            interrupts.before_end(keyboard.restore),
            View(console, pace, keyboard) as view,
        ):
            yield view


class Plain:
    """A listener that prints a plain line from time to time."""

    EVERY = 2.0
    """seconds between two lines"""

    def __init__(self, pace: Pace) -> None:
        self._pace, self._speed, self._due = pace, Speed(), 0.0

    def __call__(self, status: Status) -> None:
        """Print the counts if a line is due; the first chunk, which compiles, is not counted."""
        now = time.perf_counter()
        if now >= self._due:
            self._print(status, now)
        self._pace(status)

    def _print(self, status: Status, now: float) -> None:
        census = Census.of(status.engine.state.world)
        self._speed.add(now, census)
        self._due = now + self.EVERY
        if (speed := self._speed.organism_ticks_per_s()) is not None:
            print(
                f"{status.wall_s:6.1f} s  tick {census.tick.max():,}  alive {census.alive.sum():,}"
                f"  births {census.births.sum():,}  {with_prefix(speed)} organism-ticks/s",
                flush=True,
            )
