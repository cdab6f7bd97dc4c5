"""Motors: from outputs to actions. The gaussian motor, which draws, is tested in `test_law.py`."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law.motor import argmax

ARGMAX = jax.jit(argmax)
SIZES = range(2, 19)


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
