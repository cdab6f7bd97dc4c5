"""What `run` and `resume` show while they live: a view in a terminal, plain lines elsewhere."""

import sys
import time
from contextlib import AbstractContextManager, nullcontext
from types import TracebackType

import numpy as np
from rich.console import Console, ConsoleOptions, RenderResult
from rich.live import Live
from rich.segment import Segment

from primordia.history.lines import CROWD, Lines, Turnover, turnovers
from primordia.live.census import Census, Pace
from primordia.live.paint import FAINT, Row
from primordia.live.panel import Tempo, heading, numbers, saturation, short
from primordia.live.scene import Room, scene
from primordia.random.wide import to_host
from primordia.runs.loop import Listener, Status


def watching(quiet: bool) -> AbstractContextManager[Listener | None]:
    """The listener for this terminal, or for none."""
    if quiet:
        return nullcontext()
    console = Console(highlight=False)
    if not sys.stdout.isatty() or console.is_dumb_terminal:
        return nullcontext(Plain())
    return View(console)


class Plain:
    """A listener that prints a plain line now and then."""

    EVERY = 2.0
    """seconds"""

    def __init__(self) -> None:
        self._pace, self._due = Pace(), 0.0

    def __call__(self, status: Status) -> None:
        """Print how far it is, if it is time. The first chunk is compilation, and not counted."""
        now = time.perf_counter()
        if now < self._due:
            return
        census = Census.of(status.engine.state.world)
        self._pace.see(now, census)
        self._due = now + self.EVERY
        if (rate := self._pace.organism_ticks()) is not None:
            print(
                f"{status.wall_s:6.1f} s  tick {census.tick.max():,}  alive {census.alive.sum():,}"
                f"  births {census.births.sum():,}  {short(rate)} organism-ticks/s",
                flush=True,
            )


class View:
    """A listener that draws the living, and counts, in place. Use it in a `with`.

    It follows every chunk's births, and draws as often as SHARE of the time allows.
    """

    SHARE = 0.01
    """of the time, at most, for drawing"""
    CELLS, EVENTS = 2**14, 2**15
    """lines of descent are not followed in more cells, nor through more births and deaths a second"""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._letters = console.no_color or console.color_system in (None, "standard")
        self._live = Live(console=console, auto_refresh=False, redirect_stderr=sys.stderr.isatty())
        self._pace, self._lines = Pace(), list[Lines]()
        self._followed, self._missed = 0, False
        self._size, self._due = console.size, 0.0
        self._status: Status | None = None

    def __enter__(self) -> "View":
        waiting = Segment("Compiling; that takes some seconds", FAINT)
        self._live.start()
        self._live.update(Rows([[waiting]]), refresh=True)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave how it stands in the end."""
        if self._status is None:
            self._live.update("")
        else:
            self._draw(self._status)
        self._live.stop()

    def __call__(self, status: Status) -> None:
        """Follow a chunk; draw, if it is time."""
        self._status = status
        if self._console.size != self._size:
            self._console.clear()  # a terminal breaks lines anew when its width changes
            self._size, self._due = self._console.size, 0.0
        self._follow(status)
        began = time.perf_counter()
        if began >= self._due:
            self._draw(status)
            now = time.perf_counter()
            self._due = now + (now - began) / self.SHARE

    def _follow(self, status: Status) -> None:
        """Lines of descent of the worlds that may be shown, unless too much is going on."""
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
            self._lines.append(_begun(status, world, happened[world]))
        del self._lines[shown:]

    def _draw(self, status: Status) -> None:
        self._live.update(Rows(self._frame(status)), refresh=True)

    def _frame(self, status: Status) -> list[Row]:
        law, world = status.engine.law, status.engine.state.world
        width, height = self._size.width, self._size.height - 1
        census = Census.of(world)
        self._pace.see(time.perf_counter(), census)
        left = self._pace.seconds_left(status.limits) if status.limits else None
        tempo = Tempo(self._pace.organism_ticks(), left)
        known = len(self._lines) == law.worlds and not self._missed
        takeovers = sum(len(lines.takeovers) for lines in self._lines) if known else None
        below = numbers(census, law.cells, tempo, takeovers, width)
        below.append(saturation(census, law.cells, law.saturation_ticks, width))
        spare = height - len(below) - 3
        air: list[Row] = [[]] if spare > 4 else []
        room = Room(width, max(spare - 2 * len(air), 1), self._letters)
        drawn = scene(law, world, self._lines, room)
        legend: list[Row] = [[Segment(text, FAINT)] for text in (drawn.part, drawn.legend) if text]
        top = heading(status.engine.config, status.wall_s, width)
        return [top, *air, *drawn.rows, *legend, *air, *below][:height]


def _begun(status: Status, world: int, turnover: Turnover) -> Lines:
    """Lines of a world from here on; from its genesis, if that is in the latest chunk."""
    organisms, cells = status.engine.state.world.organisms, status.engine.law.cells
    crowd = min(CROWD, max(cells // 2, 1))
    if len(turnover.born) and turnover.born[0] == 0:
        lines = Lines([], crowd)
        lines.follow(turnover)
        return lines
    here = slice(world * cells, (world + 1) * cells)
    alive, number = np.asarray(organisms.alive)[here], to_host(organisms.number)[here]
    return Lines(number[alive].tolist(), crowd)


class Rows:
    """Rows as rich prints them."""

    def __init__(self, rows: list[Row]) -> None:
        self._rows = rows

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Cut to the width."""
        for row in self._rows:
            yield from Segment.adjust_line_length(row, options.max_width, pad=False)
            yield Segment.line()
