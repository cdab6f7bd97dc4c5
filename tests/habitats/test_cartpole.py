"""CartPole equals Gymnasium's environment, step for step."""

import math
from itertools import permutations
from typing import Any

import gymnasium
import jax
import numpy as np
import pytest

from primordia.compiled import shared
from primordia.habitats.cartpole.habitat import COORDINATES, CartPole
from primordia.habitats.cartpole.picture import draw

LIMITS = np.array([2.4, np.inf, np.deg2rad(12), np.inf])


@pytest.fixture
def gym_cartpole() -> gymnasium.Env:
    return gymnasium.make("CartPole-v1").unwrapped


def random_states(count: int) -> np.ndarray:
    rng = np.random.default_rng(7)
    spread = np.array([2.6, 3.0, 0.25, 3.0])
    return rng.uniform(-spread, spread, (count, 4)).astype(np.float32)


def test_one_step_from_the_same_state_agrees_with_gymnasium(gym_cartpole: Any) -> None:
    states = random_states(2000)
    actions = np.arange(len(states)) % 2
    after, outcome = jax.jit(CartPole().step)(states, actions)
    expected, terminated = np.zeros((len(states), 4)), np.zeros(len(states), bool)
    gym_cartpole.reset()
    for i, state in enumerate(states):
        gym_cartpole.state, gym_cartpole.steps_beyond_terminated = state.astype(np.float64), None
        _, _, terminated[i], _, _ = gym_cartpole.step(int(actions[i]))
        expected[i] = gym_cartpole.state
    np.testing.assert_allclose(after, expected, rtol=1e-6, atol=1e-7)
    near_a_limit = (np.abs(np.abs(expected) - LIMITS) < 1e-6).any(axis=1)
    np.testing.assert_array_equal(
        np.asarray(outcome.fatal)[~near_a_limit], terminated[~near_a_limit]
    )
    assert near_a_limit.sum() < 5
    assert 0.1 < np.mean(outcome.fatal) < 0.9


def test_bodies_start_uniform_within_the_spread() -> None:
    words = np.random.default_rng(0).integers(0, 2**32, (100_000, 4), dtype=np.uint32)
    bodies = np.asarray(CartPole().reset(words))
    assert np.abs(bodies).max() <= 0.05
    np.testing.assert_allclose(bodies.mean(axis=0), 0, atol=5 * 0.1 / np.sqrt(12 * 1e5))
    np.testing.assert_allclose(bodies.std(axis=0), 0.1 / np.sqrt(12), rtol=0.01)
    extremes = np.array([[0] * 4, [2**32 - 1] * 4], np.uint32)
    for spread in (0.05, 2.0, 0.0):
        bodies = CartPole(spread=spread).reset(extremes)
        np.testing.assert_allclose(bodies, [[-spread] * 4, [spread] * 4], rtol=2e-6)


def test_senses_come_in_the_order_of_the_settings() -> None:
    states: Any = random_states(5)
    for places in [*permutations(range(4)), *permutations(range(4), 2)]:
        ordered = CartPole(senses=tuple(COORDINATES[place] for place in places))
        assert ordered.senses_size == len(places)
        np.testing.assert_array_equal(ordered.sense(states), states[:, places])


STATES = np.zeros((9, 4), np.float32)
STATES[:4, 0] = 2.5, 2.0, -2.0, -2.001
STATES[4:, 2] = 0.2, 0.22, *np.deg2rad([45, -45, -45.01])
"""Bodies off the middle of the track, and bodies that lean."""


@pytest.mark.parametrize(
    ("change", "fatal"),
    [
        ({}, [1, 0, 0, 0, 0, 1, 1, 1, 1]),
        ({"angle_limit": 24.0}, [1, 0, 0, 0, 0, 0, 1, 1, 1]),
        ({"track_limit": 1e9}, [0, 0, 0, 0, 0, 1, 1, 1, 1]),
        ({"track_limit": 2.0, "angle_limit": 45.0}, [1, 0, 0, 1, 0, 0, 0, 0, 1]),
    ],
)
def test_limits_are_settings(change: dict, fatal: list[int]) -> None:
    """A body exactly at a limit is alive."""
    habitat = CartPole(**change)
    _, outcome = shared(CartPole.step, habitat)(STATES, np.zeros(9, np.int32))
    assert np.asarray(outcome.fatal).tolist() == [bool(each) for each in fatal]


def coloured(picture: np.ndarray, colour: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Return rows and columns of the pixels of a colour."""
    rows, columns = np.nonzero(np.abs(picture.astype(int) - colour).sum(axis=2) < 20)
    return rows, columns


@pytest.mark.parametrize("angle", [-60.0, 30.0, 100.0])
def test_the_pole_is_drawn_at_its_angle(angle: float) -> None:
    """The pole is 150 pixels long. At a positive angle it leans to the right."""
    theta = math.radians(angle)
    picture = np.asarray(draw(np.array([0, 0, theta, 0], np.float32), 1, 2.4))
    rows, columns = coloured(picture, (200, 85, 61))
    far = np.argmax(np.hypot(columns - 320, rows - 240))
    assert columns[far] - 320 == pytest.approx(155 * math.sin(theta), abs=6)
    assert 240 - rows[far] == pytest.approx(155 * math.cos(theta), abs=6)


@pytest.mark.parametrize(
    ("limit", "x", "middle"),
    [(5.0, 2.5, 450), (1.0, -1.0, 60), (99.0, 49.5, 450), (100.0, 1.2, 450), (1e9, -2.4, 60)],
)
def test_the_track_is_as_long_as_its_limit_and_has_ends_where_it_is_limited(
    limit: float, x: float, middle: int
) -> None:
    """A track with a limit of 100 or more is drawn with the default length and without ends."""
    picture = np.asarray(draw(np.array([x, 0, 0, 0], np.float32), 1, limit))
    columns = coloured(picture, (35, 57, 91))[1]
    assert (columns.min() + columns.max()) / 2 == pytest.approx(middle, abs=4)
    grey = set(coloured(picture[:276], (138, 138, 138))[1].tolist())
    for end in {60, 580} - {middle}:
        assert (end in grey) == (limit < 100)
    assert grey <= {*range(57, 64), *range(577, 584)}


def test_an_arrow_at_the_side_of_the_push_points_at_the_cart() -> None:
    """Action 1 pushes the left side of the cart. The habitat draws with its own limit."""
    for action, sign in ((0, 1), (1, -1)):
        body = np.array([1.0, 0, 0, 0], np.float32)
        picture = CartPole(track_limit=5.0).picture(body, np.int32(action))
        assert picture.tobytes() == draw(body, action, 5.0).tobytes()
        rows, columns = coloured(np.asarray(picture.convert("RGB")), (224, 160, 48))
        away = sign * (columns - (320 + 260 / 5))
        assert 37 < away.min() < away.max() < 75
        heights = [np.ptp(rows[away == distance]) for distance in (50, 60, 68)]
        assert heights[0] > heights[1] == heights[2]
