"""Settings of robots: time, noise, controls, scores, and captions."""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("mujoco")

from primordia.config import load
from primordia.habitats.mujoco.habitat import MuJoCo


@pytest.mark.parametrize(
    ("task", "caption"), [("HalfCheetah-forager", "x -1,234.6 m"), ("Reacher-forager", "")]
)
def test_a_caption_shows_the_distance_of_a_robot_that_travels(task: str, caption: str) -> None:
    habitat: Any = load(task).build_habitat()
    assert habitat.caption({"qpos": np.array([-1234.56, 7.0])}, np.zeros(2)) == caption


def test_velocities_at_birth_have_only_one_kind_of_noise() -> None:
    with pytest.raises(ValueError, match="velocity_noise and velocity_sd exclude each other"):
        MuJoCo(file="gymnasium:reacher.xml", velocity_noise=0.1, velocity_sd=0.1)


def test_the_timestep_is_that_of_the_settings_or_the_model() -> None:
    """A tick of 5 substeps of the cheetah's 0.01 s takes 0.05 s."""
    for timestep, rate in ((None, 20.0), (0.004, 50.0)):
        habitat = MuJoCo(file="gymnasium:half_cheetah.xml", substeps=5, timestep=timestep)
        assert habitat.rate == pytest.approx(rate)


def test_controls_have_the_ranges_of_the_model(tmp_path: Path) -> None:
    slide = '<body><joint name="{0}" type="slide"/><geom size="0.1"/></body>'
    (tmp_path / "two.xml").write_text(
        f"<mujoco><worldbody>{slide.format('a')}{slide.format('b')}</worldbody><actuator>"
        '<motor joint="a" ctrllimited="true" ctrlrange="-2 3"/><motor joint="b"/>'
        "</actuator></mujoco>"
    )
    action = MuJoCo(file=str(tmp_path / "two.xml")).action
    assert (action.size, action.bounds) == (2, ((-2, -math.inf), (3, math.inf)))


def test_scored_settings_keep_the_senses_of_the_task() -> None:
    scored = {"senses": ["qpos"]}
    with pytest.raises(ValueError, match=re.escape("must give 18 senses, as in the task")):
        MuJoCo(file="gymnasium:half_cheetah.xml", scored=scored)
    own = {"food": "forward", "fatal": "height < 0", "substeps": 5, "episode": 7}
    habitat = MuJoCo(file="gymnasium:half_cheetah.xml", **own, scored={"food": "height"})
    original = habitat.original()
    assert original is not None
    assert original.original() is None
    assert original.model_dump() == {**habitat.model_dump(), "food": "height", "scored": {}}
