"""Pictures of environments in JAX: grids of colours, or bars."""

import colorsys
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats.framed import MARGIN
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.habitats.gymnax.picture import BAR, GROUND, WIDTH, draw, draw_view
from primordia.habitats.gymnax.spaces import View


def test_a_cell_of_a_grid_has_the_colour_of_its_last_channel_that_is_not_zero() -> None:
    """A share between 0 and 1 is a mixture with the ground; a larger one is the whole colour."""
    grid = np.zeros((2, 4, 5), np.float32)
    grid[0, 1, 3] = 1
    grid[0, 2, [1, 4]] = 1
    grid[1, 0, 2] = 0.5
    grid[1, 3, 0] = 7
    grid[1, 1, 0] = -1
    colour = [255 * np.array(colorsys.hsv_to_rgb(hue / 5, 0.65, 0.95)) for hue in range(5)]
    expected = np.tile(GROUND.astype(float), (2, 4, 1))
    expected[0, 1], expected[0, 2], expected[1, 3] = colour[3], colour[4], colour[0]
    expected[1, 0] = (GROUND + colour[2]) / 2
    picture = np.asarray(draw(grid.ravel(), (2, 4, 5)))
    assert picture.shape == (MARGIN + 2 * 100, 4 * 100, 3)
    for row in range(2):
        for column in range(4):
            cell = picture[MARGIN + 100 * row :, 100 * column :][:100, :100]
            np.testing.assert_allclose(cell, np.tile(expected[row, column], (100, 100, 1)), atol=1)


@pytest.mark.parametrize("count", [2, 5, WIDTH, 2 * WIDTH])
def test_a_sense_is_a_bar_from_the_middle_up_or_down(count: int) -> None:
    """The bars of +1 and -1, which larger senses have too, end 4 pixels before the edge."""
    senses = np.zeros(count, np.float32)
    senses[0], senses[1], senses[-1] = 0.5, -3.0, np.nan if count > 2 else -3.0
    picture = np.asarray(draw(senses, None))[MARGIN:]
    width = max(count, WIDTH)
    assert picture.shape == (WIDTH // 2, width, 3)
    middle, each = WIDTH // 4, width / count
    bar = (picture == np.array([int(BAR[k : k + 2], 16) for k in (1, 3, 5)])).all(axis=2)
    for place, (top, bottom) in enumerate(((middle - 48, middle), (middle, middle + 96))):
        rows = np.flatnonzero(bar[:, int((place + 0.4) * each)])
        assert (rows.min(), rows.max()) == pytest.approx((top, bottom), abs=1)
    above, below = (np.flatnonzero(part.any(axis=0)) for part in (bar[:middle], bar[middle + 1 :]))
    assert (above.min(), above.max()) == (0, max(round(0.8 * each) - 1, 0))
    assert (below.min(), below.max()) == (round(each), max(round(1.8 * each) - 1, round(each)))


class Meadow:
    """An environment whose state is its observation."""

    def observe(self, key: Any, state: Any, action: Any, params: Any) -> Any:
        return state


class Legacy:
    """An environment whose states cannot be observed again."""

    def observe(self, key: Any, state: Any, action: Any, params: Any) -> Any:
        raise NotImplementedError


@pytest.mark.parametrize(
    ("player", "first", "last"), [((3, 4), (40, 80), (239, 279)), ((9, 0), (280, 0), (399, 119))]
)
def test_a_picture_of_a_view_is_the_whole_grid_with_a_frame_around_what_is_perceived(
    player: tuple[int, int], first: tuple[int, int], last: tuple[int, int]
) -> None:
    """The frame is 4 pixels wide. At the border of the grid it goes on outside the picture."""
    grid, view = np.zeros((10, 10, 2), np.float32), View((10, 10, 2), 0, 2)
    grid[*player, 0] = grid[8, 8, 1] = 1
    whole = np.asarray(draw(grid.ravel(), grid.shape))[MARGIN:]
    framed = draw_view(Meadow(), jnp.asarray(grid), None, view)
    assert framed is not None
    changed = (np.asarray(framed)[MARGIN:] != whole).any(axis=2)
    places = np.argwhere(changed)
    assert (tuple(places.min(axis=0)), tuple(places.max(axis=0))) == (first, last)
    assert not changed[first[0] + 4 : last[0] - 3, 84 if first[1] else 0 : last[1] - 3].any()


@pytest.mark.parametrize("env", [object(), Legacy()])
def test_there_is_no_picture_of_a_view_if_a_state_cannot_be_observed_again(env: Any) -> None:
    assert draw_view(env, np.zeros((3, 3, 1)), None, View((3, 3, 1), 0, 1)) is None


class Painted:
    """An environment that draws itself: its state is a shade of grey, which an action darkens."""

    default_params = SimpleNamespace(step=20)

    def reset_env(self, key: Any, params: Any) -> Any:
        return jnp.zeros(1), {"shade": jnp.int32(200)}

    def step_env(self, key: Any, state: Any, action: Any, params: Any) -> Any:
        return jnp.zeros(1), {"shade": state["shade"] - params.step * action}, 0.0, False, {}

    def action_space(self, params: Any) -> Any:
        return SimpleNamespace(n=2)

    def observation_space(self, params: Any) -> Any:
        return SimpleNamespace(low=0.0, high=1.0, shape=(1,))

    def picture(self, state: Any, params: Any) -> Any:
        return np.full((2, 3, 3), state["shade"] + params.step)


def test_an_environment_of_your_own_may_draw_its_pictures() -> None:
    habitat = Gymnax(env=f"{__name__}:Painted")
    bodies, _ = habitat.step(habitat.reset(np.zeros((1, 2), np.uint32)), np.ones(1, np.int32))
    alone = jax.tree.map(lambda each: each[0], bodies)
    drawn = np.asarray(habitat.picture(alone, np.int32(1)))[MARGIN:]
    assert drawn.tolist() == np.full((2, 3, 3), 200 - 20 + 20).tolist()
