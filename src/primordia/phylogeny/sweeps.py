"""Sweeps: the organisms whose descendants replaced all others, one after another."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from primordia.history.rebuilding import descent
from primordia.law.world import BirthCause
from primordia.phylogeny.coalescence import Genealogy
from primordia.phylogeny.fixation import UNKNOWN, first_ticks
from primordia.phylogeny.living import Turnover, branches, last_era
from primordia.runs.lives import Lives


@dataclass(frozen=True)
class Sweep:
    """The spread of one organism's descendants through the living."""

    organism: int
    birth_cause: str
    born: int
    """tick of the organism's birth"""
    half: int | None
    """first tick after which more than half of the living were its descendants; None for not yet"""
    fixed: int | None
    """first tick after which all of the living were its descendants; None for not yet"""
    living: int
    """number of living organisms after the tick `fixed`, or after the tick `half` if `fixed` is None"""

    @property
    def duration(self) -> int | None:
        """Ticks from the organism's birth until all the living descended from the organism."""
        return None if self.fixed is None else self.fixed - self.born

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {**asdict(self), "duration": self.duration}


def sweeps(lives: Lives) -> list[Sweep]:
    """Return the sweeps in one world since it was last founded, in the order of birth.

    At each tick at which the youngest common ancestor of the living changes, the new one has swept.
    Its own ancestors, which are fixed at the same tick, came with it and are not counted. The last
    sweep of the list may be under way. It is then the sweep of the youngest organism whose
    descendants are more than half of the living. Founders of a world and organisms alive at a fork
    do not count.
    """
    era = last_era(lives)
    line = _line_of_survivors(era)
    turnover, branch = Turnover.of(era), branches(era.parent_row, line)
    fixed, half = first_ticks(turnover, branch, len(line), (1, 0.5))
    done = np.flatnonzero((fixed != UNKNOWN) & (fixed != np.append(fixed[1:], UNKNOWN)))
    under_way = np.flatnonzero((half != UNKNOWN) & (fixed == UNKNOWN))[-1:]
    first = era.seen.min() if (era.entered > 0).any() else era.born[0]
    found = [place for place in (*done, *under_way) if era.born[line[place]] > first]
    return [_sweep(era, line[place], half[place], fixed[place], turnover) for place in found]


def _line_of_survivors(era: Lives) -> np.ndarray:
    """Return the rows of a line of descent that ends with a survivor, or with the last to die."""
    if not era.died.all():
        return Genealogy.of(era).trunk()
    last = int(np.argmax(era.ended))
    return descent(era, int(era.id[last]), int(era.world[last]))


def _sweep(era: Lives, row: int, half: int, fixed: int, turnover: Turnover) -> Sweep:
    then = half if fixed == UNKNOWN else fixed
    at = np.searchsorted(turnover.tick, then, side="right") - 1
    return Sweep(
        organism=int(era.id[row]),
        birth_cause=BirthCause(era.birth_cause[row]).label,
        born=int(era.born[row]),
        half=None if half == UNKNOWN else int(half),
        fixed=None if fixed == UNKNOWN else int(fixed),
        living=int(turnover.living[at]),
    )
