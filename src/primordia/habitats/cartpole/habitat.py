"""CartPole: a pole on a cart, pushed left or right (Barto, Sutton & Anderson 1983).

Physics, units and order of integration (explicit Euler) are those of Gymnasium's CartPole-v1;
`tests/habitats/test_cartpole.py` holds the two together. Schmidgall & Hays 2021,
"CartPole-survival": an organism lives until the pole falls beyond a limit.
"""

import math
from typing import TYPE_CHECKING, Literal

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.habitats.contract import Discrete, JaxHabitat, Outcome
from primordia.settings.base import Settings

if TYPE_CHECKING:
    from PIL.Image import Image

Coordinate = Literal["x", "x_dot", "theta", "theta_dot"]

GRAVITY = 9.8  # m/s^2
POLE_MASS = 0.1  # kg
TOTAL_MASS = 1.1  # kg, cart and pole
HALF_LENGTH = 0.5  # m, half the pole's length
FORCE = 10.0  # N
TAU = 0.02  # s per tick
COORDINATES: tuple[Coordinate, ...] = ("x", "x_dot", "theta", "theta_dot")  # m, m/s, rad, rad/s


class CartPole(JaxHabitat, Settings):
    """CartPole as a habitat: action 0 pushes left, 1 right; death beyond an angle or the track.

    Bodies are one array (N, 4) of COORDINATES; theta is the pole's angle from the vertical.
    """

    senses: tuple[Coordinate, ...] = Field(
        COORDINATES, min_length=1, strict=False, description="what is perceived, unscaled"
    )
    angle_limit: float = Field(12.0, gt=0, le=180, description="fatal angle, degrees")
    track_limit: float = Field(
        2.4, gt=0, description="fatal distance from the middle, m; 1e9 is as good as none"
    )
    spread: float = Field(
        0.05, ge=0, description="each coordinate of a fresh body is uniform within +-spread"
    )

    @property
    def senses_size(self) -> int:
        """How many senses."""
        return len(self.senses)

    @property
    def action(self) -> Discrete:
        """Left or right."""
        return Discrete(2)

    @property
    def words(self) -> int:
        """One for each coordinate."""
        return len(COORDINATES)

    @property
    def rate(self) -> float:
        """Ticks in a second."""
        return 1 / TAU

    def picture(self, body: np.ndarray, action: np.ndarray) -> "Image":
        """The cart, its pole, and the side it was pushed from."""
        from primordia.habitats.cartpole.picture import draw

        return draw(body, int(action), self.track_limit)

    def reset(self, words: Array) -> Array:
        """Bodies from words uint32 (N, 4); 24 bits of each become one coordinate."""
        unit = (words >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)
        return (unit - np.float32(0.5)) * np.float32(2 * self.spread)

    def sense(self, bodies: Array) -> Array:
        """The chosen coordinates, float32 (N, senses_size)."""
        if self.senses == COORDINATES:
            return bodies
        return bodies[:, np.array([COORDINATES.index(name) for name in self.senses])]

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        """One tick of 0.02 s."""
        x, x_dot, theta, theta_dot = (bodies[:, i] for i in range(len(COORDINATES)))
        cos, sin = jnp.cos(theta), jnp.sin(theta)
        force = jnp.where(action == 1, FORCE, -FORCE).astype(bodies.dtype)
        push = (force + POLE_MASS * HALF_LENGTH * theta_dot**2 * sin) / TOTAL_MASS
        inertia = HALF_LENGTH * (4.0 / 3.0 - POLE_MASS * cos**2 / TOTAL_MASS)
        theta_acc = (GRAVITY * sin - cos * push) / inertia
        x_acc = push - POLE_MASS * HALF_LENGTH * theta_acc * cos / TOTAL_MASS
        x, x_dot = x + TAU * x_dot, x_dot + TAU * x_acc
        theta, theta_dot = theta + TAU * theta_dot, theta_dot + TAU * theta_acc
        fatal = (jnp.abs(theta) > math.radians(self.angle_limit)) | (jnp.abs(x) > self.track_limit)
        return jnp.stack([x, x_dot, theta, theta_dot], axis=-1), Outcome(fatal)
