"""CartPole: a pole on a cart, pushed left or right (Barto, Sutton & Anderson 1983).

Schmidgall & Hays 2021, "CartPole-survival": an organism lives until the pole falls beyond a limit.
"""

import math
from typing import TYPE_CHECKING, ClassVar, Literal

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.habitats.cartpole.simulator import STANDARD, TAU, Physics, advance
from primordia.habitats.contract import Discrete, JaxHabitat, Outcome
from primordia.settings.base import Settings

if TYPE_CHECKING:
    from PIL.Image import Image

Coordinate = Literal["x", "x_dot", "theta", "theta_dot"]

COORDINATES: tuple[Coordinate, ...] = ("x", "x_dot", "theta", "theta_dot")  # m, m/s, rad, rad/s


class CartPole(JaxHabitat, Settings):
    """CartPole as a habitat: action 0 pushes left, 1 right; death beyond an angle or the track.

    Bodies are one array (N, 4) of COORDINATES; theta is the pole's angle from the vertical.
    """

    action: ClassVar = Discrete(2)
    words: ClassVar = len(COORDINATES)
    rate: ClassVar = 1 / TAU
    parameters: ClassVar = ("gravity", "pole-length", "pole-mass", "cart-mass", "force")
    """in the order of `Physics`"""

    senses: tuple[Coordinate, ...] = Field(
        COORDINATES,
        min_length=1,
        strict=False,
        description="coordinates that organisms perceive, unscaled",
    )
    angle_limit: float = Field(12.0, gt=0, le=180, description="fatal angle, degrees")
    track_limit: float = Field(
        2.4,
        gt=0,
        description="fatal distance from the middle, m; 1e9 is no limit in practice",
    )
    spread: float = Field(
        0.05,
        ge=0,
        le=1e9,
        description="each coordinate of a new body is uniform from -spread to spread",
    )

    @property
    def senses_size(self) -> int:
        """Return the number of senses."""
        return len(self.senses)

    def picture(self, body: np.ndarray, action: np.ndarray) -> "Image":
        """Return a picture of the cart, its pole and its push."""
        return self.picture_scaled(body, action, np.ones(len(self.parameters), np.float32))

    def picture_scaled(self, body: np.ndarray, action: np.ndarray, factors: np.ndarray) -> "Image":
        """Return a picture of a cart and a pole of another length and mass."""
        from primordia.habitats.cartpole.picture import draw

        return draw(body, int(action), self.track_limit, Physics(*factors.tolist()))

    def reset(self, words: Array) -> Array:
        """Return bodies from words uint32 (N, 4); 24 bits of each become one coordinate."""
        unit = (words >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)
        return (unit - np.float32(0.5)) * np.float32(2 * self.spread)

    def sense(self, bodies: Array) -> Array:
        """Return the chosen coordinates, float32 (N, senses_size)."""
        if self.senses == COORDINATES:
            return bodies
        return bodies[:, np.array([COORDINATES.index(name) for name in self.senses])]

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        """Step bodies (N, 4) by actions int32 (N,) for one tick of 0.02 s."""
        return self._step(bodies, action, STANDARD)

    def step_scaled(self, bodies: Array, action: Array, factors: Array) -> tuple[Array, Outcome]:
        """Step bodies whose `parameters` are multiplied by factors (N, 5)."""
        scaled = (value * factors[:, i] for i, value in enumerate(STANDARD))
        return self._step(bodies, action, Physics(*scaled))

    def _step(self, bodies: Array, action: Array, physics: Physics) -> tuple[Array, Outcome]:
        x, x_dot, theta, theta_dot = (bodies[:, i] for i in range(len(COORDINATES)))
        x, x_dot, theta, theta_dot = advance(x, x_dot, theta, theta_dot, action, physics)
        fatal = (jnp.abs(theta) > math.radians(self.angle_limit)) | (jnp.abs(x) > self.track_limit)
        return jnp.stack([x, x_dot, theta, theta_dot], axis=-1), Outcome(fatal)
