"""Robots for tests: habitats that are open, of any model or of a task, and births in them."""

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

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


def write_model(folder: Path) -> Path:
    """Write a model that needs five other files, and uses most of what MJCF offers. Return its file."""
    (folder / "parts" / "shapes").mkdir(parents=True)
    pixels = np.arange(192, dtype=np.uint8).reshape(8, 8, 3)
    Image.fromarray(pixels).save(folder / "parts" / "skin.png")
    Image.fromarray(pixels[:, :, 0] // 64).save(folder / "parts" / "shapes" / "ground.png")
    (folder / "parts" / "shapes" / "foot.obj").write_text(FOOT)
    (folder / "parts" / "leg.xml").write_text(LEG)
    (folder / "walker.xml").write_text(WALKER)
    return folder / "walker.xml"


FOOT = """v 0 0 0
v 0.1 0 0
v 0 0.1 0
v 0 0 0.1
f 1 3 2
f 1 2 4
f 2 3 4
f 1 4 3
"""
LEG = """<mujoco><default><default class="leg"><joint type="hinge" axis="0 1 0" damping="0.1"/>
</default></default></mujoco>"""
WALKER = """<mujoco>
<compiler meshdir="parts/shapes" texturedir="parts"/>
<include file="parts/leg.xml"/>
<asset>
  <mesh name="foot" file="foot.obj"/>
  <texture name="skin" type="2d" file="skin.png"/><material name="skin" texture="skin"/>
  <hfield name="ground" file="ground.png" size="20 20 0.2 0.1"/>
</asset>
<worldbody>
  <geom type="hfield" hfield="ground"/>
  <body name="torso" pos="0 0 0.6">
    <freejoint/><geom size="0.1" material="skin"/><site name="imu"/>
    <replicate count="2" offset="0.15 0 0"><body name="leg" pos="0 0 -0.15" childclass="leg">
      <joint name="hip" range="-1 1"/><geom type="mesh" mesh="foot"/>
    </body></replicate>
  </body>
  <body name="hand" mocap="true" pos="0 0 2"><geom size="0.05" contype="0" conaffinity="0"/></body>
  <body name="bag" pos="0 0 1.8"><freejoint/><geom size="0.05"/></body>
</worldbody>
<equality><connect body1="hand" body2="bag" anchor="0 0 -0.1"/></equality>
<actuator><motor joint="hip0" gear="3"/><general joint="hip1" dyntype="filter" dynprm="0.1"/></actuator>
<sensor>
  <jointpos name="hip" joint="hip0"/><gyro name="gyro" site="imu"/><velocimeter site="imu"/>
  <accelerometer name="acceleration" site="imu"/><touch name="touch" site="imu"/>
</sensor>
<keyframe><key name="up" qpos="0 0 0.5 1 0 0 0 0.1 0.1 0 0 1.8 1 0 0 0"/></keyframe>
</mujoco>"""
SENSES = [
    "qpos[2]",
    "qvel",
    "act",
    "time",
    'sensor["gyro"]',
    'sensor["acceleration"]',
    'cfrc_ext["leg0"]',
]
