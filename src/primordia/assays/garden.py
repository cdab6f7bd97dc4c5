"""The common garden: oldest organisms, other organisms and founders live with fresh random keys.

The oldest organisms were also lucky. When the same genomes live again with fresh keys, their new
lifespans show how good the genomes are.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from primordia.assays.subjects import GAMES, TICKS, Subjects, of_run
from primordia.errors import InputError
from primordia.history.islands import late_born
from primordia.history.series import spaced
from primordia.organism.playing.games import lifespans_in_games
from primordia.organism.playing.players import founders_of
from primordia.runs.lives import LATE
from primordia.runs.records import Records

EACH = 20
"""Default number of organisms in each group of a world."""


@dataclass(frozen=True)
class Bed:
    """K organisms of one group in one world, born again."""

    group: str
    world: int
    organism: np.ndarray
    """birth numbers, int64 (K,); fresh founders have no record and are numbered from 0"""
    recorded: np.ndarray | None
    """ticks that each organism has lived in its world so far, int64 (K,)"""
    reborn: np.ndarray
    """mean ticks that each organism lived in its games, float64 (K,)"""

    @property
    def kept(self) -> float | None:
        """Mean life in the games, as a share of the mean recorded life; None if no life was recorded."""
        if self.recorded is None or not self.recorded.any():
            return None
        return float(self.reborn.mean() / self.recorded.mean())

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "group": self.group,
            "world": self.world,
            "organism": self.organism.tolist(),
            "recorded": None if self.recorded is None else self.recorded.tolist(),
            "reborn": self.reborn.tolist(),
            "kept": self.kept,
        }


def garden(
    run: Records,
    each: int = EACH,
    after: float = LATE,
    games: int = GAMES,
    ticks: int = TICKS,
    habitat: Mapping[str, Any] | None = None,
    island: str | None = None,
) -> list[Bed]:
    """Let the oldest organisms, other late-born organisms and founders of each world play fresh games.

    Args:
        run: the run, or an arm.
        each: largest number of organisms in each group of a world. The oldest are chosen among the
            late-born. The other late-born organisms are evenly spaced over the late births, without
            the world's last birth.
        after: a birth is late if it comes after this share of its world's births.
        games: number of games of each organism; 1 if the habitat draws nothing at random.
        ticks: number of ticks after which a game is cut.
        habitat: changed settings of the habitat.
        island: name of an island: all groups are born on it; by default on all islands.

    Raises:
        InputError: nothing was born, or the habitat has no such setting, or there is no such island.
    """
    lives, late = run.lives, late_born(run, after, island)
    if island is not None and not len(late):
        raise InputError(
            f"--island {island}: {run.path}: nothing has been born late on this island"
        )
    found, worlds = [], np.unique(lives.world[late])
    groups = {"oldest": _oldest, "late-born": _spaced}
    for group, choose in groups.items():
        rows = [choose(late[lives.world[late] == w], lives.lifespan, each) for w in worlds]
        chosen = np.concatenate(rows) if rows else late
        numbers = list(zip(lives.id[chosen].tolist(), lives.world[chosen].tolist(), strict=True))
        subjects = of_run(run, numbers, habitat)
        found += _beds(group, subjects, lives.lifespan[chosen], games, ticks)
    world, number, players = founders_of(run, worlds, np.full(len(worlds), each), island)
    players = players._replace(habitat=subjects.players.habitat)
    fresh = subjects._replace(players=players, organism=number, world=world)
    return found + _beds("founders", fresh, None, games, ticks)


def _beds(
    group: str, subjects: Subjects, recorded: np.ndarray | None, games: int, ticks: int
) -> list[Bed]:
    lived = lifespans_in_games(subjects.players, subjects.games(games), ticks).mean(axis=1)
    places = ((int(w), subjects.world == w) for w in np.unique(subjects.world))
    return [
        Bed(
            group,
            world,
            subjects.organism[here],
            None if recorded is None else recorded[here],
            lived[here],
        )
        for world, here in places
    ]


def _oldest(rows: np.ndarray, lifespan: np.ndarray, count: int) -> np.ndarray:
    """Return the rows of the longest-lived; among equals the last-born come first, as with champions."""
    return rows[np.argsort(lifespan[rows], kind="stable")[::-1][:count]]


def _spaced(rows: np.ndarray, lifespan: np.ndarray, count: int) -> np.ndarray:
    """Return rows in the middle of equal parts of the births, without the last; see `shadow`."""
    return spaced(rows[:-1] if len(rows) > 1 else rows, count)
