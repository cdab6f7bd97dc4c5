"""Lines of descent in the shown worlds; with too many cells or births, no lines are followed."""

from collections.abc import Iterable

import numpy as np

from primordia.phylogeny.clades import CROWD, BirthsAndDeaths, Lines, births_and_deaths
from primordia.random.wide import to_host
from primordia.runs.loop import Status


class Descent:
    """The lines of the first worlds of a run."""

    CELLS, EVENTS = 2**14, 2**12
    """largest numbers of cells, and of births and deaths in a second, for which lines are followed"""

    def __init__(self) -> None:
        self.lines: dict[int, Lines] = {}
        """world's number -> its lines of descent, for the worlds that are followed"""
        self._followed = 0
        self._throughout: set[int] | None = None
        """worlds that were followed in every chunk; None before the first chunk"""

    def follow(self, status: Status, shown: int) -> None:
        """Take the births and deaths of a chunk in the first worlds; `shown` is their number."""
        law, events = status.engine.law, status.engine.events
        if shown * law.cells > self.CELLS:
            return self._give_up()
        happened = births_and_deaths(events, law.cells, shown)
        count = sum(len(each.born) + len(each.dead) for each in happened)
        if self._followed + count > self.EVENTS * (1 + status.wall_s):
            return self._give_up()
        self._followed += count
        now = set(range(shown))
        self._throughout = now if self._throughout is None else self._throughout & now
        for world, new in enumerate(happened):
            if world in self.lines:
                self.lines[world].follow(new)
            else:
                self.lines[world] = _first_lines(status, world, new)
        for world in [each for each in self.lines if each >= shown]:
            del self.lines[world]

    def takeovers(self, worlds: Iterable[int]) -> int | None:
        """Return the takeovers in some worlds; None if a world was not followed throughout."""
        worlds = set(worlds)
        if not worlds <= (self._throughout or set()):
            return None
        return sum(len(self.lines[world].takeovers) for world in worlds)

    def _give_up(self) -> None:
        self.lines, self._throughout = {}, set()


def _first_lines(status: Status, world: int, new: BirthsAndDeaths) -> Lines:
    """Return the lines of a world after its first chunk, from genesis on if it was in the chunk."""
    organisms, cells = status.engine.state.world.organisms, status.engine.law.cells
    crowd = min(CROWD, max(cells // 2, 1))
    if len(new.born) and new.born[0] == 0:
        lines = Lines([], crowd)
        lines.follow(new)
        return lines
    here = slice(world * cells, (world + 1) * cells)
    alive, number = np.asarray(organisms.alive)[here], to_host(organisms.number)[here]
    return Lines(number[alive].tolist(), crowd)
