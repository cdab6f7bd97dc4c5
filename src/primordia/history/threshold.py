"""Does a good line keep its ground against its own mutants? The error threshold, from records.

A line with an advantage s, of whose copies a share p mutates, keeps its ground while s (1 - p (1 - v)) is
above 1, where v is the share of mutants that are as good as their parent (Eigen 1971, rearranged for
organisms that all replicate at one rate, so that a lifespan is what a line gains or loses).
"""

from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from primordia.history.families import LEAST, Families, families, families_of
from primordia.runs.lives import LATE, Lives
from primordia.runs.records import Records

BEST = 0.9
"""Quantile of lifespans from which a parent counts as good."""


@dataclass(frozen=True)
class Threshold:
    """The error threshold in one world, among children born late. None is a number that nothing tells."""

    world: int
    mutated: float | None
    """p, the share of children that are mutants"""
    as_good: float | None
    """v: the share of good parents' mutants that live as long as the parent, over that of their copies"""
    advantage: float | None
    """s: ticks lived for each death among copies of good parents, over those among all that were born"""

    @property
    def held(self) -> float | None:
        """s (1 - p (1 - v)); above 1 a good line keeps its ground."""
        if self.mutated is None or self.as_good is None or self.advantage is None:
            return None
        return self.advantage * (1 - self.mutated * (1 - self.as_good))

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {**asdict(self), "held": self.held}


def threshold(run: Records, after: float = LATE) -> list[Threshold]:
    """Measure the error threshold in each world of a run.

    A parent is good if it lives at least as long as nine tenths of the organisms that were born late in
    its world. Its lifespan may be luck. So its copies tell what its genome is worth, and its mutants
    are held against them: in a deterministic game copies live exactly as long.

    Args:
        run: the run, or an arm.
        after: share of a world's births after which a birth is late.
    """
    worlds = (run.lives.of_world(world) for world in range(run.lives.worlds))
    return [_measured(world, families(lives, after)) for world, lives in enumerate(worlds)]


def over_births(world: int, lives: Lives, edges: np.ndarray) -> list[Threshold]:
    """Measure the error threshold of one world as it went on.

    Args:
        world: number of the world.
        lives: its lives.
        edges: places in the order of birth, int64 (B + 1,), rising. Children born between two of them
            count together.
    """
    return [
        _measured(world, families_of(lives, np.arange(low, min(high, len(lives)))))
        for low, high in pairwise(edges.tolist())
    ]


def _measured(world: int, found: Families) -> Threshold:
    lives = found.lives
    if not len(found.child):
        return Threshold(world, None, None, None)
    good = found.lifespans[1] >= np.quantile(lives.lifespan[found.born], BEST)
    mutants, copies = good & found.mutant, good & ~found.mutant
    of_mutants, of_same = (_share_as_long(found, which) for which in (mutants, copies))
    of_copies, of_all = (
        _ticks_per_death(lives, rows) for rows in (found.child[copies], found.born)
    )
    return Threshold(
        world,
        mutated=float(found.mutant.mean()),
        as_good=None if of_mutants is None or not of_same else min(of_mutants / of_same, 1.0),
        advantage=None if of_copies is None or of_all is None else of_copies / of_all,
    )


def _share_as_long(found: Families, which: np.ndarray) -> float | None:
    as_long, known = found.as_long()
    count = int((known & which).sum())
    return int((as_long & which).sum()) / count if count >= LEAST else None


def _ticks_per_death(lives: Lives, rows: np.ndarray) -> float | None:
    """Return the ticks lived for each death, so that the living count with what they have lived."""
    deaths = int(lives.died[rows].sum())
    return float(lives.lifespan[rows].sum() / deaths) if deaths else None
