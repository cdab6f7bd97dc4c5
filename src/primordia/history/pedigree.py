"""Pedigrees: the genomes of many organisms, rebuilt from the records or with new random draws.

The births of a pedigree are repeated generation by generation. With the recorded draws, the results
are the organisms' own genomes, as in `rebuilding`. With new draws, the results are the genomes of the
neutral shadow: the same parents and times of birth, but other founders and mutations, which were
never selected (Bedau & Packard 1992).
"""

from collections import Counter

import jax
import numpy as np
from jax import Array

from primordia import device
from primordia.compiled import shared
from primordia.errors import Trouble
from primordia.history.ancestry import places_of, with_ancestors
from primordia.history.births import genome_in, recorded
from primordia.history.climate import PastClimate
from primordia.law.heredity import Heredity
from primordia.law.world import BirthCause, Climate
from primordia.mutations.contract import Mutation
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.records import Records

AT_ONCE, FEW = 128, 4
"""Births repeated in one call, in large and in small generations; there are two numbers, since JAX
compiles for every new shape."""


def genomes(run: Records, rows: np.ndarray, redrawn: bool = False) -> np.ndarray:
    """Return the genomes of organisms, float32 (K, P).

    Args:
        run: the organisms' run.
        rows: the organisms' rows in the run's lives, int64 (K,).
        redrawn: draw founders and mutations again, with keys that no run uses. Organisms that were
            alive at a fork keep their genomes. Notes that depend on lives or on cells stay as
            recorded.
    """
    device.prepare()
    pedigree, worlds = _Pedigree(run, redrawn), run.lives.world[rows]
    found = np.zeros((len(rows), run.layout.length), np.float32)
    for world in np.unique(worlds):
        found[worlds == world] = pedigree.genomes(rows[worlds == world])
    return found


