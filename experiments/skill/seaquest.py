"""MinAtar's Seaquest as Pgx computes it (Koyamada et al. 2023), with few senses: the cells around the
submarine, and the gauges of oxygen and of divers.

    pip install --no-deps pgx pgx-minatar svgwrite

gymnax's own Seaquest takes twenty times as long.
"""

from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from pgx_minatar.seaquest import MinAtarSeaquest

SUBMARINE, OXYGEN, DIVERS = 0, 7, 8
"""channels of the grid (10, 10, 10); the gauges are in its last row"""
AROUND = np.array([1, 2, 3, 4, 5, 6, 9])
"""channels of what can be around: the submarine's back, bullets, trails, enemies, divers"""
SIZE = 10
"""rows and columns of the grid"""
COLOURS = np.array(
    [[24, 26, 32], [242, 196, 60], [190, 150, 50], [240, 240, 240], [70, 74, 86], [240, 100, 60],
     [200, 80, 160], [150, 90, 210], [90, 170, 240], [120, 210, 120], [120, 230, 190]], np.uint8,
)  # fmt: skip
"""of an empty cell, and of each channel"""
ZOOM = 40
"""pixels of a cell"""


class Seaquest:
    """The game with the interface of gymnax. `info` says whether the submarine is under water.

    Senses are 0 or 1: for each of the cells within `sight` seven channels and whether it is outside
    the grid, then ten of oxygen, and six of divers on board.
    """

    default_params = SimpleNamespace()
    sight = 1

    def __init__(self) -> None:
        """Make the game without its sticky actions, which are a setting of the habitat."""
        self._game = MinAtarSeaquest(sticky_action_prob=0.0)

    def reset_env(self, key: Array, params: Any) -> tuple[Array, Any]:
        """Return senses and state at the start, at the surface."""
        state = self._game.init(key)
        return self._senses(state.observation), state

    def step_env(self, key: Array, state: Any, action: Array, params: Any) -> tuple:
        """Return senses, state, points, whether the game is over, and `info`."""
        state = self._game.step(state, action, key)
        grid = state.observation
        under = grid[1:, :, SUBMARINE].any()
        return self._senses(grid), state, state.rewards[0], state.terminated, {"under": under}

    def _senses(self, grid: Array) -> Array:
        reach, margin = 2 * self.sight + 1, [(self.sight, self.sight)] * 2
        place = divmod(jnp.argmax(grid[..., SUBMARINE]), SIZE)
        cells = jnp.pad(grid[..., AROUND], [*margin, (0, 0)])
        outside = jnp.pad(jnp.zeros((SIZE, SIZE, 1), bool), [*margin, (0, 0)], constant_values=True)
        cells = jnp.concatenate([cells, outside], axis=2)
        near = lax.dynamic_slice(cells, (*place, 0), (reach, reach, cells.shape[2]))
        parts = near.ravel(), grid[-1, :, OXYGEN], grid[-1, 3:9, DIVERS]
        return jnp.concatenate(parts).astype(jnp.float32)

    def action_space(self, params: Any) -> Any:
        """Return the six buttons: nothing, left, up, right, down, fire."""
        return SimpleNamespace(n=6)

    def observation_space(self, params: Any) -> Any:
        """Return the bounds of senses."""
        size = (2 * self.sight + 1) ** 2 * (len(AROUND) + 1) + SIZE + 6
        return SimpleNamespace(low=0.0, high=1.0, shape=(size,))

    def picture(self, state: Any, params: Any) -> np.ndarray:
        """Return the whole grid with a frame around what is perceived, uint8 (H, W, 3)."""
        grid = np.asarray(state.observation)
        last = (grid * np.arange(1, grid.shape[2] + 1)).max(axis=2)
        pixels = COLOURS[last].repeat(ZOOM, axis=0).repeat(ZOOM, axis=1)
        row, column = divmod(int(grid[..., SUBMARINE].argmax()), SIZE)
        corner = max(row - self.sight, 0) * ZOOM, max(column - self.sight, 0) * ZOOM
        inside = pixels[
            corner[0] : (row + self.sight + 1) * ZOOM, corner[1] : (column + self.sight + 1) * ZOOM
        ]
        for edge in (inside[:3], inside[-3:], inside[:, :3], inside[:, -3:]):
            edge[:] = 250
        return pixels
