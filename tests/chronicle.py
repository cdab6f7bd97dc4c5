"""A world's records, replayed event by event and checked against the rules of every world."""

import math
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from primordia.law.world import Cause
from primordia.random.wide import to_host
from tests.worlds import Lived

STEPS = {
    "ring": [(0, -1), (0, 1)],
    "torus4": [(0, -1), (0, 1), (-1, 0), (1, 0)],
    "torus8": [(0, -1), (0, 1), (-1, 0), (1, 0), (-1, -1), (-1, 1), (1, -1), (1, 1)],
}


def reach(topology: str, cell: int, cells: int) -> list[int]:
    """Return the cells in reach in the order of their numbers; on small tori some appear twice."""
    if topology == "well-mixed":
        return [other for other in range(cells) if other != cell]
    rows = 1
    if topology != "ring":
        rows = max(r for r in range(1, math.isqrt(cells) + 1) if cells % r == 0)
    columns = cells // rows
    row, column = divmod(cell, columns)
    return [(row + r) % rows * columns + (column + c) % columns for r, c in STEPS[topology]]


@dataclass(eq=False)
class RecordedLife:
    """An organism's life as recorded; its number counts from the first birth of the run."""

    number: int
    parent: "RecordedLife | None"
    born: int
    cell: int
    origin: str
    died: int | None = None
    cause: str | None = None
    energy: float = 0.0
    food: float = 0.0

    @property
    def age(self) -> int:
        """Ticks lived at death."""
        assert self.died is not None
        return self.died - self.born


