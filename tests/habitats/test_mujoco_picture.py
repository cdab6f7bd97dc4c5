"""The camera that takes pictures of a robot: the model's own, or one that fits the robot."""

from pathlib import Path
from typing import Any

import pytest

from primordia.habitats.mujoco.picture import Renderer
from primordia.habitats.mujoco.simulator import load_model
from tests.robots import MOTOR, SLIDE

mujoco = pytest.importorskip("mujoco")


def camera(file: str) -> tuple[Any, Any]:
    """Return the camera for a model, and MuJoCo's default camera. Nothing is drawn."""
    renderer, default = object.__new__(Renderer), mujoco.MjvCamera()
    renderer._mujoco, renderer._model = mujoco, load_model(file, None)
    mujoco.mjv_defaultFreeCamera(renderer._model, default)
    return renderer._make_camera(), default


def test_a_camera_of_the_model_that_follows_the_robot_is_used() -> None:
    used, _ = camera("gymnasium:half_cheetah.xml")
    assert (used.type, used.fixedcamid) == (mujoco.mjtCamera.mjCAMERA_FIXED, 0)


def test_a_robot_that_moves_is_followed(tmp_path: Path) -> None:
    (tmp_path / "box.xml").write_text(SLIDE.format(actuator=MOTOR))
    used, default = camera(str(tmp_path / "box.xml"))
    assert (used.type, used.trackbodyid) == (mujoco.mjtCamera.mjCAMERA_TRACKING, 1)
    assert used.distance == default.distance


def test_a_robot_that_is_fixed_is_seen_from_above_and_near() -> None:
    used, default = camera("gymnasium:reacher.xml")
    assert used.type == mujoco.mjtCamera.mjCAMERA_FREE
    assert (used.elevation, used.distance) == (-80, default.distance / 2)
