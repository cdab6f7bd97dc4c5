"""Heritable mutation: the size of mutations is inherited, and mutates in whole steps."""

import numpy as np

from primordia.mutations.contract import Family
from primordia.mutations.gaussian import Block, Gaussian
from primordia.mutations.heritable import Heritable
from primordia.random.keys import Purpose, bits
from tests.chance import binomial
from tests.mutations.families import drawn, inherited, noted, rates
from tests.mutations.test_gaussian import LAYOUT

K = 4_000


def family(mutation: Gaussian, quarters: int = 0) -> Family:
    parents = np.zeros((K, LAYOUT.length), np.float32)
    notes = np.full((K, 1), quarters, np.int32)
    return Family(parents, notes, rates(mutation, LAYOUT, K), drawn(K))


def test_the_step_of_a_mutant_is_drawn_by_its_second_word() -> None:
    """Draw 0 of a birth decides whether the child is a mutant. Draw 1 gives the change of q."""
    mutation = Heritable(stride=3, probability=0.5)
    of = family(mutation, 5)
    first, second = (
        np.asarray(bits(of.draws.streams[Purpose.MUTATE], of.draws.cell, draw).hi).astype(int)
        for draw in (0, 1)
    )
    expected = np.where(first < 2**31, 5 + (second * 7 >> 32) - 3, 5)
    np.testing.assert_array_equal(noted(mutation, LAYOUT, of), expected)


def test_the_exponent_takes_a_step_only_if_a_block_mutates() -> None:
    blocks = {"input": Block(probability=0.0), "recurrent": Block(probability=0.6)}
    mutation = Heritable(probability=0.2, blocks=blocks, stride=16)
    notes = noted(mutation, LAYOUT, family(mutation))
    children, mutants = inherited(mutation, LAYOUT, family(mutation))
    assert binomial(int(mutants.sum()), K, 0.6)
    np.testing.assert_array_equal(mutants, (children != 0).any(axis=1))
    assert not notes[~mutants].any()
    assert binomial(int((notes[mutants] == 0).sum()), int(mutants.sum()), 1 / 33)


def test_the_settings_bound_the_exponent_on_both_sides() -> None:
    mutation = Heritable(probability=1.0, stride=16, finest=-3, coarsest=5)
    notes = noted(mutation, LAYOUT, family(mutation, 1))
    assert np.unique(notes).tolist() == list(range(-3, 6))
    assert binomial(int((notes == -3).sum()), K, 13 / 33)
    assert binomial(int((notes == 5).sum()), K, 13 / 33)
    assert (Heritable().finest, Heritable().coarsest) == (-48, 16)


def test_each_child_has_the_noise_of_its_own_exponent_and_of_its_blocks_scale() -> None:
    blocks = {"output": Block(scale=0.125)}
    fixed = Gaussian(probability=1.0, scale=0.5, blocks=blocks)
    mutation = Heritable(probability=1.0, scale=0.5, blocks=blocks)
    quarters = np.arange(K) % 5 * 4 - 8
    of = family(mutation)._replace(notes=quarters[:, None].astype(np.int32))
    base = inherited(fixed, LAYOUT, family(fixed))[0]
    noise = inherited(mutation, LAYOUT, of)[0]
    np.testing.assert_array_equal(noise, base * 2.0 ** (quarters[:, None] / 4))
