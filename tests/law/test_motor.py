"""Motors: from outputs to actions. The gaussian motor, which draws, is tested in `test_law.py`."""

import jax
import numpy as np
import pytest

from primordia.habitats import Compound, Continuous, Discrete
from primordia.law.motor import argmax, chosen

ARGMAX = jax.jit(argmax)


@pytest.mark.parametrize("size", [2, 18])
def test_argmax_is_the_first_of_the_largest_outputs(size: int) -> None:
    """A NaN in the first place is chosen; its owner dies of a fault in the same tick. In other places it
    is not chosen over a number."""
    rng = np.random.default_rng(size)
    few_values = np.array([-np.inf, -1, -0.0, 0.0, 1e-30, 1, np.inf], np.float32)
    tied = rng.choice(few_values, (500, size))
    output = np.concatenate([tied, rng.normal(size=(500, size)).astype(np.float32)])
    choice = np.asarray(ARGMAX(output))
    assert choice.dtype == np.int32
    np.testing.assert_array_equal(choice, output.argmax(axis=1))
    assert len(np.unique(choice)) == size
    output[:, 1:][rng.random((1000, size - 1)) < 0.4] = np.nan
    output[-1, 0] = np.nan
    chosen = np.take_along_axis(output, np.asarray(ARGMAX(output))[:, None], axis=1)[:, 0]
    np.testing.assert_array_equal(chosen[:-1], np.nanmax(output[:-1], axis=1))
    assert np.isnan(chosen[-1])


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
