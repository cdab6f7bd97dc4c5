"""Selection coefficients of lines: the slopes of their logit shares, beside the slopes that drift makes.

Selection changes the logit of a line's share x, ln(x / (1 - x)), by the selection coefficient s in each
unit of time (Haldane 1924; Crow & Kimura 1970). So s is the slope of the logit over time, as it is
measured in competitions (Lenski et al. 1991).
"""

import jax
import numpy as np

from primordia.compiled import shared
from primordia.phylogeny.drift import Deal, deal_one_line
from primordia.phylogeny.living import Census, Turnover

LOW, HIGH = 0.05, 0.95
"""Smallest and largest share of the living at which the slope of a line is measured: outside this
range, chance is too strong."""
LEAST = 5
"""Smallest number of instants for a slope."""
MOST, FEWEST = 1000, 200
"""Largest and smallest number of shadows of a line."""
EVENTS = 2**15
"""Number of births and deaths after which lost lines are put aside."""


class Slopes:
    """The slopes of the logit shares of N lines, by weighted least squares, as instants are added.

    If m organisms are alive and the line's share is x, the weight of an instant is the product of
    m, x and 1 - x. It is the inverse of the variance of the logit of x.
    """

    def __init__(self, number: int) -> None:
        """Start without instants, with N = `number` lines."""
        self._sums = np.zeros((5, number))
        self._instants = np.zeros(number, np.int64)

    def add(self, tick: int, counts: np.ndarray, living: int) -> None:
        """Add an instant: how many of each line are alive, (N,), and how many organisms in all."""
        rows = np.flatnonzero(between(counts, living))
        count = counts[rows].astype(float)
        weight, logit = count * (living - count) / max(living, 1), np.log(count / (living - count))
        for place, term in enumerate((1, tick, tick * float(tick), logit, tick * logit)):
            self._sums[place, rows] += weight * term
        self._instants[rows] += 1

    @property
    def slopes(self) -> np.ndarray:
        """The slope of each line per tick, float64 (N,); NaN with too few instants (see LEAST)."""
        w, wt, wtt, wy, wty = self._sums
        spread = w * wtt - wt**2
        known = (self._instants >= LEAST) & (spread > 0)
        return np.where(known, (w * wty - wt * wy) / np.where(known, spread, 1), np.nan)


def between(counts: np.ndarray, living: int | np.ndarray) -> np.ndarray:
    """Return whether lines have shares between LOW and HIGH; `counts` and `living` are broadcast."""
    return (counts > 0) & (counts >= LOW * living) & (counts <= HIGH * living) & (counts < living)


def observed(counts: np.ndarray, living: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """Return the slopes of K lines, float64 (K,); NaN for a line without a slope.

    Args:
        counts: how many of each line are alive at T instants, int64 (T, K).
        living: all living at each instant, int64 (T,).
        ticks: the instants, int64 (T,).
    """
    slopes = Slopes(counts.shape[1])
    for tick, row, number in zip((ticks - ticks[0]).tolist(), counts, living.tolist(), strict=True):
        slopes.add(tick, row, number)
    return slopes.slopes


def of_shadows(census: Census, turnover: Turnover, counts: np.ndarray, seed: int) -> np.ndarray:
    """Return the slopes of M lines in R shadows, float64 (M, R); NaN for a shadow without a slope.

    The shadow of a line begins at the first instant at which the line's share is between LOW and
    HIGH. At this instant shadow and line have the same number of living. Then the shadow drifts.
    The line's past has no effect on later drift, so without selection the line's slope has
    the same distribution as the slopes of its shadows.

    Args:
        census: the living of one world at T instants.
        turnover: births and deaths of the world.
        counts: how many of each line are alive at each instant, int64 (T, M); the share of each
            line is between LOW and HIGH at some instant.
        seed: the world's seed.
    """
    lines = counts.shape[1]
    if not lines:
        return np.zeros((0, 0))
    deal = Deal.of(census.lives, turnover, census.ticks, seed, what=1)
    shadows = deal.replicates(lines, FEWEST, MOST)
    entries = between(counts, census.living[:, None]).argmax(axis=0)
    slopes, now = Slopes(lines * shadows), np.zeros(lines * shadows, np.int32)
    for place, begin, end, living in deal.parts:
        for first in range(begin, end, EVENTS):
            _drift_on(now, deal, first, min(first + EVENTS, end))
        new = np.flatnonzero(entries == place)
        now.reshape(lines, -1)[new] = counts[place, new][:, None]
        slopes.add(int(census.ticks[place] - census.ticks[0]), now, living)
    return slopes.slopes.reshape(lines, shadows)


def _drift_on(now: np.ndarray, deal: Deal, first: int, last: int) -> None:
    """Let the lines of shadows, int32 (N,), drift from one event to another, in place.

    Only lines that are neither lost nor all of the living can change. A line that is all of the
    living has no slope any more, so it is treated as lost.
    """
    now[now >= int(deal.before[first])] = 0
    rows = np.flatnonzero(now)
    if not len(rows):
        return
    size = 1 << max(int(len(rows) - 1).bit_length(), 8)  # few sizes, since JAX compiles for each
    padded = np.zeros((2, size), np.int32)
    padded[:, : len(rows)] = rows, now[rows]
    which, count = jax.device_put(list(padded))
    drifted = shared(deal_one_line)(count, which, first, last, *deal[:3])
    now[rows] = np.asarray(drifted)[: len(rows)]
