"""The islands of a run's worlds in numbers, and the organisms that were born on an island.

An organism lives where it was born. An analysis of one island takes the organisms that were born on it,
wherever their parents lived.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from primordia.errors import InputError
from primordia.runs.lives import LATE, Lives
from primordia.runs.records import Records
from primordia.settings.islands import Islands
from primordia.settings.tables import did_you_mean


@dataclass(frozen=True)
class OnIsland:
    """The numbers of one island of one world. In a fork, births are those since the fork."""

    world: int
    name: str
    cells: int
    living: int
    births: int
    """number of organisms born on it, founders included"""
    immigrants: int
    """number of these whose parent lived on another island"""
    mean_age: float | None
    """mean age of the living, ticks; None if nothing lives there"""
    median_lifespan: float | None
    """median lifespan of the dead that were born late, ticks; None if there are none; see `Lives.late`"""

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return asdict(self)


def on_islands(run: Records) -> list[OnIsland]:
    """Return the numbers of each island, world by world; [] if the worlds have no islands.

    Args:
        run: the run, or an arm.
    """
    islands, count = run.config.islands, run.config.islands.count
    if count == 1:
        return []
    lives, places = run.lives, run.config.seeds * count
    island = islands.of_cells(lives.cell).astype(np.int64)
    place = lives.world * count + island

    def number(rows: np.ndarray) -> np.ndarray:
        return np.bincount(place[rows], minlength=places)

    alive, own = ~lives.died, ~lives.inherited
    living, births = number(alive), number(own)
    immigrants = number(own & migrants(lives.parent_row, island))
    ages = np.bincount(place[alive], lives.lifespan[alive], minlength=places)
    lifespans = _medians(place, lives, places)
    return [
        OnIsland(
            world=each // count,
            name=islands.names[each % count],
            cells=islands.sizes[each % count],
            living=int(living[each]),
            births=int(births[each]),
            immigrants=int(immigrants[each]),
            mean_age=float(ages[each] / living[each]) if living[each] else None,
            median_lifespan=lifespans[each],
        )
        for each in range(places)
    ]


def _medians(place: np.ndarray, lives: Lives, places: int) -> list[float | None]:
    """Return the median lifespan of the late-born dead in each place; None if there are none."""
    rows = np.flatnonzero(lives.late() & lives.died)
    rows = rows[np.argsort(place[rows], kind="stable")]
    edges = np.searchsorted(place[rows], np.arange(1, places))
    each = np.split(lives.lifespan[rows], edges)
    return [float(np.median(spans)) if len(spans) else None for spans in each]


def migrants(parent_row: np.ndarray, island: np.ndarray) -> np.ndarray:
    """Return which organisms were born on another island than their parent, bool (L,).

    Args:
        parent_row: row of each parent, or -1, int64 (L,).
        island: number of each organism's island, int (L,).
    """
    return (parent_row >= 0) & (island[parent_row] != island)


def born_on(run: Records, island: str | None) -> np.ndarray:
    """Return which organisms of a run were born on an island, bool (L,); None: all of them.

    Raises:
        InputError: the worlds have no such island.
    """
    lives = run.lives
    if island is None:
        return np.ones(len(lives), bool)
    return run.config.islands.of_cells(lives.cell) == number_of(run.config.islands, island)


def number_of(islands: Islands, name: str, flag: str = "--island") -> int:
    """Return the number of an island.

    Args:
        islands: the islands of a world.
        name: the island's name.
        flag: where the name was given, for the error.

    Raises:
        InputError: there is no such island.
    """
    if islands.count == 1:
        raise InputError(
            f"{flag} {name}: there is no island {name!r}; the worlds of this run have no islands"
        )
    if name not in islands.names:
        known = f"known: {', '.join(islands.names)}{did_you_mean(name, list(islands.names))}"
        raise InputError(f"{flag} {name}: there is no island {name!r}; {known}")
    return islands.names.index(name)


def names_of(islands: Islands, cells: np.ndarray) -> list[str] | None:
    """Return the name of the island of each cell; None if the world has no islands."""
    if islands.count == 1:
        return None
    return [islands.names[number] for number in islands.of_cells(cells).tolist()]


def oldest(
    run: Records, world: int | None = None, after: float = LATE, island: str | None = None
) -> int:
    """Return the row of the longest late life, or of that among the natives of an island; see
    `Lives.oldest`."""
    if island is None:
        return run.lives.oldest(world, after)
    return run.lives.oldest(world, after, born_on(run, island))


def champions(run: Records, island: str | None = None) -> np.ndarray:
    """Return the row of each world's champion, or of that of an island; see `Lives.champions`."""
    if island is None:
        return run.lives.champions()
    return run.lives.champions(born_on(run, island))


def late_born(run: Records, after: float = LATE, island: str | None = None) -> np.ndarray:
    """Return the rows of the late-born, or of those that were born on an island, int64.

    A birth is late among all births of its world; see `Lives.late`.
    """
    return np.flatnonzero(run.lives.late(after) & born_on(run, island))
