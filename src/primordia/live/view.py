"""The view of a run that advances, in a terminal."""

import sys
import time
from signal import SIGINT, raise_signal

from rich.console import Console
from rich.live import Live
from rich.segment import Segment, SegmentLines

from primordia.live.census import Census, Speed
from primordia.live.companion import Companion
from primordia.live.descent import Descent
from primordia.live.forms import Room
from primordia.live.pace import Pace
from primordia.live.paint import FAINT, Row
from primordia.live.panel import Outlook, heading, numbers, panel, saturation
from primordia.live.scene import Scene, Stage
from primordia.live.screen import composed
from primordia.live.terminal import Keyboard
from primordia.live.words import keys, pages
from primordia.printable import printable
from primordia.runs.loop import Status


class View:
    """A listener that draws the living and the counts in place, in a `with` block, and obeys keys.

    The view follows the births of every chunk. Drawing may take the part SHARE of the time, and
    more while the run waits.
    """

    SHARE = 0.01
    """share of the time that drawing may take"""
    MOMENT, LONGEST = 0.1, 2.0
    """smallest number of seconds between two past moments of a ring, and largest number of seconds
    between two frames"""

    def __init__(
        self, console: Console, pace: Pace | None = None, keyboard: Keyboard | None = None
    ) -> None:
        self._console, self._pace = console, pace or Pace()
        self._keyboard = keyboard or Keyboard()
        self._live = Live(console=console, auto_refresh=False, redirect_stderr=sys.stderr.isatty())
        self._speed, self._stage, self._descent = Speed(), Stage(), Descent()
        self._size, self._due, self._cost, self._stale = console.size, 0.0, 0.0, False
        self._moment = 0.0
        self._status: Status | None = None
        self._alone: int | None = None
        self._companion: Companion | None = None
        self._page: int | None = None

    def __enter__(self) -> "View":
        waiting = Segment("Compiling, which takes some seconds", FAINT)
        self._live.start()
        self._live.update(frame([[waiting]]), refresh=True)
        return self

    def __exit__(self, *error: object) -> None:
        """Draw the last state and leave it on the screen."""
        if self._status is None:
            self._live.update("")
        else:
            self._keyboard, self._page = Keyboard(), None
            self._draw(self._status)
        self._live.stop()

    def __call__(self, status: Status) -> None:
        """Follow a chunk, draw if a frame is due, and wait as the pace demands."""
        law = status.engine.law
        self._descent.follow(status, min(law.worlds, self._console.size.height))
        self._status, self._stale = status, True
        now = time.perf_counter()
        alone = law.worlds == 1 or self._alone is not None
        if alone and (now >= self._moment or self._pace.limited):
            self._moment = now + self.MOMENT
            world, lines = status.engine.state.world, self._descent.lines
            self._stage.follow(law, world, lines, self._alone or 0)
        if now >= self._due:
            self._draw(status)
        self._react(0.0)
        self._pace(status, self._react)

    def _react(self, seconds: float) -> None:
        """Spend some seconds of waiting on a frame and on keys; draw what keys change."""
        assert self._status is not None
        if self._stale and seconds > self._cost:
            self._draw(self._status)
        pressed = self._keyboard.pressed(seconds)
        for key in pressed:
            self._obey(key, self._status)
        if pressed or self._console.size != self._size:
            self._draw(self._status)

    def _obey(self, key: str, status: Status) -> None:
        """Do what a key means; see `words.KEYS`."""
        engine, pace = status.engine, self._pace
        if key == " ":
            pace.pause()
            self._speed = Speed()
        elif key == "s":
            pace.step()
        elif key == "-":
            pace.slower(self._speed.ticks_per_s())
        elif key in "+=":
            pace.faster()
        elif key == "w":
            following = 0 if self._alone is None else self._alone + 1
            self._alone = following if following < engine.law.worlds > 1 else None
        elif key == "o":
            self._companion = None if self._companion else Companion()
        elif key == "n" and self._companion:
            self._companion.find(engine, self._alone, step=1)
        elif key == "?":
            self._page = 0 if self._page is None else self._page + 1
        elif key == "q":
            raise_signal(SIGINT)

    def _draw(self, status: Status) -> None:
        began = time.perf_counter()
        if self._console.size != self._size:
            self._console.clear()  # a terminal reflows its lines when its width changes
            self._size = self._console.size
        self._live.update(frame(self._rows(status)), refresh=True)
        now = time.perf_counter()
        self._cost, self._stale = now - began, False
        self._due = now + min(self._cost / self.SHARE, self.LONGEST)

    def _rows(self, status: Status) -> list[Row]:
        width, height = self._size.width, self._size.height - 1
        room = Room(width, max(height - (2 if self._keyboard.there else 1), 1))
        rows = [heading(status.engine.config, str(self._pace), status.wall_s, width)]
        rows += self._words(room) or self._world(status, room)
        if self._keyboard.there:
            rows += [[]] * (height - 1 - len(rows))
            rows = [*rows[: height - 1], self._keys(status)]
        return rows[:height]

    def _words(self, room: Room) -> list[Row]:
        """Return the page of words that is shown; nothing if the world is shown."""
        if self._page is None:
            return []
        islands = self._status is not None and self._status.engine.law.islands.count > 1
        found = pages(room.width, room.height, islands)
        if self._page >= len(found):
            self._page = None
            return []
        return found[self._page]

    def _keys(self, status: Status) -> Row:
        """Return the keys that mean something now."""
        many = "w" if status.engine.law.worlds > 1 else ""
        return keys(f"s-{many}{'on' if self._companion else 'o'}?q")

    def _world(self, status: Status, room: Room) -> list[Row]:
        engine, alone = status.engine, self._alone
        law, world, lines = engine.law, engine.state.world, self._descent.lines
        census = Census.of(world, islands=law.islands)
        self._speed.add(time.perf_counter(), census)
        if alone is not None:
            census = Census.of(world, alone, law.islands)
        values = self._numbers(status, census)

        def draw(room: Room) -> Scene:
            return self._stage.scene(law, world, lines, alone, room)

        def counts(room: Room) -> list[Row]:
            bar = saturation(census, law.cells, law.saturation_ticks, room.width)
            return panel(values, census, bar, room.width, room.height)

        def organism(room: Room) -> list[Row]:
            return self._companion.rows(engine, alone, room) if self._companion else []

        beside = law.placement.shape(law.cells)[0] > 1  # a torus is high, and a ring is wide
        return composed(beside, draw, counts, organism if self._companion else None, room)

    def _numbers(self, status: Status, census: Census) -> dict[str, str]:
        """Return the counts of the worlds that are shown."""
        law, alone = status.engine.law, self._alone
        left = self._speed.seconds_left(status.limits) if status.limits else None
        outlook = Outlook(self._speed.organism_ticks_per_s(), left)
        shown = range(law.worlds) if alone is None else [alone]
        takeovers = self._descent.takeovers(shown)
        return numbers(census, law.cells, outlook, takeovers, law.islands)


def frame(rows: list[Row]) -> SegmentLines:
    """Return rows that rich can print; it cuts them to the width of the terminal."""
    spelled = ([Segment(printable(text, kept=""), style) for text, style, _ in row] for row in rows)
    return SegmentLines(spelled, new_lines=True)
