"""The neutral shadow of lines: the births and deaths of a world, dealt out again by chance alone.

Each birth and each death happens at its tick, so the population is the recorded one. But the parent of
a birth, and the organism that dies, are drawn from all that are alive, each with the same probability
(Moran 1958, in a population of changing size). All changes of lines are then drift.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia import device
from primordia.compiled import shared
from primordia.phylogeny.diversity import hill_numbers
from primordia.phylogeny.living import Turnover
from primordia.progress import tell
from primordia.random.keys import Purpose, below, encrypt, streams, threefry
from primordia.random.wide import Wide, wide
from primordia.runs.lives import Lives

MOST, FEWEST = 200, 40
"""Largest and smallest number of shadows."""
DRAWS = 10**9
"""Largest number of draws, unless the smallest number of shadows needs more."""
DEATH, BIRTH, FOUNDER = 0, 1, 2
"""Kinds of events."""
NO_LINE = 0
"""Number in place of a line's, for founders born after the first instant. Lines are numbered from 1."""


class Deal(NamedTuple):
    """The E births and deaths of a world from the first to the last of T instants, to be dealt out."""

    kinds: Array
    """int8 (E + 1,); the last is no event"""
    before: Array
    """number of living before each event, int32 (E + 1,)"""
    key: Wide
    """key of the draws"""
    places: np.ndarray
    """number of events up to each instant, int64 (T,)"""
    living: np.ndarray
    """number of living at each instant, int64 (T,)"""

    @classmethod
    def of(
        cls, lives: Lives, turnover: Turnover, ticks: np.ndarray, seed: int, what: int
    ) -> "Deal":
        """Prepare a world's turnover. Its draws depend on the seed, the first tick and `what`."""
        device.prepare()
        places = np.searchsorted(turnover.tick, ticks, side="right")
        events = slice(places[0], places[-1])
        born = np.where(lives.parent < 0, FOUNDER, BIRTH).astype(np.int8)
        kinds = np.where(turnover.birth, born[turnover.row], np.int8(DEATH))[events]
        before = turnover.living[events] - np.where(kinds == DEATH, -1, 1)
        tick = streams(wide(seed), wide(int(ticks[0])), Purpose.DRIFT)[Purpose.DRIFT]
        key = threefry(tick, wide(what))
        return cls(
            kinds=jax.device_put(np.append(kinds, np.int8(DEATH))),
            before=jax.device_put(np.append(before, 1).astype(np.int32)),
            key=key,
            places=places - places[0],
            living=turnover.living[places - 1],
        )

    def replicates(self, lines: int, fewest: int, most: int) -> int:
        """Return the number of shadows of each line, if this many lines are dealt one after another."""
        return int(np.clip(DRAWS // max(self.places[-1] * lines, 1), fewest, most))

    @property
    def parts(self) -> Iterator[tuple[int, int, int, int]]:
        """For each instant: its place, the beginning and end of its events, and the number of living."""
        begin = np.append(0, self.places[:-1])
        rows = np.array([np.arange(len(begin)), begin, self.places, self.living])
        return map(tuple, rows.T.tolist())


@dataclass(frozen=True)
class Drift:
    """The shares of K lines in each of R shadows, at T instants."""

    final: np.ndarray
    """share of each line after the last instant, float64 (R, K)"""
    largest: np.ndarray
    """share of the largest line after each instant, float64 (R, T)"""
    effective: np.ndarray
    """effective number of lines (order 2) after each instant, float64 (R, T); 0 without lines"""


def drift(lives: Lives, turnover: Turnover, ticks: np.ndarray, lines: int, seed: int) -> Drift:
    """Let all lines of a world drift together.

    Args:
        lives: lives of one world.
        turnover: births and deaths of the world.
        ticks: T instants, in ascending order; each organism alive after the first begins a line.
        lines: K, the number of lines.
        seed: the world's seed.
    """
    deal = Deal.of(lives, turnover, ticks, seed, what=0)
    shadows = deal.replicates(1, FEWEST, MOST)
    largest, effective = (np.zeros((shadows, len(ticks))) for _ in range(2))
    for place, counts in enumerate(_dealt(deal, shadows, lines)):
        tell("drawing neutral shadows", place / len(ticks))
        largest[:, place] = counts.max(axis=1) / max(deal.living[place], 1)
        effective[:, place] = hill_numbers(counts)[2]
    return Drift(counts / max(deal.living[-1], 1), largest, effective)


def _dealt(deal: Deal, shadows: int, lines: int) -> Iterator[np.ndarray]:
    """Yield the living of each line in each shadow at each instant, int64 (R, K)."""
    slots = int(deal.before.max(initial=lines)) + 1
    own = np.where(np.arange(slots) < lines, np.arange(slots) + 1, NO_LINE).astype(np.int32)
    labels = jax.device_put(np.tile(own, (shadows, 1)))
    call = shared(_deal, donate=(0,))
    last_founder = np.flatnonzero(np.asarray(deal.kinds) == FOUNDER).max(initial=-1)
    first_code, settled = (np.arange(shadows) * (lines + 1))[:, None], False
    for _, begin, end, living in deal.parts:
        if not settled:
            labels = call(labels, begin, end, *deal[:3])
            codes = np.asarray(labels)[:, :living] + first_code
            counts = np.bincount(codes.ravel(), minlength=shadows * (lines + 1))
            counts = counts.reshape(shadows, -1)[:, NO_LINE + 1 :]
            settled = end > last_founder and bool((counts.max(axis=1) == living).all())
        else:  # one line is left in each shadow, so nothing is left to draw
            counts = np.where(counts > 0, living, 0)
        yield counts


def _deal(labels: Array, first: int, last: int, kinds: Array, before: Array, key: Wide) -> Array:
    """Deal births and deaths to shadows in order. Return the lines of the living, int32 (R, M).

    The living of a shadow are in the first of its M places. A newborn takes the next place, with
    the line of its parent. The last of the living takes the place of an organism that dies. So each
    event copies one place to another.
    """
    shadows, slots = labels.shape
    which = jnp.arange(shadows, dtype=jnp.int32)

    def event(number: Array, labels: Array) -> Array:
        living, birth = before[number], kinds[number] != DEATH
        drawn = below(_words(key, number, which), living)
        source = which * slots + jnp.where(birth, drawn, living - 1)
        target = which * slots + jnp.where(birth, living, drawn)
        line = labels.at[source].get(mode="clip")  # records may be forged
        line = jnp.where(kinds[number] == FOUNDER, NO_LINE, line)
        return labels.at[target].set(line, unique_indices=True, mode="drop")

    return lax.fori_loop(first, last, event, labels.ravel()).reshape(shadows, slots)


def deal_one_line(
    counts: Array, which: Array, first: int, last: int, kinds: Array, before: Array, key: Wide
) -> Array:
    """In each shadow, deal births and deaths to one line and to the rest of the living.

    Return how many of the line are then alive in each shadow, int32 (R,).

    Args:
        counts: how many of the line are alive in each shadow, int32 (R,).
        which: numbers of the shadows, int32 (R,); the draws of a shadow depend on its number.
        first: the first event.
        last: the event before which to stop.
        kinds: kind of each event, int8 (E,).
        before: number of living before each event, int32 (E,).
        key: key of the draws.
    """

    def event(number: Array, counts: Array) -> Array:
        drawn = below(_words(key, number, which), before[number]) < counts
        step = jnp.where(kinds[number] == BIRTH, 1, jnp.where(kinds[number] == DEATH, -1, 0))
        return counts + jnp.where(drawn, step, 0)

    return lax.fori_loop(first, last, event, counts)


def _words(key: Wide, number: Array, which: Array) -> Array:
    """Return the random word of an event in each of some shadows, uint32 (R,)."""
    event = jnp.full(which.shape, number, jnp.uint32)
    return encrypt(key, Wide(event, which.astype(jnp.uint32))).hi
