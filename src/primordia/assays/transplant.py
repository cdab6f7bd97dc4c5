"""Reciprocal transplants: natives of each island live again on every island, beside founders.

Kawecki & Ebert 2004 ("Conceptual issues in local adaptation", Ecol. Lett. 7): a population is adapted
to its home if natives live longer there than organisms from elsewhere do (local against foreign). That
natives live longer at home than away can also mean that home is an easy place.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from primordia.assays.subjects import GAMES, TICKS
from primordia.errors import InputError
from primordia.history.series import mean_of_known, plain, spaced
from primordia.organism.playing.games import Players, lifespans_in_games
from primordia.organism.playing.players import founders_of, moved, players_of
from primordia.progress import steps
from primordia.runs.lives import LATE
from primordia.runs.records import Records

EACH = 20
"""Default number of natives of each island of a world, and of founders."""
FOUNDERS = "founders"


@dataclass(frozen=True)
class Transplant:
    """The lives of natives of each island, and of founders, on each of the K islands of one world."""

    world: int
    islands: tuple[str, ...]
    natives: tuple[int, ...]
    """number of natives of each island that lived again, (K,)"""
    lived: np.ndarray
    """mean ticks, float64 (K + 1, K): by island of birth, founders last, and by the island on which they
    lived; NaN for islands on which nothing was born late"""

    @property
    def home_away(self) -> np.ndarray:
        """Natives' life at home, as a multiple of their mean life on other islands, (K,)."""
        return np.diag(self.lived) / self._of_others(axis=1)

    @property
    def local_foreign(self) -> np.ndarray:
        """Natives' life at home, as a multiple of the mean life there of other islands' natives, (K,)."""
        return np.diag(self.lived) / self._of_others(axis=0)

    def _of_others(self, axis: int) -> np.ndarray:
        """Return the means of natives' lives without those at home, along an axis, (K,)."""
        others = self.lived[:-1].copy()
        np.fill_diagonal(others, np.nan)
        return mean_of_known(others, axis)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "world": self.world,
            "islands": list(self.islands),
            "natives": list(self.natives),
            "lived": plain(self.lived),
            "home_away": plain(self.home_away),
            "local_foreign": plain(self.local_foreign),
        }


def transplant(
    run: Records,
    each: int = EACH,
    after: float = LATE,
    games: int = GAMES,
    ticks: int = TICKS,
) -> list[Transplant]:
    """Let late-born natives of each island, and founders, live again on every island of their world.

    Args:
        run: the run, or an arm.
        each: largest number of natives of an island of a world, evenly spaced over its late births; also
            the number of founders.
        after: a birth is late if it comes after this share of its world's births.
        games: number of games of each organism on each island; 1 if nothing there is random.
        ticks: number of ticks after which a game is cut.

    Raises:
        InputError: the run has no islands, or nothing was born.
    """
    islands = islands_of(run)
    lives, late = run.lives, born_late(run, after)
    native = islands.of_cells(lives.cell[late])
    found = []
    for world in np.unique(lives.world[late]).tolist():
        of_world = lives.world[late] == world
        rows = [spaced(late[of_world & (native == k)], each) for k in range(islands.count)]
        own = everywhere(run, players_of(run, np.concatenate(rows)), world, games, ticks)
        _, _, fresh = founders_of(run, np.array([world]), np.array([each]))
        groups = np.split(own, np.cumsum([len(some) for some in rows])[:-1])
        groups.append(everywhere(run, fresh, world, games, ticks))
        none = np.full(islands.count, np.nan)
        lived = np.stack([some.mean(axis=0) if len(some) else none for some in groups])
        counts = tuple(len(some) for some in rows)
        found.append(Transplant(world, islands.names, counts, lived))
    return found


def islands_of(run: Records) -> Any:
    """Return the islands of a run's worlds.

    Raises:
        InputError: the run has no islands.
    """
    islands = run.config.islands
    if islands.count == 1:
        raise InputError(f"{run.path}: its worlds have no islands; see [[habitat.islands]]")
    return islands


def born_late(run: Records, after: float) -> np.ndarray:
    """Return the rows of organisms born after this share of their world's births, int64 (n,).

    Raises:
        InputError: nothing was born.
    """
    if not len(late := np.flatnonzero(run.lives.late(after))):
        raise InputError(f"{run.path}: nothing has been born since the fork")
    return late


def everywhere(run: Records, players: Players, world: int, games: int, ticks: int) -> np.ndarray:
    """Return the mean ticks that organisms of a world live on each island, float64 (n, K).

    Each island has the settings that it has at the end of the records.
    """
    number, worlds = 1 if players.deterministic else games, np.full(len(players.genomes), world)
    lived = np.zeros((len(worlds), run.config.islands.count))
    for k in steps(range(lived.shape[1]), "living on each island"):
        here = moved(run, players, worlds, k)
        lived[:, k] = lifespans_in_games(here, number, ticks).mean(axis=1)
    return lived
