"""Spaces of environments in JAX: which numbers are scaled, and which observations are grids."""

from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from primordia.habitats.gymnax.spaces import Actions, Senses


@pytest.mark.parametrize(("bound", "scaled"), [(0.9e6, True), (1e6, False), (np.inf, False)])
def test_a_bound_of_a_million_is_no_bound(bound: float, scaled: bool) -> None:
    for low, high in ((-bound, bound), (-2.0, bound), (-bound, 2.0)):
        space = SimpleNamespace(low=low, high=high, shape=(3,))
        senses = Senses(space, jax.ShapeDtypeStruct((3,), jnp.float32), squash=False)
        assert senses.unbounded().tolist() == [not scaled] * 3
        values = np.float32([-2, 0, 2])
        middle, half = (low + high) / 2, (high - low) / 2
        expected = (values - middle) / half if scaled else values
        np.testing.assert_allclose(senses.of(values), expected, atol=1e-5)
        actions = Actions(space, "any")
        filled = [middle - half, middle + half / 2, middle + half] if scaled else [-1, 0.5, 7]
        np.testing.assert_allclose(
            actions.of(jnp.float32([-1, 0.5, 7])), filled, rtol=1e-6, atol=0.1
        )


def test_an_observation_at_a_bound_is_in_its_space() -> None:
    space = SimpleNamespace(low=np.float32([-1, 0]), high=np.float32([1, 9]), shape=(2,))
    senses = Senses(space, jax.ShapeDtypeStruct((2,), jnp.float32), squash=False)
    rows = [[-1, 0], [1, 9], [-1.01, 0], [0, 9.01], [1.01, 5], [0, -0.01]]
    assert jax.jit(senses.declared)(np.float32(rows)).tolist() == [True, True, *[False] * 4]
    room = Senses(SimpleNamespace(n=4), jax.ShapeDtypeStruct((), jnp.int32), squash=False)
    rooms = np.float32([[-1], [0], [3], [4]])
    assert jax.jit(room.declared)(rooms).tolist() == [False, True, True, False]


@pytest.mark.parametrize(
    ("shape", "grid"),
    [((4, 5), (4, 5, 1)), ((4, 5, 2), (4, 5, 2)), ((4,), None), ((2, 3, 4, 5), None), ((), None)],
)
def test_a_grid_has_height_width_and_channels(shape: tuple[int, ...], grid: Any) -> None:
    senses = Senses(None, jax.ShapeDtypeStruct(shape, jnp.float32), squash=False)
    assert (senses.grid, senses.size) == (grid, np.prod(shape))
    pair = [jax.ShapeDtypeStruct((4, 5), jnp.float32)] * 2
    assert Senses(None, pair, squash=False).grid is None


def test_any_numbers_are_in_a_space_that_says_nothing_of_them() -> None:
    senses = Senses(None, jax.ShapeDtypeStruct((2,), jnp.float32), squash=False)
    assert senses.declared(np.float32([[-1e30, 1e30], [0, -5]])).all()


@given(st.integers(-800, 800), st.integers(0, 800))
@example(0, 16)
@example(40, 8)
def test_a_box_becomes_minus_one_to_one_unless_it_is_within_these_or_a_point(
    first: int, count: int
) -> None:
    low, width = first / 8, count / 8  # exact, so that a bound of 1 is no more than 1
    space = SimpleNamespace(low=low, high=low + width, shape=(3,))
    senses = Senses(space, jax.ShapeDtypeStruct((3,), jnp.float32), squash=False)
    places = np.float32([low, low + width / 2, low + width])
    kept = width == 0 or max(-low, low + width) <= 1
    np.testing.assert_allclose(senses.of(places), places if kept else [-1, 0, 1], atol=1e-3)


@pytest.mark.parametrize(("sight", "reach"), [(None, 4), (1, 1)])
def test_a_player_perceives_what_lies_around_it(sight: int | None, reach: int) -> None:
    """Everything that is seen is compared with a plain loop over the cells around the player."""
    rng = np.random.default_rng(0)
    senses = Senses(None, jax.ShapeDtypeStruct((3, 5, 2), jnp.float32), False, 1, sight)
    assert senses.grid == (2 * reach + 1, 2 * reach + 1, 2)
    of = jax.jit(senses.of)
    for row, column in np.ndindex(3, 5):
        grid = rng.random((3, 5, 2)).astype(np.float32)
        grid[..., 1] = 0
        grid[row, column, 1] = 1
        seen = np.asarray(of(grid)).reshape(senses.grid)
        for y, x in np.ndindex(seen.shape[:2]):
            there = (row + y - reach, column + x - reach)
            within = 0 <= there[0] < 3 and 0 <= there[1] < 5
            np.testing.assert_array_equal(seen[y, x], [grid[*there, 0], 0] if within else [0, 1])


def test_a_centre_that_is_no_channel_of_a_grid_is_refused() -> None:
    for shape, centre in (((4, 5, 2), 2), ((9,), 0)):
        with pytest.raises(ValueError, match=f"no grid with a channel {centre}"):
            Senses(None, jax.ShapeDtypeStruct(shape, jnp.float32), False, centre)
