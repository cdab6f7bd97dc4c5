"""Calibrated mutation: as much change of behaviour as is allowed, in whole steps of length."""

from collections.abc import Callable

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.brains.layout import Layout
from primordia.compiled import shared
from primordia.mutations.blocks import FounderBlock
from primordia.mutations.calibrated import Calibrated
from primordia.mutations.contract import Change, Family
from primordia.mutations.lengths import LENGTHS, LONGEST, SHORTEST
from primordia.random.keys import Purpose, bits
from tests.mutations.families import drawn, inherited, noted, rates

LAYOUT = Layout((("input", (3, 7)), ("output", (2, 7))))
K = 64


def family(mutation: Calibrated, **own: float) -> Family:
    parents = np.random.default_rng(0).normal(size=(K, LAYOUT.length)).astype(np.float32)
    notes = np.zeros((K, 1), np.int32)
    return Family(parents, notes, rates(mutation, LAYOUT, K, **own), drawn(K))


def distance(parents: Array) -> Change:
    return lambda children: jnp.abs(children - parents).max(axis=1)


def share_of_moments(parents: Array) -> Change:
    """Return a change that is a whole number of 64 moments, as that of choices is."""
    return lambda children: jnp.floor(64 * distance(parents)(children)) / 64


def extremes(parents: Array) -> Change:
    """Return a change of infinity, NaN, 0, infinity, ..., whatever the children are."""
    return lambda children: jnp.resize(jnp.array([jnp.inf, jnp.nan, 0.0]), len(children))


@pytest.mark.parametrize(
    ("differs", "kind"),
    [
        (0.1, distance),
        (1 / 64, share_of_moments),
        *(pytest.param(much, distance, marks=pytest.mark.slow) for much in (0.003, 0.5)),
        *(pytest.param(share, share_of_moments, marks=pytest.mark.slow) for share in (0.0, 0.25)),
    ],
)
def test_a_length_is_the_largest_that_changes_no_more_than_allowed(
    differs: float, kind: Callable[[Array], Change]
) -> None:
    mutation = Calibrated(probability=1.0, founder_scale=0.3)
    of = family(mutation, differs=differs)
    quarters = noted(mutation, LAYOUT, of, kind)

    def changed(notes: np.ndarray) -> np.ndarray:
        children, mutants = inherited(mutation, LAYOUT, of._replace(notes=notes[:, None]))
        assert mutants.all()
        return np.asarray(kind(of.parents)(children))

    assert (changed(quarters) <= np.float32(differs)).all()
    longer = quarters < 0  # 0 is the end of the scale
    assert (changed(np.minimum(quarters + 1, 0)) > np.float32(differs))[longer].all()
    assert longer.all() == (differs < 0.5)


def test_where_nothing_or_everything_is_allowed_the_scale_ends() -> None:
    mutation = Calibrated(probability=1.0, founder_scale=0.3)
    found = noted(mutation, LAYOUT, family(mutation), extremes)
    np.testing.assert_array_equal(found, np.resize([SHORTEST, SHORTEST, 0], K))


def test_copies_have_the_parents_genome_and_no_length() -> None:
    mutation = Calibrated(probability=1.0, founder_scale=0.3)
    of = family(mutation, probability=0.5)
    quarters = noted(mutation, LAYOUT, of, distance)
    children, mutants = inherited(mutation, LAYOUT, of._replace(notes=quarters[:, None]))
    copies = ~mutants
    word = bits(of.draws.streams[Purpose.MUTATE], of.draws.cell).hi
    np.testing.assert_array_equal(copies, np.asarray(word) >= 2**31)
    assert 10 < copies.sum() < K - 10
    np.testing.assert_array_equal(children[copies], of.parents[copies])
    assert (quarters[copies] == 0).all()
    assert (quarters[~copies] < 0).all()


def test_noise_has_the_proportions_of_founders() -> None:
    """In each block it is the same noise, times the founders' scale there."""
    own = {"output": FounderBlock(founder_scale=0.03)}
    mutation = Calibrated(probability=1.0, founder_scale=0.3, blocks=own)
    of = family(mutation)._replace(parents=np.zeros((K, LAYOUT.length), np.float32))
    notes = np.full((K, 1), -8, np.int32)
    noise = inherited(mutation, LAYOUT, of._replace(notes=notes))[0] * 4
    one = of.draws.streams.replaced(of.draws.streams[Purpose.NOISE], Purpose.FOUNDER)
    draws = of.draws._replace(streams=one)
    founders = np.asarray(shared(Calibrated.founders, mutation, LAYOUT)(draws))
    np.testing.assert_allclose(noise, founders, rtol=1e-6)
    assert founders[:, :21].std() > 5 * founders[:, 21:].std()


def test_lengths_double_with_every_fourth_step() -> None:
    np.testing.assert_array_equal(LENGTHS[4:], 2 * LENGTHS[:-4])
    assert LENGTHS[-SHORTEST] == 1
    assert (LENGTHS[0], LENGTHS[-1]) == (2.0 ** (SHORTEST // 4), 2.0 ** (LONGEST // 4))
    np.testing.assert_allclose(LENGTHS[1:] / LENGTHS[:-1], 2**0.25, rtol=1e-6)


def test_seasons_change_two_rates_and_a_length_follows_the_present_rates() -> None:
    """Children of one tick may be born in worlds of different climates."""
    stated = Calibrated(probability=0.0, differs=0.25, founder_scale=0.3)
    assert stated.rates(LAYOUT) == {"probability": 0.0, "differs": 0.25}
    assert stated.governed("differs", LAYOUT) == ["differs"]
    assert stated.governed("founder_scale", LAYOUT) == []
    mutation = Calibrated(probability=1.0, founder_scale=0.3)
    of = family(mutation, **stated.rates(LAYOUT))
    odd = np.arange(K) % 2
    small, large = (family(mutation, probability=1.0, differs=each) for each in (0.01, 0.16))
    here = {
        "probability": np.ones(K, np.float32),
        "differs": np.where(odd, 0.16, 0.01).astype(np.float32),
    }
    quarters = noted(mutation, LAYOUT, of._replace(rates=here), distance)
    each = [noted(mutation, LAYOUT, some, distance) for some in (small, large)]
    np.testing.assert_array_equal(quarters, np.where(odd, each[1], each[0]))
    assert set((each[1] - each[0]).tolist()) <= {15, 16, 17}
    assert not noted(mutation, LAYOUT, of, distance).any()
