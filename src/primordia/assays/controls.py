"""Evaluation of champions and of controls: all living, best of many founders, and some founders.

A champion is the longest-lived of many, by luck as well as by descent. So the control is chosen in
the same way: as many founders as the world had births, up to a limit, live once each, and the
longest-lived of these founders is judged. No organism is judged by the game in which it was chosen,
unless all games of the task are the same.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from primordia.errors import InputError
from primordia.history.islands import born_on, champions, oldest
from primordia.organism.playing.evaluation import (
    GAMES,
    TICKS,
    Evaluation,
    Senses,
    judged,
    on_island,
)
from primordia.organism.playing.games import Players, lifespans
from primordia.organism.playing.players import evaluation_keys, founders_of, players_of
from primordia.runs.records import Records

FOUNDERS = 500
"""Default limit: in each world, the best founder is chosen among at most this number of founders."""
TYPICAL = 20
"""Number of unselected founders of each world that are judged."""
OUTCOMES = ("lifespan", "score", "length")
QUARTILES = ("median", "q1", "q3")
"""Names of a result's values: the median over worlds, and the quartiles."""


@dataclass(frozen=True)
class Standing:
    """The results of a group of organisms."""

    name: str
    chosen_from: int
    """largest number of candidates in a world, of which one was chosen; 1 if there was no choice"""
    evaluations: list[Evaluation]

    def by_world(self, outcome: str) -> dict[int, float]:
        """Return an outcome's value for each world, by the world's number. It is the median over
        organisms of their medians over games. The dict is empty if there is no such outcome.

        Args:
            outcome: `lifespan`, or `score` or `length` of the whole game.
        """
        medians: dict[int, list[float]] = {}
        for each in self.evaluations:
            if (spread := each.to_dict().get(outcome)) is None:
                return {}
            medians.setdefault(each.world, []).append(spread["median"])
        return {world: float(np.median(values)) for world, values in sorted(medians.items())}

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        values = {name: list(self.by_world(name).values()) for name in OUTCOMES}
        spreads = {
            name: dict(zip(QUARTILES, np.percentile(own, (50, 25, 75)).tolist(), strict=True))
            for name, own in values.items()
            if own
        }
        return {
            "who": self.name,
            "chosen_from": self.chosen_from,
            "organisms": len(self.evaluations),
            "worlds": len({each.world for each in self.evaluations}),
            "games": self.evaluations[0].games,
            **spreads,
        }


@dataclass(frozen=True)
class Group:
    """Organisms of some worlds of a run, all chosen in the same way."""

    run: Records
    name: str
    chosen_from: int
    """see `Standing`"""
    numbers: list[tuple[int, int]]
    """birth number (for founders: number among the founders) and world of each organism"""
    players: Players

    def evaluate(
        self,
        games: int = GAMES,
        ticks: int = TICKS,
        senses: Senses = "live",
        habitat: Mapping[str, Any] | None = None,
        on: str | None = None,
    ) -> Standing:
        """Let each organism play; organisms that were not chosen play one game. See
        `evaluation.evaluate`."""
        each = games if self.chosen_from > 1 else min(games, 1)
        evaluations = judged(
            self.run.config,
            self.players,
            self.numbers,
            games=each,
            ticks=ticks,
            senses=senses,
            habitat=habitat or {},
            there=on_island(self.run, self.players, [world for _, world in self.numbers], on),
        )
        return Standing(self.name, self.chosen_from, evaluations)


def evolved(run: Records, world: int | None = None, island: str | None = None) -> list[Group]:
    """Return the champions of a run or an arm, and all living organisms if there are any.

    Args:
        run: the run, or the arm.
        world: a single world to take; by default all worlds in which anything was born since the
            run began.
        island: name of an island; only organisms that were born on it are taken.

    Raises:
        InputError: nothing was born there, or there is no such island.
    """
    lives, champions, native = run.lives, _champions(run, world, island), born_on(run, island)
    alive = np.flatnonzero(~lives.died & native & np.isin(lives.world, lives.world[champions]))
    most = int(_births(run, lives.world[champions], native).max())
    rows = np.concatenate([champions, alive])
    numbers = list(zip(lives.id[rows].tolist(), lives.world[rows].tolist(), strict=True))
    players = players_of(run, rows)  # at once, since they have most of their ancestors in common
    best, others = slice(0, len(champions)), slice(len(champions), None)
    found = [Group(run, "champion", most, numbers[best], players.take(best))]
    if len(alive):
        found.append(Group(run, "all alive", 1, numbers[others], players.take(others)))
    return found


def unevolved(
    run: Records,
    most: int | None = FOUNDERS,
    world: int | None = None,
    island: str | None = None,
) -> list[Group]:
    """Return for each world the longest-lived of a number of founders, and some unselected
    founders.

    Each founder lives once, up to `saturation_ticks`, so that the best can be chosen. Among equals
    the last is chosen, as with champions.

    Args:
        run: the run, or the arm.
        most: largest number of founders in each world among which the best is chosen; None: as many
            as the world had births, or as were born on the island.
        world: as for `evolved`.
        island: name of an island on which all founders live; by default they are spread over all cells.

    Raises:
        InputError: nothing was born there, or `most` is below one.
    """
    if most is not None and most < 1:
        raise InputError("evaluate needs at least one founder to choose from")
    worlds = run.lives.world[_champions(run, world, island)]
    births = _births(run, worlds, born_on(run, island))
    return _founders(run, worlds, births if most is None else np.minimum(births, most), island)


def _champions(run: Records, world: int | None, island: str | None) -> np.ndarray:
    """Return the row of the champion of one world, or of each world."""
    if world is not None:
        return np.array([oldest(run, world, island=island)])
    rows = champions(run, island)
    if not len(rows):
        when = "since the fork" if island is None else f"late on the island {island}"
        raise InputError(f"{run.path}: nothing has been born {when}")
    return rows


def _births(run: Records, worlds: np.ndarray, native: np.ndarray) -> np.ndarray:
    """Return the number of births in each of these worlds since the run began, of `native` (L,) alone."""
    lives = run.lives
    return np.bincount(lives.world[~lives.inherited & native], minlength=lives.worlds)[worlds]


def _founders(
    run: Records, worlds: np.ndarray, counts: np.ndarray, island: str | None
) -> list[Group]:
    """Return for each of these worlds the longest-lived of `counts` founders, and some unselected
    ones."""
    world, number, everyone = founders_of(run, worlds, counts, island)
    lived = lifespans(everyone, run.config.saturation_ticks)
    places = [np.flatnonzero(world == each) for each in worlds]
    longest = [here[len(here) - 1 - np.argmax(lived[here][::-1])] for here in places]
    keys = evaluation_keys(run, world, number)

    def group(name: str, chosen_from: int, rows: np.ndarray) -> Group:
        numbers = list(zip(number[rows].tolist(), world[rows].tolist(), strict=True))
        return Group(run, name, chosen_from, numbers, everyone._replace(keys=keys).take(rows))

    return [
        group("best founder", int(counts.max()), np.array(longest)),
        group("founder", 1, np.flatnonzero(number < TYPICAL)),
    ]
