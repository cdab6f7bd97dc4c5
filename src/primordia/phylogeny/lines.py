"""Evolution of one world measured in lines: their shares over time, beside the shares under drift."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from primordia.history.islands import migrants, names_of
from primordia.history.series import plain
from primordia.phylogeny import coalescence, slopes
from primordia.phylogeny.coalescence import Genealogy, Times
from primordia.phylogeny.diversity import hill_numbers, phylogenetic_diversity
from primordia.phylogeny.drift import Drift, drift
from primordia.phylogeny.frequencies import founders, founding_tick, instants
from primordia.phylogeny.living import Census, Turnover, branches, last_era
from primordia.phylogeny.sweeps import Sweep, sweeps
from primordia.runs.lives import Lives
from primordia.runs.records import Records
from primordia.settings.islands import Islands

BAND = (2.5, 97.5)
"""95 % of the shadows lie between these percentiles."""


@dataclass(frozen=True)
class WorldLines:
    """K lines of one world at T instants, and further measures of the world's evolution."""

    world: int
    lives: Lives
    """all lives of the world"""
    founders: np.ndarray
    """rows of the organisms that founded the lines, int64 (K,)"""
    ticks: np.ndarray
    """instants at which lines were counted, int64 (T,); at the first they were founded"""
    counts: np.ndarray
    """number of living in each line, int64 (T, K)"""
    living: np.ndarray
    """all living, int64 (T,)"""
    slopes: np.ndarray
    """selection coefficient of each line per tick, float64 (K,); NaN where it cannot be measured"""
    shadow_slopes: dict[int, np.ndarray]
    """for each line with a slope, by its place: the sorted slopes of its shadows, float64"""
    drift: Drift
    """the course of all lines when they drift together"""
    sweeps: list[Sweep]
    diversity: np.ndarray
    """phylogenetic diversity of the living at the instants, in ticks, int64 (T,)"""
    pairs: Times
    """coalescence times of the living"""
    neutral_pairs: Times
    """coalescence times that drift alone would give"""
    islands: list[str] | None = None
    """name of the island of each line's founder, [K]; None if the world has no islands"""
    migrations: np.ndarray | None = None
    """number of births in each line on another island than the parent's, since the lines were founded,
    int64 (K,); None if the world has no islands"""

    @property
    def shares(self) -> np.ndarray:
        """Share of each line in the living, float64 (T, K); 0 in an empty world."""
        return self.counts / np.maximum(self.living, 1)[:, None]

    @cached_property
    def effective(self) -> np.ndarray:
        """Effective numbers of lines of orders 0, 1 and 2, float64 (3, T)."""
        return hill_numbers(self.counts)

    @cached_property
    def lifespan(self) -> float | None:
        """Ticks lived since the lines were founded, divided by the deaths; None without a death."""
        late = self.lives.ended > self.ticks[0]
        deaths = int((self.lives.died & late).sum())
        lived = (self.lives.ended - np.maximum(self.lives.born, self.ticks[0]))[late].sum()
        return float(lived / deaths) if deaths else None

    @cached_property
    def p_of_slopes(self) -> np.ndarray:
        """Two-sided p value of each slope among its shadows' slopes, float64 (K,); NaN without a
        slope."""
        p = np.full(len(self.founders), np.nan)
        for place, null in self.shadow_slopes.items():
            p[place] = two_sided(self.slopes[place], null)
        return p

    @cached_property
    def p_of_finals(self) -> np.ndarray:
        """Two-sided p value of each final share among the final shares of all shadows, float64 (K,)."""
        return two_sided(self.shares[-1], np.sort(self.drift.final, axis=None))

    @cached_property
    def p_of_effective(self) -> float:
        """Two-sided p value of the mean, over instants, of the effective number of lines (order 2)."""
        null = np.sort(self.drift.effective.mean(axis=1))
        return float(two_sided(self.effective[2].mean(), null))

    @property
    def ranked(self) -> np.ndarray:
        """Places of the lines by their largest share at any instant, largest first, int64 (K,)."""
        return np.argsort(-self.shares.max(axis=0), kind="stable")

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        bands = {
            "largest_share": np.percentile(self.drift.largest, BAND, axis=0),
            "effective_lines": np.percentile(self.drift.effective, BAND, axis=0),
        }
        return {
            "world": self.world,
            "founded": int(self.ticks[0]),
            "lifespan": self.lifespan,
            "shadows": len(self.drift.final),
            "p_of_effective_lines": self.p_of_effective,
            "ticks": self.ticks.tolist(),
            "living": self.living.tolist(),
            "effective_lines": dict(zip("012", self.effective.tolist(), strict=True)),
            "phylogenetic_diversity": self.diversity.tolist(),
            "bands": {name: band.tolist() for name, band in bands.items()},
            "lines": [self._line(place) for place in self.ranked.tolist()],
            "sweeps": [each.to_dict() for each in self.sweeps],
            "coalescence": _pairs(self.pairs),
            "neutral_coalescence": _pairs(self.neutral_pairs),
        }

    def _line(self, place: int) -> dict[str, Any]:
        founder, slope = self.founders[place], plain(self.slopes[place])
        null = self.shadow_slopes.get(place)
        return {
            "organism": int(self.lives.id[founder]),
            "born": int(self.lives.born[founder]),
            "slope": slope,
            "slope_per_lifespan": slope and self.lifespan and slope * self.lifespan,
            "neutral_slopes": None if null is None else np.percentile(null, BAND).tolist(),
            "p_of_slope": plain(self.p_of_slopes[place]),
            "largest_share": float(self.shares[:, place].max()),
            "final_share": float(self.shares[-1, place]),
            "p_of_final_share": float(self.p_of_finals[place]),
            "living": self.counts[:, place].tolist(),
            **({} if self.islands is None else {"island": self.islands[place]}),
            **({} if self.migrations is None else {"migrations": int(self.migrations[place])}),
        }


