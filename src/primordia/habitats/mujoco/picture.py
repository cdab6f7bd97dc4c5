"""A MuJoCo model as one sees it, drawn without a screen."""

import os
import weakref
from ctypes.util import find_library
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
from PIL import Image

from primordia.errors import InputError
from primordia.habitats.framed import framed
from primordia.habitats.mujoco.simulator import ROOT, moves_about, package

WIDTH, HEIGHT = 640, 360
FINE = 2
"""Drawn so many times larger and reduced, for smooth edges; four times as fast as MuJoCo's own way."""
SHAPES = 2000
"""most that are drawn at once"""
CAMERA = "track"
"""of the model, if it has one of this name"""


class Eye:
    """Draws bodies of one model."""

    def __init__(self, model: Any) -> None:
        """Raises InputError if nothing can draw here."""
        mujoco = self._mujoco = package()
        model.vis.global_.offwidth, model.vis.global_.offheight = WIDTH * FINE, HEIGHT * FINE
        model.vis.quality.offsamples, model.vis.quality.shadowsize = 0, 1024
        self._model, self._data = model, mujoco.MjData(model)
        _screen().make_current()
        self._scene = mujoco.MjvScene(model, SHAPES)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        weakref.finalize(self, self._context.free)
        self._camera = self._placed()

    def _placed(self) -> Any:
        """The model's own camera; else one that follows what moves about, or looks down on what stays."""
        mujoco, model, camera = self._mujoco, self._model, self._mujoco.MjvCamera()
        own = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, CAMERA)
        mujoco.mjv_defaultFreeCamera(model, camera)
        if own >= 0:
            camera.type, camera.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, own
        elif moves_about(model):
            camera.type, camera.trackbodyid = mujoco.mjtCamera.mjCAMERA_TRACKING, ROOT
        else:
            camera.elevation, camera.distance = -80, camera.distance / 2
        return camera

    def draw(self, positions: np.ndarray) -> Image.Image:
        """A picture (640 x 416) of a body with these positions of its joints (nq,)."""
        mujoco, data, scene = self._mujoco, self._data, self._scene
        data.qpos[:] = positions
        mujoco.mj_forward(self._model, data)
        everything, as_usual = mujoco.mjtCatBit.mjCAT_ALL, mujoco.MjvOption()
        mujoco.mjv_updateScene(self._model, data, as_usual, None, self._camera, everything, scene)
        _screen().make_current()
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        view = mujoco.MjrRect(0, 0, WIDTH * FINE, HEIGHT * FINE)
        pixels = np.zeros((HEIGHT * FINE, WIDTH * FINE, 3), np.uint8)
        mujoco.mjr_render(view, scene, self._context)
        mujoco.mjr_readPixels(pixels, None, view, self._context)
        return framed(Image.fromarray(pixels[::-1]).reduce(FINE))


@cache
def _screen() -> Any:
    """What is drawn on, one for all eyes: by MUJOCO_GL's means, or OSMesa's, which need no GPU, or EGL's.

    Raises:
        InputError: it cannot be had.
    """
    name = os.environ.get("MUJOCO_GL") or ("osmesa" if find_library("OSMesa") else "egl")
    try:
        screen = import_module(f"mujoco.{name}").GLContext(WIDTH * FINE, HEIGHT * FINE)
        screen.make_current()
    except Exception:  # each has errors of its own
        raise InputError(
            f"pictures of robots need OpenGL without a screen, and {name} cannot be used:"
            " `apt-get install libosmesa6`, or set MUJOCO_GL to egl or osmesa"
        ) from None
    weakref.finalize(_screen, _screen.cache_clear)  # at exit, after the eyes, which are younger
    return screen
