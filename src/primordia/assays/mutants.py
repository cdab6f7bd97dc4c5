"""Mutants of given genomes, made by any mutation as in a run."""

from collections.abc import Mapping
from typing import NamedTuple

import jax
import numpy as np
from jax import Array

from primordia.assays.subjects import Subjects
from primordia.compiled import shared
from primordia.errors import InputError
from primordia.law.law import Law
from primordia.law.moments import change_in
from primordia.law.world import Remembered
from primordia.mutations.contract import PURPOSES, Draws, Family, Moments, Mutation
from primordia.organism.playing.games import Players, stretches
from primordia.organism.playing.seats import Manner
from primordia.random.keys import streams
from primordia.random.wide import wide

MOST_CHILDREN = 1000
"""Largest number of children made for each wanted mutant. If too few of these children mutate, the
mutation counts as one that never happens."""


class Operator(NamedTuple):
    """A mutation with its rates and the notes of K parents."""

    name: str
    mutation: Mutation
    rates: Mapping[str, np.ndarray]
    """present values of the mutation's rates, each float32 (K,)"""
    notes: np.ndarray
    """the parents' notes, int32 (K, n)"""

    @classmethod
    def of(cls, name: str, mutation: Mutation, subjects: Subjects) -> "Operator":
        """Return the operator of a mutation with its configured rates, for parents without notes."""
        count = len(subjects.organism)
        rates = mutation.rates(subjects.law.heredity.layout).items()
        values = {rate: np.full(count, value, np.float32) for rate, value in rates}
        return cls(name, mutation, values, np.asarray(mutation.founders_notes(count)))


def own_operator(subjects: Subjects) -> Operator:
    """Return the mutation of the subjects' own run, with its present rates."""
    heredity = subjects.law.heredity
    climate = {name: np.asarray(values) for name, values in subjects.climate.items()}
    names = heredity.mutation.rates(heredity.layout)
    rates = {name: climate[f"mutation.{name}"] for name in names}
    return Operator("as set", heredity.mutation, rates, subjects.notes)


def mutants(
    subjects: Subjects, operator: Operator, count: int, remembered: Remembered | None
) -> np.ndarray:
    """Return mutants of each of K subjects, float32 (K, count, P), without exact copies.

    Args:
        subjects: the parents.
        operator: the mutation.
        count: number of mutants of each parent.
        remembered: moments of the parents; see `moments_of`.

    Raises:
        InputError: the mutation makes no mutants.
    """
    return np.stack(
        [_of_one(subjects, operator, count, remembered, k) for k in range(len(subjects.organism))]
    )


def _of_one(
    subjects: Subjects,
    operator: Operator,
    count: int,
    remembered: Remembered | None,
    parent: int,
) -> np.ndarray:
    same, found = np.full(count, parent), np.zeros((0, subjects.players.genomes.shape[1]))
    rates = {name: jax.device_put(values[same]) for name, values in operator.rates.items()}
    moments = None if remembered is None else Remembered(*(each[same] for each in remembered))
    breed = shared(_children, subjects.law, operator.mutation)
    for brood in range(MOST_CHILDREN):
        key = streams(subjects.players.keys.take(same), wide([brood]), *PURPOSES)
        draws = Draws(key, jax.device_put(np.arange(count, dtype=np.int32)))
        parents = jax.device_put(subjects.players.genomes[same])
        children, mutated = breed(
            Family(parents, jax.device_put(operator.notes[same]), rates, draws), moments
        )
        found = np.concatenate([found, np.asarray(children)[np.asarray(mutated)]])
        if len(found) >= count:
            return found[:count].astype(np.float32)
    raise InputError(f"{subjects.source}: the mutation makes no mutants with the present settings")


def _children(
    law: Law, mutation: Mutation, family: Family, moments: Remembered | None
) -> tuple[Array, Array]:
    """Return the genomes (K, P) of children, and which are mutants (K,)."""
    change = None if moments is None else change_in(law, moments, family.parents)
    notes = mutation.note(law.heredity.layout, family, change)
    return mutation.inherit(law.heredity.layout, family._replace(notes=notes))


def moments_of(players: Players, rule: Moments, ticks: int) -> Remembered:
    """Let players play one game, and return the last moments that they remember.

    Moments are at regular ticks from the start of the game.

    Args:
        players: K organisms.
        rule: number of moments that are kept, and the ticks between two moments.
        ticks: number of ticks after which the game is cut.
    """
    count, law = len(players.genomes), players.law
    senses = np.zeros((count, rule.kept, law.senses), np.float32)
    memory = np.zeros((count, rule.kept, law.memory), np.float32)
    known = np.zeros((count, rule.kept), bool)
    for index, here in players.by_island():
        tick = 0
        for stretch in stretches(here, 1, Manner(ticks, watched=True)):
            assert stretch.met is not None
            for row in range(-tick % rule.every, len(stretch.playing), rule.every):
                on, place = stretch.playing[row], (tick + row) // rule.every % rule.kept
                senses[index[on], place] = stretch.met.senses[row][on]
                memory[index[on], place] = stretch.met.memory[row][on]
                known[index[on], place] = True
            tick += len(stretch.playing)
            if not stretch.alive.any():
                break
    return Remembered(*jax.device_put((senses, memory, known)))