class _Pedigree:
    """Repeats the births of a run from its records."""

    def __init__(self, run: Records, redrawn: bool) -> None:
        self._run, self._lives, self._past = run, run.lives, PastClimate(run)
        self._redraws_notes = redrawn and _inherits_notes(run.heredity.mutation)
        self._repeat = shared(_repeat, run.heredity, self._redraws_notes)
        seeds = wide(run.world_seeds)
        seeds = stream(seeds, Purpose.SHADOW, wide(0)) if redrawn else seeds
        self._seeds = jax.device_get(seeds)  # JAX takes entries ten times as slowly

    def genomes(self, rows: np.ndarray) -> np.ndarray:
        """Return the genomes of organisms of one world, (K, P)."""
        members, parents, mates, generation = self._ancestry(rows)
        wanted = np.searchsorted(members, rows)
        made = _Made(self._run.layout.length, wanted, parents, mates)
        notes = self._run.notes_of(self._lives.take(members))
        for place in np.flatnonzero(generation < 0):
            made.put(np.array([place]), self._at_the_fork(members[place])[None])
        for number in range(int(generation.max()) + 1):
            now = np.flatnonzero(generation == number)
            for first in range(0, len(now), AT_ONCE):
                some = now[first : first + AT_ONCE]
                self._make(made, notes, members[some], some, parents[some], mates[some])
        return np.stack([made.genomes[place] for place in wanted])

    def _at_the_fork(self, row: int) -> np.ndarray:
        assert self._run.origin is not None
        number, world = int(self._lives.id[row]), int(self._lives.world[row])
        return genome_in(self._run.origin, self._run.layout, number, world)

    def _ancestry(self, rows: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return the rows of organisms and all their ancestors, ascending, each (A,).

        Also return, for each row, the indices of its parent and mate among these rows (-1 for none)
        and its generation: 0 for founders, -1 for organisms that were alive at a fork.
        """
        lives = self._lives
        root = (lives.birth_cause == BirthCause.FOUNDER) | lives.inherited
        both = [np.where(root, -1, of) for of in (lives.parent_row, self._mate_rows())]
        members = with_ancestors(rows, *both)
        parents, mates = (places_of(members, of[members]) for of in both)
        generation = np.where(lives.inherited[members], -1, 0)
        for place in np.flatnonzero(parents >= 0):  # parents have lower rows than children
            of_mate = generation[mates[place]] if mates[place] >= 0 else 0
            generation[place] = max(generation[parents[place]], of_mate, 0) + 1
        return members, parents, mates, generation

    def _mate_rows(self) -> np.ndarray:
        """Return the row of each organism's mate, int64 (L,); -1 without a mate."""
        lives = self._lives
        number = self._run.mates_of(lives)
        rows = lives.rows_of(lives.world, number)
        odd = (number >= 0) & ((rows < 0) | (number >= lives.id))
        if odd.any():
            raise Trouble(
                f"the births are damaged: the mate of organism {lives.id[odd][0]} was not born"
                " before it"
            )
        return rows

    def _make(
        self,
        made: "_Made",
        notes: np.ndarray,
        rows: np.ndarray,
        places: np.ndarray,
        parents: np.ndarray,
        mates: np.ndarray,
    ) -> None:
        """Repeat births, and put the genomes and notes of the newborn into their places."""
        fill = np.arange(AT_ONCE if len(rows) > FEW else FEW) % len(rows)
        births, before = self._lives.take(rows[fill]), np.maximum(parents[fill], 0)
        climate = self._past.of_lives(births, births.born)
        genome, own = self._repeat(
            (self._seeds.take(births.world), wide(births.id), wide(births.born)),
            (births.cell, births.birth_cause == BirthCause.FOUNDER),
            climate,
            (made.take(parents[fill]), made.take(mates[fill]), mates[fill] >= 0),
            notes[before] if self._redraws_notes else notes[places[fill]],
        )
        made.put(places, np.asarray(genome)[: len(rows)])
        notes[places] = np.asarray(own)[: len(rows)]
        made.release(parents)
        made.release(mates)


class _Made:
    """Genomes that have been made; each is kept until its last child has been made."""

    def __init__(self, length: int, wanted: np.ndarray, *parents: np.ndarray) -> None:
        """Keep the genomes at the `wanted` indices. `parents` are the indices of all parents, or -1."""
        self.genomes: dict[int, np.ndarray] = {}
        self._none = np.zeros(length, np.float32)
        self._uses = Counter(wanted.tolist())
        for each in parents:
            self._uses.update(each[each >= 0].tolist())

    def put(self, places: np.ndarray, genomes: np.ndarray) -> None:
        """Keep genomes (K, P)."""
        self.genomes.update(zip(places.tolist(), genomes.copy(), strict=True))

    def take(self, places: np.ndarray) -> np.ndarray:
        """Return genomes (K, P); the genome of index -1 is zero."""
        return np.stack([self.genomes.get(place, self._none) for place in places.tolist()])

    def release(self, places: np.ndarray) -> None:
        """Count one use of each genome, and forget genomes that will not be used again."""
        for place in places[places >= 0].tolist():
            self._uses[place] -= 1
            if not self._uses[place]:
                del self.genomes[place]


def _inherits_notes(mutation: Mutation) -> bool:
    """Return whether notes depend only on parents' notes and chance, so that they can be drawn again."""
    return mutation.moments is None and mutation.notes_from == "parent"


def _repeat(
    heredity: Heredity,
    redraws_notes: bool,
    counts: tuple,
    marks: tuple,
    climate: Climate,
    of: tuple[Array, Array, Array],
    notes: Array,
) -> tuple[Array, Array]:
    """Repeat K births. Return genomes, float32 (K, P), and notes, int32 (K, n), of the newborn.

    Args:
        heredity: the heredity of the run.
        redraws_notes: whether `notes` are the parents' notes, from which the newborn's notes are
            drawn.
        counts: seed of the world, birth number and tick of each birth, Wide.
        marks: cell within the world; whether the newborn is a founder.
        climate: values of the settings at each birth.
        of: genomes of parents and mates, float32 (K, P) each; which newborn have a mate, bool (K,).
        notes: notes of the newborn as recorded, or of their parents, int32 (K, n).
    """
    birth = recorded(heredity, counts, marks, climate)
    parents = heredity.recombined(birth, *of)
    if not redraws_notes:
        return heredity.rebuild_genomes(birth, parents, notes), notes
    newborn = heredity.make_newborn(birth, parents, notes, None)
    return newborn.genome, newborn.notes
