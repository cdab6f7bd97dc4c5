"""Pictures of CartPole: the cart on its track, the pole and the push."""

import math
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from primordia.habitats.cartpole.simulator import Physics

WIDTH, HEIGHT = 640, 360
OVERSAMPLING = 2
"""Pictures are drawn this many times larger and then reduced, for smooth edges."""
SKY, TRACK, CART, POLE, PUSH, LIMIT = (
    "#fbfaf7",
    "#8a8a8a",
    "#23395b",
    "#c8553d",
    "#e0a030",
    "#cfcbc2",
)
GROUND = 280
CART_SIZE = (74, 34)
POLE_LENGTH = 150
"""pixels, of a pole 1 m long"""
UNCHANGED = Physics(1, 1, 1, 1, 1)
"""Factors of a body that is as usual."""


class _Shape(NamedTuple):
    """Sizes in pixels. Those of extreme bodies are limited, so that all fit into the picture."""

    cart_width: float
    cart_height: float
    pole_length: float
    pole_width: float

    @classmethod
    def of(cls, factors: Physics) -> "_Shape":
        """Return the sizes for factors of lengths and masses: areas grow with masses."""
        side = min(max(float(factors.cart_mass) ** 0.5, 0.5), 1.8)
        length = min(POLE_LENGTH * float(factors.half_length), 270.0)
        width = 10 * POLE_LENGTH / length * float(factors.pole_mass)
        return cls(side * CART_SIZE[0], side * CART_SIZE[1], length, min(max(width, 3.0), 26.0))


def draw(
    body: np.ndarray, action: int, track_limit: float, factors: Physics = UNCHANGED
) -> Image.Image:
    """Return a picture (640 x 360) of a body (x, x_dot, theta, theta_dot); action 1 pushes right.

    The pole is as long as its factor says, and its area grows with its mass. So does that of the cart.
    """
    large = Image.new("RGB", (WIDTH * OVERSAMPLING, HEIGHT * OVERSAMPLING), SKY)
    pen = _Pen(ImageDraw.Draw(large))
    reach = track_limit if track_limit < 100 else 2.4
    at = WIDTH / 2 + (WIDTH / 2 - 60) * float(body[0]) / reach
    _track(pen, track_limit < 100)
    shape = _Shape.of(factors)
    _push(pen, at, action, shape)
    _cart_and_pole(pen, at, float(body[2]), shape)
    return large.reduce(OVERSAMPLING)


class _Pen:
    """A pen that takes coordinates in pixels of the reduced picture."""

    def __init__(self, canvas: ImageDraw.ImageDraw) -> None:
        self._canvas = canvas

    def line(self, *points: tuple[float, float], width: float, colour: str) -> None:
        self._canvas.line(_scaled(points), fill=colour, width=round(width * OVERSAMPLING))

    def polygon(self, *points: tuple[float, float], colour: str) -> None:
        self._canvas.polygon(_scaled(points), fill=colour)

    def dot(self, x: float, y: float, radius: float, colour: str) -> None:
        corners = _scaled(((x - radius, y - radius), (x + radius, y + radius)))
        self._canvas.ellipse(corners, fill=colour)

    def box(self, x: float, y: float, width: float, height: float, colour: str) -> None:
        corners = _scaled(((x - width / 2, y - height), (x + width / 2, y)))
        self._canvas.rounded_rectangle(corners, radius=6 * OVERSAMPLING, fill=colour)


def _scaled(points: tuple[tuple[float, float], ...]) -> list[tuple[float, float]]:
    return [(x * OVERSAMPLING, y * OVERSAMPLING) for x, y in points]


def _track(pen: _Pen, limited: bool) -> None:
    pen.line((0, GROUND), (WIDTH, GROUND), width=2, colour=TRACK)
    for x in (60, WIDTH - 60) if limited else ():
        pen.line((x, GROUND - 10), (x, GROUND + 10), width=3, colour=TRACK)
    pen.line((WIDTH / 2, GROUND + 2), (WIDTH / 2, GROUND + 8), width=2, colour=LIMIT)


def _push(pen: _Pen, at: float, action: int, shape: _Shape) -> None:
    """Draw an arrow at the side that is pushed."""
    side = -1 if action == 1 else 1
    edge = shape.cart_width / 2
    tip, tail = at + side * (edge + 6), at + side * (edge + 34)
    y = GROUND - shape.cart_height / 2 - 8
    pen.line((tail, y), (tip + side * 8, y), width=5, colour=PUSH)
    pen.polygon((tip, y), (tip + side * 12, y - 8), (tip + side * 12, y + 8), colour=PUSH)


def _cart_and_pole(pen: _Pen, at: float, theta: float, shape: _Shape) -> None:
    pivot = (at, GROUND - shape.cart_height - 6)
    length = shape.pole_length
    end = (pivot[0] + length * math.sin(theta), pivot[1] - length * math.cos(theta))
    for side in (-1, 1):
        pen.dot(at + side * shape.cart_width / 3, GROUND - 8, 8, CART)
    pen.box(at, GROUND - 8, shape.cart_width, shape.cart_height, CART)
    pen.line(pivot, end, width=shape.pole_width, colour=POLE)
    pen.dot(*end, shape.pole_width / 2, POLE)
    pen.dot(*pivot, 7, POLE)
    pen.dot(*pivot, 3, SKY)
