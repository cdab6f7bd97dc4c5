"""Pictures of MuJoCo models, drawn without a screen."""

import atexit
import weakref
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
from PIL import Image

from primordia.errors import InputError
from primordia.habitats.framed import framed
from primordia.habitats.mujoco.simulator import ROOT, package, root_translates
from primordia.habitats.opengl import backend

WIDTH, HEIGHT = 640, 360
OVERSAMPLING = 2
"""Pictures are drawn this many times larger and then reduced, for smooth edges. That is four times as
fast as MuJoCo's own oversampling."""
LARGE_WIDTH, LARGE_HEIGHT = WIDTH * OVERSAMPLING, HEIGHT * OVERSAMPLING
MOST_SHAPES = 2000
"""largest number of shapes in a picture"""
CAMERA = "track"
"""name of the camera that is used if a model has it"""


class Renderer:
    """Renderer of bodies of one model."""

    def __init__(self, model: Any) -> None:
        """Raise InputError if this machine cannot draw."""
        mujoco = self._mujoco = package()
        model.vis.global_.offwidth, model.vis.global_.offheight = LARGE_WIDTH, LARGE_HEIGHT
        model.vis.quality.offsamples, model.vis.quality.shadowsize = 0, 1024
        self._model, self._data = model, mujoco.MjData(model)
        _gl_context().make_current()
        self._scene = mujoco.MjvScene(model, MOST_SHAPES)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        # It is freed before OpenGL's context is released.
        atexit.register(weakref.finalize(self, self._context.free))
        self._camera = self._make_camera()

    def _make_camera(self) -> Any:
        """Return the model's CAMERA, or a camera that follows a moving robot or looks down on a
        fixed one."""
        mujoco, model, camera = self._mujoco, self._model, self._mujoco.MjvCamera()
        model_camera = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, CAMERA)
        mujoco.mjv_defaultFreeCamera(model, camera)
        if model_camera >= 0:
            camera.type, camera.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, model_camera
        elif root_translates(model):
            camera.type, camera.trackbodyid = mujoco.mjtCamera.mjCAMERA_TRACKING, ROOT
        else:
            camera.elevation, camera.distance = -80, camera.distance / 2
        return camera

    def draw(self, positions: np.ndarray) -> Image.Image:
        """Return a picture (640 x 416) of a body with these positions of its joints (nq,)."""
        mujoco, data, scene = self._mujoco, self._data, self._scene
        data.qpos[:] = positions
        mujoco.mj_forward(self._model, data)
        everything, defaults = mujoco.mjtCatBit.mjCAT_ALL, mujoco.MjvOption()
        mujoco.mjv_updateScene(self._model, data, defaults, None, self._camera, everything, scene)
        _gl_context().make_current()
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        view = mujoco.MjrRect(0, 0, LARGE_WIDTH, LARGE_HEIGHT)
        pixels = np.zeros((LARGE_HEIGHT, LARGE_WIDTH, 3), np.uint8)
        mujoco.mjr_render(view, scene, self._context)
        mujoco.mjr_readPixels(pixels, None, view, self._context)
        return framed(Image.fromarray(pixels[::-1]).reduce(OVERSAMPLING))


@cache
def _gl_context() -> Any:
    """Return an OpenGL context, one for all renderers.

    Raises:
        InputError: the context cannot be made.
    """
    name = backend()
    try:
        context = import_module(f"mujoco.{name}").GLContext(LARGE_WIDTH, LARGE_HEIGHT)
        context.make_current()
    except Exception:  # each library raises different errors
        raise InputError(
            f"pictures of robots need OpenGL without a screen, and {name} cannot be used;"
            " install OSMesa with `apt-get install libosmesa6`, or set MUJOCO_GL to egl or osmesa"
        ) from None
    # Handlers run in reverse order: first renderers, then this context, then EGL's display from
    # above. A context without its display cannot be released.
    atexit.register(_gl_context.cache_clear)
    return context
