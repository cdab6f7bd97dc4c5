"""Calibrated mutation: as much change of behaviour as is allowed, in whole steps of length."""

from collections.abc import Callable
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.brains.layout import Layout
from primordia.mutations.blocks import FounderBlock
from primordia.mutations.calibrated import Calibrated
from primordia.mutations.contract import PURPOSES, Change, Draws, Family, Moments
from primordia.mutations.lengths import LENGTHS, LONGEST, SHORTEST
from primordia.random.keys import Purpose, bits, streams
from primordia.random.wide import wide
from primordia.testing import ContractError, check_mutation

LAYOUT = Layout((("input", (3, 7)), ("output", (2, 7))))
K = 64


def family(mutation: Calibrated, **rates: float) -> Family:
    values = {**mutation.rates(LAYOUT), **rates}
    draws = Draws(streams(wide(np.arange(K)), wide(np.zeros(K)), *PURPOSES), jnp.arange(K))
    parents = np.random.default_rng(0).normal(size=(K, LAYOUT.length)).astype(np.float32)
    return Family(
        jnp.asarray(parents),
        jnp.zeros((K, 1), jnp.int32),
        {name: jnp.full(K, value, jnp.float32) for name, value in values.items()},
        draws,
    )


def distance(parents: Array) -> Change:
    return lambda children: jnp.abs(children - parents).max(axis=1)


def share_of_moments(parents: Array) -> Change:
    """Return a change that is a whole number of 64 moments, as that of choices is."""
    return lambda children: jnp.floor(64 * distance(parents)(children)) / 64


def noted(mutation: Calibrated, of: Family, change: Change) -> np.ndarray:
    return np.asarray(mutation.note(LAYOUT, of, change))[:, 0]


@pytest.mark.parametrize(
    ("differs", "kind"),
    [(0.003, distance), (0.1, distance), (0.5, distance)]
    + [(share, share_of_moments) for share in (0.0, 1 / 64, 0.25)],
)
def test_a_length_is_the_largest_that_changes_no_more_than_allowed(
    differs: float, kind: Callable[[Array], Change]
) -> None:
    mutation = Calibrated(probability=1.0, founder_scale=0.3)
    of = family(mutation, differs=differs)
    change = kind(of.parents)
    quarters = noted(mutation, of, change)

    def changed(notes: np.ndarray) -> np.ndarray:
        children, mutants = mutation.inherit(LAYOUT, of._replace(notes=jnp.asarray(notes)[:, None]))
        assert np.asarray(mutants).all()
        return np.asarray(change(children))

    assert (changed(quarters) <= np.float32(differs)).all()
    longer = quarters < 0  # 0 is the end of the scale
    assert (changed(np.minimum(quarters + 1, 0)) > np.float32(differs))[longer].all()
    assert longer.all() == (differs < 0.5)


@pytest.mark.parametrize(("value", "quarters"), [(np.inf, SHORTEST), (np.nan, SHORTEST), (0.0, 0)])
def test_where_nothing_or_everything_is_allowed_the_scale_ends(value: float, quarters: int) -> None:
    mutation = Calibrated(probability=1.0)
    found = noted(mutation, family(mutation), lambda children: jnp.full(len(children), value))
    assert (found == quarters).all()


def test_copies_have_the_parents_genome_and_no_length() -> None:
    mutation = Calibrated(probability=0.5, founder_scale=0.1)
    of = family(mutation)
    quarters = noted(mutation, of, distance(of.parents))
    children, mutants = mutation.inherit(LAYOUT, of._replace(notes=jnp.asarray(quarters)[:, None]))
    copies = ~np.asarray(mutants)
    word = bits(of.draws.streams[Purpose.MUTATE], of.draws.cell).hi
    np.testing.assert_array_equal(copies, np.asarray(word) >= 2**31)
    assert 10 < copies.sum() < K - 10
    np.testing.assert_array_equal(np.asarray(children)[copies], np.asarray(of.parents)[copies])
    assert (quarters[copies] == 0).all()
    assert (quarters[~copies] < 0).all()


def test_noise_has_the_proportions_of_founders() -> None:
    """In each block it is the same noise, times the founders' scale there."""
    own = {"output": FounderBlock(founder_scale=0.03)}
    mutation = Calibrated(probability=1.0, founder_scale=0.3, blocks=own)
    of = family(mutation)._replace(parents=jnp.zeros((K, LAYOUT.length)))
    notes = jnp.full((K, 1), -8, jnp.int32)
    noise = np.asarray(mutation.inherit(LAYOUT, of._replace(notes=notes))[0]) * 4
    one = of.draws.streams.replaced(of.draws.streams[Purpose.NOISE], Purpose.FOUNDER)
    founders = mutation.founders(LAYOUT, of.draws._replace(streams=one))
    np.testing.assert_allclose(noise, founders, rtol=1e-6)
    assert np.asarray(founders)[:, :21].std() > 5 * np.asarray(founders)[:, 21:].std()


def test_lengths_double_with_every_fourth_step() -> None:
    np.testing.assert_array_equal(LENGTHS[4:], 2 * LENGTHS[:-4])
    assert LENGTHS[-SHORTEST] == 1
    assert (LENGTHS[0], LENGTHS[-1]) == (2.0 ** (SHORTEST // 4), 2.0 ** (LONGEST // 4))
    np.testing.assert_allclose(LENGTHS[1:] / LENGTHS[:-1], 2**0.25, rtol=1e-6)


@pytest.mark.slow
def test_it_keeps_the_contract() -> None:
    check_mutation(Calibrated(founder_scale=0.3))
    own: Any = {"hidden": FounderBlock(founder_scale=0.1)}
    with pytest.raises(ContractError, match="no block 'hidden'; it has input"):
        check_mutation(Calibrated(blocks=own))


def test_settings_give_the_number_and_interval_of_moments() -> None:
    assert Calibrated(remembered=5, every=9).moments == Moments(kept=5, every=9)
    assert Calibrated(remembered=256, every=256).moments == Moments(kept=256, every=256)


def test_seasons_change_two_rates_and_a_length_follows_the_present_rates() -> None:
    """Children of one tick may be born in worlds of different climates."""
    mutation = Calibrated(probability=0.0, differs=0.25, founder_scale=0.3)
    assert mutation.rates(LAYOUT) == {"probability": 0.0, "differs": 0.25}
    assert mutation.governed("differs", LAYOUT) == ["differs"]
    assert mutation.governed("founder_scale", LAYOUT) == []
    of = family(mutation)
    odd = np.arange(K) % 2
    small, large = (family(mutation, probability=1.0, differs=each) for each in (0.01, 0.16))
    here = {
        "probability": jnp.ones(K),
        "differs": jnp.asarray(np.where(odd, 0.16, 0.01), jnp.float32),
    }
    quarters = noted(mutation, of._replace(rates=here), distance(of.parents))
    each = [noted(mutation, some, distance(of.parents)) for some in (small, large)]
    np.testing.assert_array_equal(quarters, np.where(odd, each[1], each[0]))
    assert set((each[1] - each[0]).tolist()) <= {15, 16, 17}
    assert not noted(mutation, of, distance(of.parents)).any()
