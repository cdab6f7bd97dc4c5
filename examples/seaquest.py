"""MinAtar's Seaquest as an environment with gymnax's interface; players perceive the cells around them.

The task is `seaquest.toml`, and the rules are in `seaquest_rules.py`.
"""

from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from examples.seaquest_rules import (
    ABOARD,
    FLOOR,
    OXYGEN,
    SIDE,
    Divers,
    Enemies,
    State,
    ahead,
    draws,
    first,
    on_screen,
    tick,
)
from jax import Array

SIGHT = 1
"""cells perceived on each side of the submarine"""
SEA, GROUND, FRONT, TANK = (16, 42, 74), (24, 26, 32), (255, 220, 80), (120, 190, 250)
BACK, SHOT, TRAIL, BULLET = (200, 150, 40), (255, 255, 255), (40, 74, 112), (250, 110, 90)
FISH, SUBMARINE, DIVER = (110, 200, 120), (220, 70, 70), (235, 170, 235)


def cells(state: State, rows: Array, columns: Array) -> Array:
    """Return what is in cells, bool (rows, columns, 8).

    The first channel is true beyond the screen, the others are MinAtar's: the submarine's back, its
    bullets, trails, the enemies' bullets, fish, enemy submarines, divers.
    """
    enemies, divers, shots = state.enemies, state.divers, state.shots

    def shown(there: Array, x: Array, y: Array) -> Array:
        in_row, in_column = y == rows[:, None], there & (x == columns[:, None])
        return (in_row[:, None] & in_column).any(-1)

    def trail(group: Enemies | Divers) -> Array:
        x = ahead(group.x, ~group.right, group.there)
        return shown(group.there & on_screen(x), x, group.y)

    back = ahead(state.x, ~state.right, jnp.bool_(True))
    channels = (
        ~on_screen(rows)[:, None] | ~on_screen(columns),
        shown(jnp.bool_(True), back[None], state.y[None]),
        shown(shots.there, shots.x, shots.y),
        trail(enemies) | trail(divers),
        shown(enemies.bullet, enemies.bullet_x, enemies.y),
        shown(enemies.there & ~enemies.armed, enemies.x, enemies.y),
        shown(enemies.there & enemies.armed, enemies.x, enemies.y),
        shown(divers.there, divers.x, divers.y),
    )
    return jnp.stack(channels, axis=-1)


def gauges(state: State) -> tuple[Array, Array]:
    """Return the filled cells of the gauges of oxygen, bool (10,), and of divers on board, bool (6,)."""
    return jnp.arange(SIDE) < state.oxygen * 10 // OXYGEN, jnp.arange(ABOARD) < state.aboard


@jax.jit
def _screen(state: State) -> Array:
    """Return the colours of the screen, uint8 (10, 10, 3), with the gauges in the last row."""
    every = jnp.arange(SIDE)
    picture = jnp.where((every <= FLOOR)[:, None, None], jnp.array(SEA), jnp.array(GROUND))
    picture = jnp.broadcast_to(picture, (SIDE, SIDE, 3))
    shown = cells(state, every, every)[:, :, 1:]
    for channel, colour in enumerate((BACK, SHOT, TRAIL, BULLET, FISH, SUBMARINE, DIVER)):
        picture = jnp.where(shown[:, :, channel, None], jnp.array(colour), picture)
    picture = picture.at[state.y, state.x].set(jnp.array(FRONT))
    oxygen, _ = gauges(state)
    aboard = (every < SIDE - 1) & (every >= SIDE - 1 - state.aboard)
    for gauge, colour in ((oxygen, TANK), (aboard, DIVER)):
        picture = picture.at[-1].set(jnp.where(gauge[:, None], jnp.array(colour), picture[-1]))
    return picture.astype(jnp.uint8)


class Seaquest:
    """Seaquest with gymnax's interface. Senses are the cells around the submarine, and both gauges."""

    name = "Seaquest-MinAtar"
    action_set = np.arange(6)
    default_params = SimpleNamespace()

    def reset_env(self, key: Any, params: Any) -> tuple[Array, State]:
        """Return the first senses and state."""
        state = first()
        return senses(state), state

    def step_env(self, key: Any, state: State, action: Array, params: Any) -> tuple:
        """Return senses, state, points, whether the game is over, and whether it is `under` water."""
        state, points, over = tick(state, action, draws(key))
        return senses(state), state, points, over, {"under": state.y > 0}

    def action_space(self, params: Any) -> Any:
        """Return MinAtar's actions: nothing, left, up, right, down, fire."""
        return SimpleNamespace(n=6, shape=(), dtype=jnp.int32)

    def observation_space(self, params: Any) -> Any:
        """Return the bounds of the senses."""
        return SimpleNamespace(
            low=0.0, high=1.0, shape=jax.eval_shape(lambda: senses(first())).shape
        )

    def picture(self, state: State, params: Any) -> np.ndarray:
        """Return the screen."""
        return np.kron(np.asarray(_screen(state)), np.ones((40, 40, 1), np.uint8))


def senses(state: State) -> Array:
    """Return the cells that a player perceives and the gauges, bool (S,)."""
    around = jnp.arange(-SIGHT, SIGHT + 1)
    near = cells(state, state.y + around, state.x + around)
    return jnp.concatenate([near.ravel(), *gauges(state)])
