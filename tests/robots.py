"""Robots for tests: opened, and born."""

from typing import Any

import numpy as np

from primordia.config import load
from primordia.habitats.mujoco.habitat import MuJoCo


def opened(bodies: int = 4, **changes: Any) -> MuJoCo:
    habitat = MuJoCo(**{"file": "gymnasium:half_cheetah.xml", "substeps": 5, **changes})
    habitat.open(bodies)
    return habitat


def of_task(name: str, bodies: int = 4, **changes: Any) -> Any:
    habitat: Any = load(name, {"habitat": changes}).build_habitat()
    habitat.open(bodies)
    return habitat


def born(habitat: Any, bodies: int = 4, seed: int = 0) -> np.ndarray:
    words = np.random.default_rng(seed).integers(0, 2**32, (bodies, habitat.words), np.uint32)
    return habitat.reset(np.arange(bodies), words)
