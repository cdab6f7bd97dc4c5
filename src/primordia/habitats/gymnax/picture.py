"""Pictures of bodies, drawn by the environment or its library, or else pictures of the bodies' senses.

A grid has a colour for each channel, and a frame around the cells that the player perceives; other
senses have a bar each.
"""

import colorsys
from collections.abc import Callable
from functools import lru_cache
from importlib import import_module
from typing import Any

import jax
import numpy as np
from PIL import Image, ImageDraw

from primordia.habitats.framed import PAPER, framed
from primordia.habitats.gymnax.playground import Playground
from primordia.habitats.gymnax.spaces import View
from primordia.habitats.mujoco.picture import Renderer
from primordia.habitats.silence import quiet, silent

WIDTH = 400
"""pixels of the longer side of a grid, and smallest width of a row of bars"""
GROUND = np.array([24, 26, 32])
BAR, AXIS = "#23395b", "#8a8a8a"
FRAME = 4
"""pixels of the line around what a player perceives"""
BLOCK = 64
"""pixels of a block of Craftax, one of the sizes that it draws"""


def rendered(env: Any, state: Any, params: Any) -> Image.Image | None:
    """Return the picture that the environment, or its library, draws of a state; None if neither does.

    Raises:
        InputError: this machine cannot draw robots.
    """
    if hasattr(env, "picture"):  # of your own; its errors are yours to see
        return _framed(env.picture(state, params))
    try:
        with quiet(), silent():
            return _renderer(env)(state, params)
    except (AttributeError, ImportError, OSError, ValueError):
        return None


@lru_cache(maxsize=8)
def _renderer(env: Any) -> Callable[[Any, Any], Image.Image]:
    """Return a function that draws a state with parameters.

    Raises:
        AttributeError, ImportError: there is no such function.
    """
    if isinstance(env, Playground):
        robot = Renderer(env.env.mj_model)
        return lambda state, _: robot.draw(np.asarray(state.data.qpos))
    package, within, _ = type(env).__module__.partition(".envs.")
    if within and package.startswith("craftax."):
        draw = jax.jit(import_module(f"{package}.renderer").make_craftax_pixel_renderer(BLOCK))
        return lambda state, _: _framed(draw(state))
    draw_classic = import_module("gymnax.visualize.vis_gym").render_gym_frame
    return lambda state, params: _framed(draw_classic(env.name, state, params))


def _framed(pixels: Any) -> Image.Image:
    """Return a picture of pixels (H, W, 3), up to 255."""
    return framed(Image.fromarray(np.asarray(pixels).astype(np.uint8)))


def draw(senses: np.ndarray, grid: tuple[int, ...] | None) -> Image.Image:
    """Return a picture of senses (S,) as a `grid` (height, width, channels), or as bars if it is None."""
    return framed(_coloured(senses.reshape(grid)) if grid else _bars(senses))


def draw_view(env: Any, state: Any, params: Any, view: View) -> Image.Image | None:
    """Return a picture of the whole grid, with a frame around the cells that the player perceives.

    None if the environment lacks gymnax's method `observe`, since bodies keep only what is perceived.
    """
    try:
        grid = _observing(env)(state, params).reshape(view.grid)
    except (AttributeError, NotImplementedError):
        return None
    picture, reach = _coloured(np.asarray(grid)), view.sight
    zoom = picture.width // grid.shape[1]
    row, column = map(int, view.place(grid))
    corners = (column - reach, row - reach, column + reach + 1, row + reach + 1)
    left, top, right, bottom = (zoom * corner for corner in corners)
    box = (left, top, right - 1, bottom - 1)
    ImageDraw.Draw(picture).rectangle(box, outline=PAPER, width=FRAME)
    return framed(picture)


@lru_cache(maxsize=8)
def _observing(env: Any) -> Callable[[Any, Any], Any]:
    """Return a function of a state and parameters that returns the observation, float32.

    Raises:
        AttributeError: the environment has no such method.
    """
    key, observe = np.zeros(2, np.uint32), env.observe
    return jax.jit(lambda state, params: observe(key, state, None, params).astype(np.float32))


def _coloured(cells: np.ndarray) -> Image.Image:
    """Return the grid; the last channel that is not zero in a cell gives its colour."""
    height, width, channels = cells.shape
    picture = np.broadcast_to(GROUND, (height, width, 3)).copy()
    for channel in range(channels):
        share = np.clip(cells[:, :, channel], 0, 1)[:, :, None]
        colour = 255 * np.array(colorsys.hsv_to_rgb(channel / channels, 0.65, 0.95))
        picture = np.where(share > 0, GROUND + share * (colour - GROUND), picture)
    zoom = max(WIDTH // max(height, width), 1)
    large = Image.fromarray(picture.astype(np.uint8))
    return large.resize((width * zoom, height * zoom), Image.Resampling.NEAREST)


def _bars(senses: np.ndarray) -> Image.Image:
    """Return a picture with a bar for each sense, from the middle up to 1 or down to -1."""
    width, half = max(len(senses), WIDTH), WIDTH // 4
    picture = Image.new("RGB", (width, 2 * half), PAPER)
    pen, each = ImageDraw.Draw(picture), width / len(senses)
    for place, sense in enumerate(np.clip(np.nan_to_num(senses), -1, 1)):
        top, bottom = sorted((half, half - round(float(sense) * (half - 4))))
        left, right = round(place * each), max(round((place + 0.8) * each) - 1, round(place * each))
        pen.rectangle((left, top, right, bottom), fill=BAR)
    pen.line((0, half, width, half), fill=AXIS)
    return picture
