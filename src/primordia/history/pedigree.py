"""Pedigrees: the genomes of many organisms, rebuilt from the records or with new random draws.

The births of a pedigree are repeated generation by generation, by the rule that made them
(`law.heredity`). A mutation gives the same bits on every device and with every version of the packages.
With the recorded draws, the results are the organisms' own genomes. With new draws, the results are
the genomes of the neutral shadow: the same parents and times of birth, but other founders and
mutations, which were never selected (Bedau & Packard 1992).
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
from primordia.progress import steps
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
        redrawn: draw the genomes of founders, the noise of mutations and recombination again, with
            keys that no run uses. The same births mutate, and their notes stay as recorded, such as
            the sizes of mutations. Organisms that were alive at a fork keep their genomes.
    """
    device.prepare()
    past, worlds = PastClimate(run), run.lives.world[rows]
    found = np.zeros((len(rows), run.layout.length), np.float32)
    for world in steps(np.unique(worlds).tolist(), "rebuilding genomes"):
        here = rows[worlds == world]
        found[worlds == world] = _Pedigree(run, past, here, redrawn).genomes(here)
    return found


class _Pedigree:
    """The births of organisms of one world and of all their ancestors, A in all, sorted by row."""

    def __init__(self, run: Records, past: PastClimate, rows: np.ndarray, redrawn: bool) -> None:
        lives = run.lives
        root = (lives.birth_cause == BirthCause.FOUNDER) | lives.inherited
        both = [np.where(root, -1, of) for of in (lives.parent_row, _mate_rows(run))]
        self._run, self._members = run, with_ancestors(rows, *both)
        self._parents, self._mates = (places_of(self._members, of[self._members]) for of in both)
        self._births = births = lives.take(self._members)
        self._notes = run.notes_of(births)
        self._climate = past.of_lives(births, births.born)
        numbers = (wide(each) for each in (run.world_seeds[births.world], births.id, births.born))
        # JAX takes entries ten times as slowly as NumPy.
        self._counts = jax.device_get(tuple(numbers))
        self._repeat = shared(_repeat, run.heredity, redrawn)

    def genomes(self, rows: np.ndarray) -> np.ndarray:
        """Return the genomes of some of the organisms, (K, P)."""
        wanted, generation = places_of(self._members, rows), self._generations()
        made = _Made(self._run.layout.length, wanted, self._parents, self._mates)
        for place in np.flatnonzero(generation < 0).tolist():
            made.put(np.array([place]), self._at_the_fork(place)[None])
        for number in steps(range(int(generation.max()) + 1), "rebuilding genomes"):
            now = np.flatnonzero(generation == number)
            for first in range(0, len(now), AT_ONCE):
                self._make(made, now[first : first + AT_ONCE])
        return np.stack([made.genomes[place] for place in wanted])

    def _at_the_fork(self, place: int) -> np.ndarray:
        assert self._run.origin is not None
        number, world = int(self._births.id[place]), int(self._births.world[place])
        return genome_in(self._run.origin, self._run.layout, number, world)

    def _generations(self) -> np.ndarray:
        """Return generations, int64 (A,): 0 for founders, -1 for organisms alive at a fork."""
        parents, mates = self._parents, self._mates
        generation = np.where(self._births.inherited, -1, 0)
        for place in np.flatnonzero(parents >= 0):  # parents have lower rows than children
            of_mate = generation[mates[place]] if mates[place] >= 0 else 0
            generation[place] = max(generation[parents[place]], of_mate, 0) + 1
        return generation

    def _make(self, made: "_Made", places: np.ndarray) -> None:
        """Repeat births, and put the genomes of the newborn into their places."""
        fill = np.resize(places, AT_ONCE if len(places) > FEW else FEW)
        births, parents, mates = self._births, self._parents[fill], self._mates[fill]
        genome = self._repeat(
            tuple(each.take(fill) for each in self._counts),
            (births.cell[fill], births.birth_cause[fill] == BirthCause.FOUNDER),
            {name: values[fill] for name, values in self._climate.items()},
            (made.take(parents), made.take(mates), mates >= 0),
            self._notes[fill],
        )
        made.put(places, np.asarray(genome)[: len(places)])
        made.release(self._parents[places])
        made.release(self._mates[places])


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


def _mate_rows(run: Records) -> np.ndarray:
    """Return the row of each organism's mate, int64 (L,); -1 without a mate."""
    if not run.schema.mates:
        return np.full(len(run.lives), -1)
    lives, number = run.lives, run.mates_of(run.lives)
    rows = lives.rows_of(lives.world, number)
    odd = (number >= 0) & ((rows < 0) | (number >= lives.id))
    if odd.any():
        raise Trouble(
            f"the births are damaged: the mate of organism {lives.id[odd][0]} was not born before it"
        )
    return rows


def _repeat(
    heredity: Heredity,
    redrawn: bool,
    counts: tuple,
    marks: tuple,
    climate: Climate,
    of: tuple[Array, Array, Array],
    notes: Array,
) -> Array:
    """Repeat K births. Return genomes, float32 (K, P), of the newborn.

    Args:
        heredity: the heredity of the run.
        redrawn: whether chance is drawn again; see `genomes`.
        counts: seed of the world, birth number and tick of each birth, Wide.
        marks: cell within the world; whether the newborn is a founder.
        climate: values of the settings at each birth.
        of: genomes of parents and mates, float32 (K, P) each; which newborn have a mate, bool (K,).
        notes: notes of the newborn, int32 (K, n).
    """
    birth = recorded(heredity, counts, marks, climate)
    if redrawn:
        seed, *others = counts
        unused = stream(seed, Purpose.SHADOW, wide(0))
        again = recorded(heredity, (unused, *others), marks, climate)
        streams, whether = again.draws.streams, birth.draws.streams[Purpose.MUTATE]
        streams = streams.replaced(whether, Purpose.MUTATE)
        birth = again._replace(draws=again.draws._replace(streams=streams))
    return heredity.rebuild_genomes(birth, heredity.recombined(birth, *of), notes)
