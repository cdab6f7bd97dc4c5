"""Heredity of invented births: genomes of founders, of children, and of children with a mate."""

from dataclasses import replace
from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.brains.layout import Layout
from primordia.compiled import shared
from primordia.law.heredity import Birth, Heredity, Newborn
from primordia.law.recombination import Recombination
from primordia.mutations.contract import PURPOSES, Change, Draws, Family
from primordia.mutations.gaussian import Gaussian
from primordia.random.keys import Purpose, streams
from primordia.random.wide import wide
from tests.mutations.families import inherited
from tests.worlds import MEADOW, begun, law_of

LAYOUT = Layout((("input", (3, 2)), ("output", (2, 3))))
ANCESTORS = np.arange(5 * 12, dtype=np.float32).reshape(5, 12)
K = 8
SEEDS = [0, 1, 4, 7, 2**32, 2**64 - 1, 2**64 - 1, 3]
NUMBERS = [0, 0, 1, 3, 2**32 + 1, 1, 2**40, 9]
SOME = np.array([1, 0, 0, 1, 1, 0, 1, 0], bool)
PARENTS = np.random.default_rng(4).normal(size=(K, 12)).astype(np.float32)


def heredity_of(**values: Any) -> Heredity:
    plain = Heredity(LAYOUT, Gaussian(probability=0.5, scale=0.1), None, "parent", None, worlds=1)
    return replace(plain, **values)


class Noted(Gaussian):
    """A mutation with two notes: 3 and -1 in founders, and 10 more than the parent's in children."""

    notes: ClassVar = ("plus", "minus")

    def note(self, layout: Layout, family: Family, change: Change | None) -> Array:
        return family.notes + 10

    def founders_notes(self, count: int) -> Array:
        return jnp.tile(jnp.array([3, -1], jnp.int32), (count, 1))


def births(heredity: Heredity, founder: np.ndarray) -> Birth:
    drawn = streams(wide(SEEDS), wide([6] * K), *PURPOSES, Purpose.CROSS)
    rates = heredity.mutation.rates(LAYOUT)
    return Birth(
        seed=wide(SEEDS),
        number=wide(NUMBERS),
        draws=Draws(drawn, np.arange(K)),
        founder=founder,
        rates={name: jnp.full(K, rate, jnp.float32) for name, rate in rates.items()},
    )


def made(heredity: Heredity, founder: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the genomes of newborn, and which of them are mutants."""
    newborn, rebuilt = shared(_made, heredity)(births(heredity, founder))
    np.testing.assert_array_equal(newborn.genome, rebuilt)
    return np.asarray(newborn.genome), np.asarray(newborn.mutated)


def _made(heredity: Heredity, birth: Birth) -> tuple[Newborn, Array]:
    parents, none = jnp.asarray(PARENTS), jnp.zeros((K, 0), jnp.int32)
    newborn = heredity.make_newborn(birth, parents, none, None)
    return newborn, heredity.rebuild_genomes(birth, parents, none)


@pytest.mark.parametrize("founder", [SOME, SOME | True, SOME & False])
def test_founders_take_the_ancestors_in_turn_and_children_their_parents_weights(
    founder: np.ndarray,
) -> None:
    """Founder `number` of `seed` has ancestor (seed + number) mod 5. No founder is a mutant."""
    heredity = heredity_of(ancestors=ANCESTORS, worlds=2)
    genome, mutated = made(heredity, founder)
    birth = births(heredity, founder)
    family = Family(PARENTS, np.zeros((K, 0), np.int32), birth.rates, birth.draws)
    children, mutants = inherited(heredity.mutation, LAYOUT, family)
    assert 0 < mutants.sum() < K
    for row in range(K):
        turn = (SEEDS[row] + NUMBERS[row]) % 2**64 % 5
        expected = ANCESTORS[turn] if founder[row] else children[row]
        np.testing.assert_array_equal(genome[row], expected)
        assert mutated[row] == (mutants[row] and not founder[row])


def test_founders_draw_their_own_noise_and_children_theirs() -> None:
    heredity = heredity_of(mutation=Gaussian(probability=1.0, founder_scale=0.5))
    genome, _ = made(heredity, SOME)
    birth = births(heredity, SOME)
    family = Family(PARENTS, np.zeros((K, 0), np.int32), birth.rates, birth.draws)
    founders = np.asarray(shared(Gaussian.founders, heredity.mutation, LAYOUT)(birth.draws))
    children = inherited(heredity.mutation, LAYOUT, family)[0]
    np.testing.assert_array_equal(genome, np.where(SOME[:, None], founders, children))


def test_without_inheritance_all_newborn_have_genomes_of_ancestors() -> None:
    """Seed and birth number give the ancestor. No genome depends on a parent, and none is a mutant."""
    heredity = heredity_of(inheritance="founder", ancestors=ANCESTORS)
    for founder in (SOME, SOME | True):
        genome, mutated = made(heredity, founder)
        turns = [(seed + number) % 2**64 % 5 for seed, number in zip(SEEDS, NUMBERS, strict=True)]
        np.testing.assert_array_equal(genome, ANCESTORS[turns])
        assert not mutated.any()


def test_founders_have_the_mutations_notes_for_founders() -> None:
    heredity, founder = heredity_of(mutation=Noted()), SOME
    notes = np.arange(2 * K, dtype=np.int32).reshape(K, 2)
    make = shared(Heredity.make_newborn, heredity)
    newborn = make(births(heredity, founder), PARENTS, notes, None)
    expected = [[3, -1] if founder[row] else [2 * row + 10, 2 * row + 11] for row in range(K)]
    assert newborn.notes.tolist() == expected


def test_empty_cells_of_a_new_world_have_the_notes_of_founders() -> None:
    """A child may take the notes of its cell."""
    law = law_of(MEADOW, cells=3, seeds=2)
    law = replace(law, heredity=replace(law.heredity, mutation=Noted()))
    assert begun(law, np.arange(2, dtype=np.uint64)).organisms.notes.tolist() == [[3, -1]] * 6


OTHERS: list[dict[str, Any]] = [
    {"layout": Layout((("input", (2, 3)), ("output", (2, 3))))},
    {"mutation": Gaussian(probability=0.5, scale=0.2)},
    {"recombination": None},
    {"recombination": Recombination(unit="block")},
    {"inheritance": "founder"},
    {"ancestors": None},
    {"ancestors": ANCESTORS + np.eye(5, 12, dtype=np.float32)},
    {"ancestors": ANCESTORS.reshape(10, 6)},
    {"ancestors": ANCESTORS.view(np.int32)},
    {"worlds": 2},
]


def test_heredities_are_equal_if_all_their_values_are() -> None:
    """Equal heredities share compiled code, so two that differ in any value must not be equal."""
    given = {"recombination": Recombination(), "ancestors": ANCESTORS}
    one, same = heredity_of(**given), heredity_of(**given | {"ancestors": ANCESTORS.copy()})
    assert one == same
    assert hash(one) == hash(same)
    for other in OTHERS:
        assert one != heredity_of(**given | other), other
    assert one != "heredity"
