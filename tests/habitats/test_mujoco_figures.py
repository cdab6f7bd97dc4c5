"""Figures of robots: where targets appear, when they are reached, and what captions tell."""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("mujoco")

from primordia.config import load
from primordia.habitats import opengl
from primordia.habitats.mujoco.habitat import MuJoCo
from primordia.habitats.mujoco.target import Target
from primordia.random import dice
from tests.robots import of_task

TARGET: dict[str, Any] = {
    "body": "target",
    "by": "fingertip",
    "within": 0.5,
    "joints": ("target_x", "target_y"),
    "radius": 0.25,
}


def test_targets_appear_everywhere_in_the_disc_alike() -> None:
    """Squares of distances and angles are uniform; each point takes two numbers of the dice."""
    target, state, places = Target(**TARGET), 12345, []
    for _ in range(4000):
        expected = dice.roll(dice.roll(state)[0])[0]
        state, place = target.draw_position(state)
        assert state == expected
        places.append(place)
    x, y = np.array(places).T
    distance = np.hypot(x, y) / 0.25
    angle = np.arctan2(y, x) % (2 * math.pi) / (2 * math.pi)
    assert distance.max() <= 1
    shares = np.linspace(0.1, 0.9, 9)
    for uniform in (distance**2, angle):
        np.testing.assert_allclose(np.quantile(uniform, shares), shares, atol=0.04)
    assert abs(np.corrcoef(distance, angle)[0, 1]) < 0.08


def test_a_target_is_reached_within_its_distance_in_three_dimensions() -> None:
    near = [[0.3, 0.0, 0.39], [0.3, 0.0, 0.41], [0.0, -0.49, 0.0], [0.51, 0, 0], [0, 0, 0.5]]
    places = {"target": np.array([1.0, 2.0, 3.0]) + near, "fingertip": np.tile([1.0, 2, 3], (5, 1))}
    assert Target(**TARGET).reached(places).tolist() == [True, False, True, False, False]


def test_a_target_is_placed_by_the_last_two_words_alone() -> None:
    """So its place follows from nothing else, and nothing else from its place."""
    habitat = of_task("Reacher-forager", 1)
    words = np.arange(1, habitat.words + 1, dtype=np.uint32)[None] * np.uint32(0x9E3779B1)

    def born(word: int | None = None) -> tuple[list[float], list[float]]:
        changed = words.copy()
        if word is not None:
            changed[0, word] ^= np.uint32(0x5A5A5A5A)
        habitat.reset(np.array([0]), changed)
        place = habitat._bodies.views["qpos"][0].tolist()
        return place[:2], place[2:]

    arm, target = born()
    for word in range(habitat.words):
        one, other = born(word)
        assert (other != target) == (word >= habitat.words - 2)
        assert (one != arm) == (word < 2)


@pytest.mark.parametrize(
    ("task", "caption"), [("HalfCheetah-forager", "x -1,234.6 m"), ("Reacher-forager", "")]
)
def test_a_caption_tells_the_distance_of_a_robot_that_travels(task: str, caption: str) -> None:
    habitat: Any = load(task).build_habitat()
    assert habitat.caption({"qpos": np.array([-1234.56, 7.0])}, np.zeros(2)) == caption


def test_a_target_names_parts_of_the_model() -> None:
    for change, says in (
        (
            {"body": "ball"},
            "there is no body 'ball'; known: world, body0, body1, fingertip, target",
        ),
        ({"joints": ("target_x", "z")}, "there is no joint 'z'; known: joint0, joint1, target_x"),
    ):
        with pytest.raises(ValueError, match=says):
            MuJoCo(file="gymnasium:reacher.xml", target={**TARGET, **change})


def test_velocities_at_birth_are_uniform_or_gaussian() -> None:
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


@pytest.mark.parametrize(
    ("chosen", "library", "backend"),
    [("glfw", "osmesa.so", "glfw"), ("", "osmesa.so", "osmesa"), ("", None, "egl"),
     ("osmesa", None, "osmesa")],
)  # fmt: skip
def test_pictures_are_drawn_without_a_screen_unless_the_user_chooses(
    chosen: str, library: str | None, backend: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(opengl, "find_library", lambda name: {"OSMesa": library}[name])
    monkeypatch.setenv(opengl.VARIABLE, chosen)
    assert opengl.backend() == backend
