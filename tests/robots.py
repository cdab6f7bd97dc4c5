"""Robots for tests: habitats that are open, of any model or of a task, and births in them."""

from typing import Any

import numpy as np

from primordia.config import load
from primordia.habitats.mujoco.habitat import MuJoCo

SLIDE = """<mujoco><worldbody><body name="box"><joint name="x" type="slide" axis="1 0 0"/>
<geom size="0.1"/></body></worldbody>{actuator}</mujoco>"""
"""A model: a box that slides along a line."""
MOTOR = '<actuator><motor joint="x"/></actuator>'


def opened(bodies: int = 4, **changes: Any) -> MuJoCo:
    """Return an open habitat of half-cheetahs, with some settings changed."""
    habitat = MuJoCo(**{"file": "gymnasium:half_cheetah.xml", "substeps": 5, **changes})
    habitat.open(bodies)
    return habitat


def of_task(name: str, bodies: int = 4, **changes: Any) -> Any:
    """Return the open habitat of a task, with some settings of the habitat changed."""
    habitat: Any = load(name, {"habitat": changes}).build_habitat()
    habitat.open(bodies)
    return habitat


def born(habitat: Any, bodies: int = 4, seed: int = 0) -> np.ndarray:
    """Give birth in all cells, with words drawn from a seed, and return the senses (N, S)."""
    words = np.random.default_rng(seed).integers(0, 2**32, (bodies, habitat.words), np.uint32)
    return habitat.reset(np.arange(bodies), words)
