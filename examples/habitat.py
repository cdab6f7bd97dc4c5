"""A habitat of your own: a pasture in which tufts of grass are sought, one after another.

    primordia run CartPole-survival --habitat.name examples.habitat:Pasture --metabolism.store 200
        --metabolism.gain 50 --ticks 20_000

Run it where the folder `examples` is (as one line). `primordia replay RUN` then shows the longest life.
"""

from typing import ClassVar, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from PIL import Image, ImageDraw
from pydantic import Field

from primordia.habitats import Continuous, JaxHabitat, Outcome
from primordia.settings.base import Settings

SPEED = 2.0**-5
"""per tick; a power of two, so that its products are exact and every compiler gives the same bits"""


class Grazers(NamedTuple):
    """Bodies: where N grazers stand, and where their next tuft grows; the pasture is [-1, 1]^2."""

    place: Array
    """float32 (N, 2)"""
    tuft: Array
    """float32 (N, 2)"""
    dice: Array
    """uint32 (N,), from which further tufts are drawn"""


class Pasture(JaxHabitat, Settings):
    """One tuft at a time; reaching it is 1 of food, and another grows. To leave the pasture is fatal.

    Senses are the way to the tuft and the grazer's own place; the action is a velocity.
    """

    action: ClassVar = Continuous(2)
    senses_size: ClassVar = 4
    words: ClassVar = 2
    rate: ClassVar = 30.0

    reach: float = Field(0.1, gt=0, le=1, description="distance at which a tuft is eaten")

    def reset(self, words: Array) -> Grazers:
        """Return grazers in the middle, from words uint32 (N, 2)."""
        middle = jnp.zeros((len(words), 2), jnp.float32)
        return Grazers(middle, _somewhere(words[:, 0]), words[:, 1])

    def sense(self, bodies: Grazers) -> Array:
        """Return the way to the tuft and the grazer's place, float32 (N, 4)."""
        return jnp.concatenate([bodies.tuft - bodies.place, bodies.place], axis=1)

    def step(self, bodies: Grazers, action: Array) -> tuple[Grazers, Outcome]:
        """Move by actions float32 (N, 2), eat, and let the next tuft grow."""
        place = bodies.place + SPEED * jnp.clip(action, -1, 1)
        eats = (jnp.abs(bodies.tuft - place) < self.reach).all(axis=1)
        dice = jnp.where(
            eats, bodies.dice * np.uint32(1664525) + np.uint32(1013904223), bodies.dice
        )
        tuft = jnp.where(eats[:, None], _somewhere(dice), bodies.tuft)
        left = (jnp.abs(place) > 1).any(axis=1)
        return Grazers(place, tuft, dice), Outcome(left, food=eats.astype(jnp.float32))

    def picture(self, body: Grazers, action: np.ndarray) -> Image.Image:
        """Return a picture, 360 x 360: the tuft is green, the grazer brown."""
        picture = Image.new("RGB", (360, 360), "#f4f1e6")
        pen = ImageDraw.Draw(picture)
        for (x, y), size, colour in (
            (body.tuft, 18 * self.reach / 0.1, "#5a9e4b"),
            (body.place, 7, "#7a4b2a"),
        ):
            pen.circle((180 * (1 + x), 180 * (1 - y)), size, colour)
        return picture


def _somewhere(words: Array) -> Array:
    """Return places from words uint32 (N,), within 0.8 of the middle: 16 bits for each coordinate."""
    halves = jnp.stack([words >> np.uint32(16), words & np.uint32(0xFFFF)], axis=1)
    centred = halves.astype(jnp.float32) - np.float32(2**15)
    return centred * np.float32(0.8 / 2**15)
