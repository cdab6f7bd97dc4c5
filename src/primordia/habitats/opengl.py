"""The choice of OpenGL for pictures of MuJoCo's robots without a screen."""

import os
from ctypes.util import find_library

VARIABLE = "MUJOCO_GL"
"""The environment variable that MuJoCo and Gymnasium read."""


def backend() -> str:
    """Return the value of VARIABLE, or a default.

    The default is `osmesa`, which needs no GPU, if OSMesa is installed, otherwise `egl`.
    """
    return os.environ.get(VARIABLE) or ("osmesa" if find_library("OSMesa") else "egl")
