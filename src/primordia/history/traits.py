"""The traits of the organisms of a run, and of their neutral shadows; see `habitats.traits`."""

from typing import NamedTuple

import numpy as np

from primordia.brains.layout import BODY
from primordia.habitats.traits import Traits
from primordia.history import pedigree
from primordia.history.series import spaced
from primordia.runs.records import Records

AT_ONCE = 2**17
"""Largest number of genomes that are in memory at once."""
BINS, EACH = 25, 12
"""Number of bins of births, and the largest number of organisms of a world in each."""


class Course(NamedTuple):
    """T traits of the newborn of W worlds in B bins of births."""

    middle: np.ndarray
    """the middle of each bin, in organisms born so far, float64 (B,)"""
    own: np.ndarray
    """geometric means of factors, float64 (T, W, B); NaN without a birth"""
    shadows: np.ndarray
    """those of the neutral shadows, which have the same parents but mutations of their own"""


def factors_of(run: Records, traits: Traits, rows: np.ndarray, redrawn: bool = False) -> np.ndarray:
    """Return the traits of organisms, float32 (K, T), from their rebuilt genomes.

    Args:
        run: the run, or an arm.
        traits: its traits.
        rows: the organisms' rows in the run's lives, int64 (K,).
        redrawn: whether the neutral shadows are meant; see `pedigree.genomes`.
    """
    found = np.zeros((len(rows), len(traits.names)), np.float32)
    for first in range(0, len(rows), AT_ONCE):
        part = slice(first, first + AT_ONCE)
        genomes = pedigree.genomes(run, rows[part], redrawn)
        found[part] = traits.factors(run.layout.split(genomes)[BODY])
    return found


def of_living(run: Records, world: int) -> dict[str, dict[str, float]] | None:
    """Return median and quartiles of each trait of a world's living; None without traits or life."""
    traits, cells = run.config.traits, run.config.cells
    here = slice(world * cells, (world + 1) * cells)
    alive = run.state["world.organisms.alive"][here]
    if traits is None or not alive.any():
        return None
    factors = traits.factors(run.state[f"world.organisms.genome.{BODY}"][here][alive])
    shares = np.quantile(factors, [0.25, 0.5, 0.75], axis=0).T
    names = ("q1", "median", "q3")
    return {
        trait: dict(zip(names, map(float, each), strict=True))
        for trait, each in zip(traits.names, shares, strict=True)
    }


def course(run: Records) -> Course | None:
    """Return the traits over births, from some organisms of each bin; None without traits."""
    if (traits := run.config.traits) is None:
        return None
    lives = run.lives
    longest = int(lives.rank.max()) + 1
    edges = np.linspace(0, longest, min(BINS, longest) + 1)
    own = np.flatnonzero(~lives.inherited)
    bins = np.searchsorted(edges, lives.rank[own], side="right") - 1
    place = lives.world[own].astype(np.int64) * (len(edges) - 1) + bins
    order = np.argsort(place, kind="stable")
    borders = np.searchsorted(place[order], np.arange(1, lives.worlds * (len(edges) - 1)))
    rows = [spaced(each, EACH) for each in np.split(own[order], borders)]
    ends = np.cumsum([len(each) for each in rows])
    shape = len(traits.names), lives.worlds, len(edges) - 1
    found = []
    for redrawn in (False, True):
        logs = np.log(factors_of(run, traits, np.concatenate(rows), redrawn).astype(float))
        means = [
            each.mean(axis=0) if len(each) else _unknown(traits)
            for each in np.split(logs, ends[:-1])
        ]
        found.append(np.exp(np.array(means)).T.reshape(shape))
    return Course((edges[:-1] + edges[1:]) / 2, *found)


def _unknown(traits: Traits) -> np.ndarray:
    return np.full(len(traits.names), np.nan)
