"""The error threshold: whether a good line can persist in spite of its mutants.

A good line has an advantage s in lifespan. A share p of its children mutate, and a share v of the
mutants are as good as their parent. The line persists if s (1 - p (1 - v)) is above 1. This is
Eigen's threshold (1971), rearranged for organisms that all replicate at the same rate and differ in
lifespan. If replication is an act, organisms also differ in how often they copy themselves: then the
number of children takes the place of the lifespan.
"""

from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from primordia.history.families import LEAST, Families, families_by_world, families_of
from primordia.runs.lives import LATE, Lives
from primordia.runs.records import Records

BEST = 0.9
"""Quantile of lifespans from which a parent counts as good."""


@dataclass(frozen=True)
class Threshold:
    """The error threshold in one world, among children born late. None stands for an unknown number."""

    world: int
    mutated: float | None
    """p, the share of children that are mutants"""
    as_good: float | None
    """v: the share of good parents' mutants that live as long as the parent, divided by the same
    share of the parents' copies; at most 1; if replication is an act, that have as many children"""
    advantage: float | None
    """s: number of ticks lived per death among copies of good parents, divided by the same ratio
    among all organisms born; if replication is an act, children per death"""

    @property
    def held(self) -> float | None:
        """s (1 - p (1 - v)); above 1 a good line persists."""
        if self.mutated is None or self.as_good is None or self.advantage is None:
            return None
        return self.advantage * (1 - self.mutated * (1 - self.as_good))

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {**asdict(self), "held": self.held}


def threshold(run: Records, after: float = LATE, island: str | None = None) -> list[Threshold]:
    """Measure the error threshold in each world of a run.

    A parent is good if it lives at least as long as nine tenths of the organisms that were born
    late in its world. A long lifespan may be luck. So the parent's mutants are compared with its
    copies, which have the same genome. In a deterministic game copies live exactly as long as the
    parent.

    Args:
        run: the run, or an arm.
        after: share of a world's births after which a birth is late.
        island: name of an island; only organisms that were born there count, and of their children
            those that were born there too.

    Raises:
        InputError: the worlds have no such island.
    """
    worlds = enumerate(families_by_world(run, after, run.config.act is not None, island))
    return [_measured(world, found) for world, found in worlds]


def over_births(world: int, lives: Lives, edges: np.ndarray, acts: bool = False) -> list[Threshold]:
    """Measure the error threshold of one world in successive bins of births.

    Organisms that were alive at a fork do not count, since the short lives of their generation are not
    on record.

    Args:
        world: number of the world.
        lives: the world's lives.
        edges: edges of the bins, as rows in birth order, int64 (B + 1,), ascending.
        acts: whether replication is an act.
    """
    bins = (np.arange(low, min(high, len(lives))) for low, high in pairwise(edges.tolist()))
    own = (rows[~lives.inherited[rows]] for rows in bins)
    return [_measured(world, families_of(lives, rows, acts)) for rows in own]


def _measured(world: int, found: Families) -> Threshold:
    if not len(found.child):
        return Threshold(world, None, None, None)
    good = found.worth[found.parent] >= np.quantile(found.worth[found.born], BEST)
    mutants, copies = good & found.mutant, good & ~found.mutant
    as_long, known = found.as_long()
    of_mutants, of_same = (_share(as_long[known & which]) for which in (mutants, copies))
    of_copies, of_all = (_per_death(found, rows) for rows in (found.child[copies], found.born))
    return Threshold(
        world,
        mutated=float(found.mutant.mean()),
        as_good=None if of_mutants is None or not of_same else min(of_mutants / of_same, 1.0),
        advantage=None if of_copies is None or of_all is None else of_copies / of_all,
    )


def _share(as_long: np.ndarray) -> float | None:
    """Return the share of True values; None if there are too few values."""
    return float(as_long.mean()) if len(as_long) >= LEAST else None


def _per_death(found: Families, rows: np.ndarray) -> float | None:
    """Return the ticks lived, or the children born, for each death. Those of the living count too."""
    deaths = int(found.lives.died[rows].sum())
    return float(found.worth[rows].sum() / deaths) if deaths else None
