"""Generalists: organisms that live long on several islands, and how a line became one.

An organism *masters* an island if it lives there longer than the best of as many founders. The most
general organism was also lucky in the games in which it was chosen, so its line lives in fresh ones.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from primordia.assays.subjects import GAMES, TICKS
from primordia.assays.transplant import born_late, everywhere, islands_of
from primordia.history import series
from primordia.history.rebuilding import descent
from primordia.history.series import plain, spaced
from primordia.law.world import BirthCause
from primordia.organism.playing.players import founders_of, players_of
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.lives import LATE
from primordia.runs.records import Records

EACH = 40
"""Default number of late organisms of each world, and of founders."""
MOST = 40
"""Default number of ancestors of a line that live again."""


@dataclass(frozen=True)
class Ancestor:
    """One organism on the line of the most general organism of a world."""

    generation: int
    organism: int
    born: int
    """tick of birth"""
    birth_cause: str
    island: str
    """island of birth"""
    lived: tuple[float, ...]
    """mean ticks lived on each island"""
    mastered: tuple[str, ...]
    """islands on which it lives longer than the best of as many founders"""


@dataclass(frozen=True)
class Generalists:
    """The n late organisms of one world on each of its K islands."""

    world: int
    islands: tuple[str, ...]
    organism: np.ndarray
    """birth numbers, int64 (n,)"""
    home: np.ndarray
    """number of the island of birth, int (n,)"""
    lived: np.ndarray
    """mean ticks that they live on each island, float64 (n, K)"""
    best_founder: np.ndarray
    """mean ticks of the best of n founders on each island, float64 (K,)"""
    line: tuple[Ancestor, ...]
    """ancestors of the most general organism, oldest first, and itself"""

    @property
    def mastered(self) -> np.ndarray:
        """Number of islands that each organism masters, int (n,)."""
        return (self.lived > self.best_founder).sum(axis=1)

    @property
    def shares(self) -> np.ndarray:
        """Share of the organisms that master 0, 1, ... K islands, float64 (K + 1,)."""
        return np.bincount(self.mastered, minlength=len(self.islands) + 1) / len(self.organism)

    @property
    def gains(self) -> list[tuple[Ancestor, str]]:
        """The ancestors from which on the line masters an island for good, and that island."""
        found = []
        for island in self.islands:
            has = [island in each.mastered for each in self.line]
            if has[-1]:
                last_without = max(
                    (k for k, mastered in enumerate(has) if not mastered), default=-1
                )
                found.append((self.line[last_without + 1], island))
        return sorted(found, key=lambda pair: pair[0].generation)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "world": self.world,
            "islands": list(self.islands),
            "organism": self.organism.tolist(),
            "home": [self.islands[k] for k in self.home],
            "lived": plain(self.lived),
            "best_founder": plain(self.best_founder),
            "mastered": self.mastered.tolist(),
            "shares": self.shares.tolist(),
            "line": [asdict(each) for each in self.line],
            "gains": {island: each.organism for each, island in self.gains},
        }


def generalists(
    run: Records,
    each: int = EACH,
    after: float = LATE,
    games: int = GAMES,
    ticks: int = TICKS,
    most: int = MOST,
) -> list[Generalists]:
    """Let late organisms live again on every island, and then the ancestors of the most general one.

    Args:
        run: the run, or an arm.
        each: largest number of organisms of a world, evenly spaced over its late births; also the number
            of founders.
        after: a birth is late if it comes after this share of its world's births.
        games: number of games of each organism on each island; 1 if nothing there is random.
        ticks: number of ticks after which a game is cut.
        most: largest number of ancestors that live again, evenly spaced over the line.

    Raises:
        InputError: the run has no islands, or nothing was born.
    """
    islands = islands_of(run)
    lives, late = run.lives, born_late(run, after)
    found = []
    for world in np.unique(lives.world[late]).tolist():
        rows = late[lives.world[late] == world]
        rows = spaced(rows[:-1] if len(rows) > 1 else rows, each)
        lived = everywhere(run, players_of(run, rows), world, games, ticks)
        _, _, fresh = founders_of(run, np.array([world]), np.array([len(rows)]))
        best = everywhere(run, fresh, world, games, ticks).max(axis=0)
        ratio = lived / best
        order = np.lexsort((ratio.min(axis=1), (lived > best).sum(axis=1)))
        line = _line(run, int(rows[order[-1]]), best, (games, ticks, most))
        home = islands.of_cells(lives.cell[rows])
        own = islands.names, lives.id[rows], home, lived, best, line
        found.append(Generalists(world, *own))
    return found


def _line(
    run: Records, row: int, best: np.ndarray, manner: tuple[int, int, int]
) -> tuple[Ancestor, ...]:
    """Return the ancestors of an organism; `manner` holds games, ticks and the number of ancestors.

    All of them play the same games, other ones than those in which the organism was chosen.
    """
    games, ticks, most = manner
    world, islands = int(run.lives.world[row]), run.config.islands
    line = descent(run.lives, int(run.lives.id[row]), world)
    places = series.places(len(line), most)
    chosen = run.lives.take(line[places])
    players = players_of(run, line[places])
    fresh = stream(wide(run.world_seeds[[world]]), Purpose.REBIRTH, wide(run.lives.id[[row]]))
    keys = fresh.take(np.zeros(len(places), np.intp))
    lived = everywhere(run, players._replace(keys=keys), world, games, ticks)
    return tuple(
        Ancestor(
            generation=int(places[k]),
            organism=int(chosen.id[k]),
            born=int(chosen.born[k]),
            birth_cause=BirthCause(chosen.birth_cause[k]).label,
            island=islands.names[int(islands.of_cells(chosen.cell[k]))],
            lived=tuple(lived[k].tolist()),
            mastered=tuple(
                name
                for name, own, of in zip(islands.names, lived[k], best, strict=True)
                if own > of
            ),
        )
        for k in range(len(places))
    )