def lines(run: Records, world: int | None = None, at: int | None = None) -> list[WorldLines]:
    """Measure lines in one world of a run, or in all worlds.

    Args:
        run: the run, or an arm.
        world: number of the world; by default all.
        at: tick after which each of the living begins a line; by default see `founding_tick`.

    Raises:
        InputError: there is no such world, or nothing is alive after the tick.
    """
    if world is not None:
        run.lives.check_world(world)
    seeds, islands = run.world_seeds.tolist(), run.config.islands
    worlds: Sequence[int] = range(run.lives.worlds) if world is None else [world]
    return [
        lines_of_world(each, run.lives.of_world(each), at, seeds[each], islands) for each in worlds
    ]


def lines_of_world(
    world: int, lives: Lives, at: int | None, seed: int, islands: Islands | None = None
) -> WorldLines:
    """Measure lines in the lives of one world with this seed; see `lines` for the other arguments."""
    turnover, era = Turnover.of(lives), last_era(lives)
    founded = founding_tick(lives) if at is None else at
    own = founders(lives, founded)
    census = Census(lives, instants(founded, int(lives.ended.max())))
    line = branches(lives.parent_row, own)
    counts = census.counts(line, len(own))
    measured = slopes.observed(counts, census.living, census.ticks)
    with_slope = np.flatnonzero(np.isfinite(measured))
    null = slopes.of_shadows(census, turnover, counts[:, with_slope], seed)
    return WorldLines(
        world=world,
        lives=lives,
        founders=own,
        ticks=census.ticks,
        counts=counts,
        living=census.living,
        slopes=measured,
        shadow_slopes={
            place: np.sort(of[np.isfinite(of)])
            for place, of in zip(with_slope.tolist(), null, strict=True)
        },
        drift=drift(lives, turnover, census.ticks, len(own), seed),
        sweeps=sweeps(era),
        diversity=phylogenetic_diversity(lives, census.ticks),
        pairs=coalescence.observed(Genealogy.of(lives)),
        neutral_pairs=coalescence.neutral(era, Turnover.of(era)),
        **({} if islands is None or islands.count == 1 else _places(lives, own, line, islands)),
    )


def _places(
    lives: Lives, founders: np.ndarray, line: np.ndarray, islands: Islands
) -> dict[str, Any]:
    """Return the islands of lines' founders, and the number of migrants in each line without them."""
    moved = migrants(lives.parent_row, islands.of_cells(lives.cell)) & (line >= 0)
    moved[founders] = False
    return {
        "islands": names_of(islands, lives.cell[founders]),
        "migrations": np.bincount(line[moved], minlength=len(founders)),
    }


def two_sided(values: np.ndarray, null: np.ndarray) -> np.ndarray:
    """Return the two-sided p value of each value among N values of the null hypothesis, float64.

    The p value is at most 1. It is twice the smaller of two shares: of values at least as large,
    and of values at least as small. Both include the value itself (Davison & Hinkley 1997, sec.
    4.2).

    Args:
        values: of any shape.
        null: values of the null hypothesis, in ascending order, (N,).
    """
    at_most = 1 + np.searchsorted(null, values, side="right")
    at_least = 1 + len(null) - np.searchsorted(null, values, side="left")
    return np.minimum(2 * np.minimum(at_most, at_least) / (1 + len(null)), 1.0)


def _pairs(times: Times) -> dict[str, Any]:
    return {
        "mean": times.mean,
        "median": times.median,
        "ticks_back": times.back.tolist(),
        "share": times.share.tolist(),
    }
