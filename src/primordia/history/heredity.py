"""Heredity of lifespan: the regression of offspring on parents, and the Price equation.

Lifespans are compared as natural logarithms, since their ratios matter. If organisms have one
parent, the slope of the offspring's lifespan on the parent's estimates the heritability (Falconer &
Mackay 1996, ch. 10). The Price equation (Price 1970) divides the change from parents to offspring
into two terms. Selection: the long-lived have more children. Transmission: children differ from
their parents.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from primordia.history.families import LEAST, Families, families_by_world
from primordia.runs.lives import LATE
from primordia.runs.records import Records


@dataclass(frozen=True)
class Pairs:
    """Dead children of one kind, each with its dead parent."""

    pairs: int
    slope: float | None
    """slope of the child's log lifespan on the parent's; None if pairs are fewer than LEAST, or if
    all parents lived equally long"""
    as_long: float | None
    """share of the children that live exactly as long as the parent"""
    longer: float | None
    """share of the children that live longer than the parent by a tenth or more"""
    shorter: float | None
    """share of the children whose life is shorter than the parent's by a third or more"""


@dataclass(frozen=True)
class Inherited:
    """The inheritance of lifespan in one world."""

    world: int
    copies: Pairs
    mutants: Pairs
    both: Pairs
    selection: float | None
    """Cov(w, z) / mean w, with log lifespan z and number of children w"""
    transmission: float | None
    """E(w (z' - z)) / mean w, with z' the log lifespan of the children"""

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return asdict(self)


def heredity(run: Records, after: float = LATE, island: str | None = None) -> list[Inherited]:
    """Measure the inheritance of lifespan in each world of a run, among children born late.

    Args:
        run: the run, or an arm.
        after: share of a world's births after which a birth is late.
        island: name of an island; only parents and children that were both born there count.

    Raises:
        InputError: the worlds have no such island.
    """
    worlds = enumerate(families_by_world(run, after, island=island))
    return [_of_world(world, found) for world, found in worlds]


def _of_world(world: int, found: Families) -> Inherited:
    selection, transmission = price(found)
    copies, mutants = found.complete & ~found.mutant, found.complete & found.mutant
    return Inherited(
        world,
        _pairs(found, copies),
        _pairs(found, mutants),
        _pairs(found, found.complete),
        selection,
        transmission,
    )


def _pairs(found: Families, which: np.ndarray) -> Pairs:
    child, parent = (each[which] for each in found.lifespans)
    if not len(child):
        return Pairs(0, None, None, None, None)
    return Pairs(
        pairs=len(child),
        slope=slope(_log(parent), _log(child)),
        as_long=float((child == parent).mean()),
        longer=float((10 * child >= 11 * parent).mean()),
        shorter=float((3 * child <= 2 * parent).mean()),
    )


def slope(x: np.ndarray, y: np.ndarray) -> float | None:
    """Return the slope of y on x by least squares; None for too few points (see LEAST) or equal x."""
    if len(x) < LEAST or np.ptp(x) == 0:
        return None
    return float(np.cov(x, y)[0, 1] / np.var(x, ddof=1))


def price(found: Families) -> tuple[float | None, float | None]:
    """Return selection and transmission from families whose parent and late children are all dead.

    Late-born organisms without children count as parents of zero children. The sum of both terms is
    the mean log lifespan of the children minus the mean log lifespan of these parents. Both terms
    are None if there are no children.
    """
    lives, z = found.lives, _log(found.lives.lifespan)
    counted = np.zeros(len(lives), bool)
    counted[found.born], counted[found.parent] = True, True
    counted &= lives.died
    counted[found.parent[~lives.died[found.child]]] = False
    children = found.child[counted[found.parent]]
    parents = found.parent[counted[found.parent]]
    if not len(children):
        return None, None
    w = np.bincount(parents, minlength=len(lives)).astype(float)[counted]
    change = np.bincount(parents, z[children] - z[parents], len(lives))[counted]
    mean = w.mean()
    selection = (w * z[counted]).mean() / mean - z[counted].mean()
    return float(selection), float(change.mean() / mean)


def _log(lifespans: np.ndarray) -> np.ndarray:
    return np.log(np.maximum(lifespans, 1))
