"""Motors: from outputs to actions. The gaussian motor, which draws, is tested in `test_law.py`."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats import Compound, Continuous, Discrete
from primordia.law.motor import argmax, chosen

ARGMAX = jax.jit(argmax)
SIZES = 2, 3, 5, 8, 18


@pytest.mark.parametrize("size", SIZES)
def test_argmax_is_the_first_of_the_largest_outputs(size: int) -> None:
    rng = np.random.default_rng(size)
    few_values = np.array([-np.inf, -1, -0.0, 0.0, 1e-30, 1, np.inf], np.float32)
    tied = rng.choice(few_values, (500, size))
    output = np.concatenate([tied, rng.normal(size=(500, size)).astype(np.float32)])
    choice = ARGMAX(output)
    assert choice.dtype == jnp.int32
    np.testing.assert_array_equal(choice, output.argmax(axis=1))
    assert len(np.unique(np.asarray(choice))) == size


@pytest.mark.parametrize("size", [2, 3, 18])
def test_a_nan_is_not_chosen_over_a_number_in_the_first_place(size: int) -> None:
    """A NaN in the first place is chosen; its owner dies of a fault in the same tick."""
    rng = np.random.default_rng(size)
    output = rng.normal(size=(500, size)).astype(np.float32)
    output[:, 1:][rng.random((500, size - 1)) < 0.4] = np.nan
    chosen = np.take_along_axis(output, np.asarray(ARGMAX(output))[:, None], axis=1)[:, 0]
    np.testing.assert_array_equal(chosen, np.nanmax(output, axis=1))
    output[:, 0] = np.nan
    assert (np.asarray(ARGMAX(output)) == 0).all()


PEDALS = Compound((Discrete(3), Continuous(2), Discrete(2)))


def test_each_part_of_an_action_has_its_own_outputs() -> None:
    rng = np.random.default_rng(0)
    output, moved = rng.normal(size=(2, 100, 7)).astype(np.float32)
    action = np.asarray(jax.jit(chosen, static_argnums=0)(PEDALS, output, moved))
    assert action.shape == (100, PEDALS.columns) == (100, 4)
    assert action.dtype == np.float32
    np.testing.assert_array_equal(action[:, 0], output[:, :3].argmax(axis=1))
    np.testing.assert_array_equal(action[:, 1:3], moved[:, 3:5])
    np.testing.assert_array_equal(action[:, 3], output[:, 5:].argmax(axis=1))
    assert PEDALS.size == 7


def test_an_action_of_one_part_is_that_part() -> None:
    output = np.random.default_rng(1).normal(size=(9, 3)).astype(np.float32)
    moved = output + 1
    np.testing.assert_array_equal(chosen(Discrete(3), output, moved), output.argmax(axis=1))
    np.testing.assert_array_equal(chosen(Continuous(3), output, moved), moved)
