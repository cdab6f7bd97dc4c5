"""The display of a run that advances: a view in a terminal, plain lines elsewhere."""

import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType

import numpy as np
from rich.console import Console, ConsoleOptions, RenderResult
from rich.live import Live
from rich.segment import Segment

from primordia import interrupts
from primordia.history.lines import CROWD, Lines, Turnover, turnovers
from primordia.live.census import Census, Speed
from primordia.live.ground import Ground, medians
from primordia.live.paint import FAINT, Row
from primordia.live.panel import Outlook, heading, numbers, saturation, with_prefix
from primordia.live.scene import Room, scene
from primordia.printable import printable
from primordia.random.wide import to_host
from primordia.runs.loop import Listener, Status


@contextmanager
def watching(quiet: bool) -> Iterator[Listener | None]:
    """Yield the listener that suits this terminal, or plain lines without a terminal."""
    console = Console(
        highlight=False, file=sys.__stdout__
    )  # not the stream that spells out escapes
    if quiet:
        yield None
    elif not sys.stdout.isatty() or console.is_dumb_terminal:
        yield Plain()
    else:
        with interrupts.before_end(show_cursor), View(console) as view:
            yield view


def show_cursor() -> None:
    """Write the escape sequence that shows the cursor, without any lock."""
    os.write(1, b"\x1b[?25h\r\n")


class Plain:
    """A listener that prints a plain line from time to time."""

    EVERY = 2.0
    """seconds between two lines"""

    def __init__(self) -> None:
        self._speed, self._due = Speed(), 0.0

    def __call__(self, status: Status) -> None:
        """Print the counts if a line is due; the first chunk, which compiles, is not counted."""
        now = time.perf_counter()
        if now < self._due:
            return
        census = Census.of(status.engine.state.world)
        self._speed.add(now, census)
        self._due = now + self.EVERY
        if (speed := self._speed.organism_ticks_per_s()) is not None:
            print(
                f"{status.wall_s:6.1f} s  tick {census.tick.max():,}  alive {census.alive.sum():,}"
                f"  births {census.births.sum():,}  {with_prefix(speed)} organism-ticks/s",
                flush=True,
            )


class View:
    """A listener that draws the living and the counts in place, in a `with` block.

    It follows the births of every chunk, and draws as often as SHARE of the time allows.
    """

    SHARE = 0.01
    """share of the time that drawing may take"""
    CELLS, EVENTS = 2**14, 2**15
    """most cells, and most births and deaths in a second, in which lines of descent are followed"""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._letters = console.no_color or console.color_system in (None, "standard")
        self._live = Live(console=console, auto_refresh=False, redirect_stderr=sys.stderr.isatty())
        self._speed, self._lines = Speed(), list[Lines]()
        self._ground: Ground | None = None
        self._followed, self._missed = 0, False
        self._size, self._due = console.size, 0.0
        self._status: Status | None = None

    def __enter__(self) -> "View":
        waiting = Segment("Compiling, which takes some seconds", FAINT)
        self._live.start()
        self._live.update(Frame([[waiting]]), refresh=True)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Draw the last state and leave it on the screen."""
        if self._status is None:
            self._live.update("")
        else:
            self._draw(self._status)
        self._live.stop()

    def __call__(self, status: Status) -> None:
        """Follow a chunk, and draw if a frame is due."""
        self._status = status
        if self._console.size != self._size:
            self._console.clear()  # a terminal reflows its lines when its width changes
            self._size, self._due = self._console.size, 0.0
        self._follow(status)
        self._ground = self._ground or Ground(status.engine.law.cells, status.engine.law.worlds)
        self._ground.follow(status.engine.events)
        began = time.perf_counter()
        if began >= self._due:
            self._draw(status)
            now = time.perf_counter()
            self._due = now + (now - began) / self.SHARE

    def _follow(self, status: Status) -> None:
        """Follow the lines of descent of the worlds that may be shown, if they are not too busy."""
        law, events = status.engine.law, status.engine.events
        shown = min(law.worlds, self._size.height)
        if shown * law.cells > self.CELLS:
            self._lines, self._missed = [], True
            return
        happened = turnovers(events, law.cells, shown)
        count = sum(len(each.born) + len(each.dead) for each in happened)
        if self._followed + count > self.EVENTS * (1 + status.wall_s):
            self._lines, self._missed = [], True
            return
        self._followed += count
        for lines, turnover in zip(self._lines, happened, strict=False):
            lines.follow(turnover)
        for world in range(len(self._lines), shown):
            self._lines.append(_first_lines(status, world, happened[world]))
        del self._lines[shown:]

    def _draw(self, status: Status) -> None:
        self._live.update(Frame(self._rows(status)), refresh=True)

    def _rows(self, status: Status) -> list[Row]:
        law, world = status.engine.law, status.engine.state.world
        width, height = self._size.width, self._size.height - 1
        census = Census.of(world)
        self._speed.add(time.perf_counter(), census)
        left = self._speed.seconds_left(status.limits) if status.limits else None
        outlook = Outlook(self._speed.organism_ticks_per_s(), left)
        known = len(self._lines) == law.worlds and not self._missed
        takeovers = sum(len(lines.takeovers) for lines in self._lines) if known else None
        ground = medians(self._ground.measured(census.tick)) if self._ground else None
        below = numbers(census, law.cells, outlook, takeovers, ground, width)
        below.append(saturation(census, law.cells, law.saturation_ticks, width))
        spare = height - len(below) - 3
        space: list[Row] = [[]] if spare > 4 else []
        room = Room(width, max(spare - 2 * len(space), 1), self._letters)
        drawn = scene(law, world, self._lines, room)
        legend: list[Row] = [[Segment(text, FAINT)] for text in (drawn.part, drawn.legend) if text]
        top = heading(status.engine.config, status.wall_s, width)
        return [top, *space, *drawn.rows, *legend, *space, *below][:height]


def _first_lines(status: Status, world: int, turnover: Turnover) -> Lines:
    """Return the lines of a world after its first chunk, followed from genesis if that was in it."""
    organisms, cells = status.engine.state.world.organisms, status.engine.law.cells
    crowd = min(CROWD, max(cells // 2, 1))
    if len(turnover.born) and turnover.born[0] == 0:
        lines = Lines([], crowd)
        lines.follow(turnover)
        return lines
    here = slice(world * cells, (world + 1) * cells)
    alive, number = np.asarray(organisms.alive)[here], to_host(organisms.number)[here]
    return Lines(number[alive].tolist(), crowd)


class Frame:
    """Rows that rich can print."""

    def __init__(self, rows: list[Row]) -> None:
        self._rows = rows

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the rows, cut to the width."""
        for parts in self._rows:
            row = [Segment(printable(text, kept=""), style) for text, style, _ in parts]
            yield from Segment.adjust_line_length(row, options.max_width, pad=False)
            yield Segment.line()