class History:
    """One world, from its rows of births and deaths; the constructor asserts what holds in all worlds."""

    def __init__(self, lived: Lived, world: int = 0, start: tuple[int, int] = (0, 0)) -> None:
        self.lived, self.world, self.start = lived, world, start
        self.cells, self.now = lived.config.cells, int(self._worlds("tick"))
        self.lives: list[RecordedLife] = []
        self.extinctions: list[int] = []
        self.living_after: dict[int, list[RecordedLife]] = {}
        """the organisms alive at the end of each tick with an event"""
        births, deaths = self._rows("births"), self._rows("deaths")
        occupant: dict[int, RecordedLife] = {}
        for tick in sorted({*births, *deaths}):
            self._one_tick(tick, births.get(tick, []), deaths.get(tick, []), occupant)
            self.living_after[tick] = list(occupant.values())
        self._assert_state_agrees(occupant)

    def _worlds(self, name: str) -> np.ndarray:
        return to_host(getattr(self.lived.engine.state.world.worlds, name))[self.world]

    def _rows(self, name: str) -> dict[int, list[dict]]:
        table = self.lived.table(name)
        by_tick: dict[int, list[dict]] = defaultdict(list)
        for i in np.flatnonzero(table["world"] == self.world):
            row = {column: values[i] for column, values in table.items()}
            by_tick[int(row["tick"])].append(row)
        order = [(tick, row["cell"]) for tick, rows in by_tick.items() for row in rows]
        assert all(a < b for a, b in pairwise(order)), f"{name} are not in order of tick and cell"
        return by_tick

    def _one_tick(
        self, tick: int, births: list[dict], deaths: list[dict], occupant: dict[int, RecordedLife]
    ) -> None:
        before = dict(occupant)
        for row in deaths:
            life = occupant.pop(row["cell"])
            assert row["id"] == life.number + self.start[1]
            assert life.born < tick
            life.died, life.cause = tick, row["cause"]
            life.energy, life.food = float(row["energy"]), float(row["food"])
        founders = not occupant and bool(births) and all(math.isnan(r["parent"]) for r in births)
        if founders:
            fill = self.lived.config.genesis == "fill"
            assert len(births) == (self.cells if fill else 1)
            if tick > self.start[0]:
                self.extinctions.append(tick)
        else:
            parents = [row["parent"] for row in births]
            assert len(set(parents)) == len(parents), "two children of one parent in one tick"
        for row in births:
            assert row["id"] == len(self.lives) + self.start[1]
            assert row["cell"] not in occupant, "two organisms in one cell"
            parent = None if founders else self._parent(row, tick, before)
            origin = row["cause"]
            assert founders <= (origin == "founder")
            life = RecordedLife(len(self.lives), parent, tick, int(row["cell"]), origin)
            occupant[life.cell] = life
            self.lives.append(life)
        born_in = {row["cell"] for row in births}
        if self.lived.config.placement.rule != "replacing":
            assert founders or not born_in & set(before), "a child on an occupied cell"
        for row in deaths:
            if row["cause"] == "replaced":
                assert self.lived.config.placement.rule == "replacing"
                assert row["cell"] in born_in
        assert occupant, "a world without life"

    def _parent(self, row: dict, tick: int, before: dict[int, RecordedLife]) -> RecordedLife:
        parent = self.lives[int(row["parent"]) - self.start[1]]
        assert before.get(parent.cell) is parent, "a parent that was not alive"
        assert parent.died is None or (parent.died == tick and parent.cause == "replaced")
        assert row["cell"] in reach(
            self.lived.config.placement.topology, parent.cell, self.cells
        ), "a child out of reach"
        assert (row["cause"] == "founder") == (self.lived.config.inheritance == "founder")
        return parent

    def _assert_state_agrees(self, occupant: dict[int, RecordedLife]) -> None:
        organisms = self.lived.engine.state.world.organisms
        own = slice(self.world * self.cells, (self.world + 1) * self.cells)
        assert np.flatnonzero(organisms.alive[own]).tolist() == sorted(occupant)
        number, born = (
            to_host(w.map(lambda x: x[own])) for w in (organisms.number, organisms.born)
        )
        for cell, life in occupant.items():
            assert number[cell] == life.number + self.start[1]
            assert born[cell] == life.born
        deaths = Counter(life.cause for life in self.lives if life.died is not None)
        named = {cause: cause.name.lower().replace("_", "-") for cause in Cause}
        assert self._worlds("deaths").tolist() == [deaths[named[cause]] for cause in Cause]
        assert self._worlds("births") == len(self.lives) + self.start[1]
        assert len(self.lives) - deaths.total() == len(occupant)
        assert self._worlds("extinctions") == len(self.extinctions)
        assert self._worlds("organism_ticks") == self.organism_ticks

    @property
    def organism_ticks(self) -> int:
        """Ticks lived by all organisms together."""
        ends = (self.now if life.died is None else life.died for life in self.lives)
        return sum(end - life.born for end, life in zip(ends, self.lives, strict=True))

    @property
    def dead(self) -> list[RecordedLife]:
        """The lives that ended, in order of birth."""
        return [life for life in self.lives if life.died is not None]

    def fixation(self) -> tuple[int, int] | None:
        """Return when the living first shared an ancestor that had a parent, and the births until then.

        The search starts again after an extinction.
        """
        lines: dict[int, frozenset[int]] = {}
        fixed = None
        for tick, living in self.living_after.items():
            for life in living:
                if life.parent is None:
                    lines[life.number] = frozenset()
                elif life.number not in lines:
                    lines[life.number] = lines[life.parent.number] | {life.number}
            if tick in self.extinctions:
                fixed = None
            common = frozenset.intersection(*(lines[life.number] for life in living))
            if common and fixed is None:
                fixed = tick, self.births_until(tick)
        return fixed

    def saturation(self) -> tuple[int, int] | None:
        """Return when the world was first full and calm for long enough, and the births until then."""
        for tick in self._calm():
            if len(self.living_after[tick]) == self.cells:
                return tick + self.lived.config.saturation_ticks, self.births_until(tick)
        return None

    def calm_but_not_full(self) -> bool:
        """Return whether the world was calm for long enough before that, with empty cells."""
        first = next(self._calm(), None)
        return first is not None and len(self.living_after[first]) < self.cells

    def _calm(self) -> Iterator[int]:
        """Yield the ticks with an event that are followed by no event for long enough."""
        for tick, following in pairwise([*self.living_after, self.now + 1]):
            if following > tick + self.lived.config.saturation_ticks:
                yield tick

    def births_until(self, tick: int) -> int:
        """Return the number of births up to the end of a tick."""
        return self.start[1] + sum(life.born <= tick for life in self.lives)
