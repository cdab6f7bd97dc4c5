"""Pedigrees: the genomes of many organisms, made again from the records, or with all chance drawn again.

The births of a pedigree are repeated generation by generation. As recorded they give the organisms' own
genomes, as in `lineage`. Redrawn they give those of the neutral shadow: the same parents and times of
birth, but founders and mutations that no life has ever tried (Bedau & Packard 1992).
"""

import numpy as np
from jax import Array

from primordia import device
from primordia.compiled import shared
from primordia.history.climate import PastClimate
from primordia.history.lineage import genome_in, recorded
from primordia.law.heredity import Heredity
from primordia.law.world import BirthCause, Climate
from primordia.mutations.contract import Mutation
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.records import Records

AT_ONCE = 128
"""Births repeated in one call; the number is fixed, since JAX compiles for every new shape."""


def genomes(run: Records, rows: np.ndarray, redrawn: bool = False) -> np.ndarray:
    """Return the genomes of organisms, float32 (K, P).

    Args:
        run: the organisms' run.
        rows: their rows in the run's lives, int64 (K,).
        redrawn: draw founders and mutations again, under keys that no run uses. Organisms that were alive
            at a fork keep their genomes. Notes that depend on lives or on cells stay as recorded.
    """
    device.prepare()
    pedigree, worlds = _Pedigree(run, redrawn), run.lives.world[rows]
    found = np.zeros((len(rows), run.layout.length), np.float32)
    for world in np.unique(worlds):
        found[worlds == world] = pedigree.genomes(rows[worlds == world])
    return found


class _Pedigree:
    """The births of a run, repeated."""

    def __init__(self, run: Records, redrawn: bool) -> None:
        self._run, self._lives, self._past = run, run.lives, PastClimate(run)
        self._redraws_notes = redrawn and _inherits_notes(run.heredity.mutation)
        self._repeat = shared(_repeat, run.heredity, self._redraws_notes)
        seeds = wide(run.world_seeds)
        self._seeds = stream(seeds, Purpose.SHADOW, wide(0)) if redrawn else seeds

    def genomes(self, rows: np.ndarray) -> np.ndarray:
        """Return the genomes of organisms of one world, (K, P)."""
        members, parents, generation = self._ancestry(rows)
        made = np.zeros((len(members), self._run.layout.length), np.float32)
        notes = self._run.notes_of(self._lives.take(members))
        for place in np.flatnonzero(generation < 0):
            made[place] = self._at_the_fork(members[place])
        for number in range(int(generation.max()) + 1):
            now = np.flatnonzero(generation == number)
            for first in range(0, len(now), AT_ONCE):
                some = now[first : first + AT_ONCE]
                self._make(made, notes, members[some], some, parents[some])
        return made[np.searchsorted(members, rows)]

    def _at_the_fork(self, row: int) -> np.ndarray:
        assert self._run.origin is not None
        number, world = int(self._lives.id[row]), int(self._lives.world[row])
        return genome_in(self._run.origin, self._run.layout, number, world)

    def _ancestry(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the rows of organisms and all their ancestors, rising, (A,) each.

        With them go the place of each one's parent among them, -1 without one, and its generation: 0 for
        founders, -1 for organisms that were alive at a fork.
        """
        lives, known = self._lives, np.zeros(len(self._lives), bool)
        root = (lives.birth_cause == BirthCause.FOUNDER) | (lives.entered > 0)
        new = np.unique(rows)
        while len(new):
            known[new] = True
            older = np.unique(lives.parent_row[new[~root[new]]])
            new = older[~known[older]]
        members = np.flatnonzero(known)
        parent_row = np.where(root[members], -1, lives.parent_row[members])
        parents = np.where(parent_row < 0, -1, np.searchsorted(members, parent_row))
        generation = np.where(lives.entered[members] > 0, -1, 0)
        for place in np.flatnonzero(parents >= 0):  # parents have lower rows than their children
            generation[place] = max(generation[parents[place]], 0) + 1
        return members, parents, generation

    def _make(
        self,
        made: np.ndarray,
        notes: np.ndarray,
        rows: np.ndarray,
        places: np.ndarray,
        parents: np.ndarray,
    ) -> None:
        """Repeat births, and put the genomes and notes of the newborn into their places."""
        fill = np.arange(AT_ONCE) % len(rows)
        births, before = self._lives.take(rows[fill]), np.maximum(parents[fill], 0)
        climate = self._past.of_lives(births, births.born)
        genome, own = self._repeat(
            (self._seeds.take(births.world), wide(births.id), wide(births.born)),
            (births.cell, births.birth_cause == BirthCause.FOUNDER),
            climate,
            made[before],
            notes[before] if self._redraws_notes else notes[places[fill]],
        )
        made[places], notes[places] = (np.asarray(each)[: len(rows)] for each in (genome, own))


def _inherits_notes(mutation: Mutation) -> bool:
    """Return whether notes depend on parents' notes and chance alone, so that they can be drawn again."""
    return mutation.moments is None and mutation.notes_from == "parent"


def _repeat(
    heredity: Heredity,
    redraws_notes: bool,
    counts: tuple,
    marks: tuple,
    climate: Climate,
    parents: Array,
    notes: Array,
) -> tuple[Array, Array]:
    """Repeat K births -> genomes float32 (K, P) and notes int32 (K, n) of the newborn.

    Args:
        heredity: the heredity of the run.
        redraws_notes: whether the notes are the parents', and those of the newborn are drawn too.
        counts: seed of the world, birth number and tick of each birth, Wide.
        marks: cell within the world; whether it is a founder.
        climate: values of the settings at each birth.
        parents: the parents' genomes, float32 (K, P).
        notes: notes of the newborn as recorded, or of their parents, int32 (K, n).
    """
    birth = recorded(heredity, counts, marks, climate)
    if not redraws_notes:
        return heredity.rebuild_genomes(birth, parents, notes), notes
    newborn = heredity.make_newborn(birth, parents, notes, None)
    return newborn.genome, newborn.notes
