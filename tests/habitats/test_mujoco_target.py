"""Targets of robots: where they appear, when they are reached, and errors in their settings."""

import math
from typing import Any

import numpy as np
import pytest

from primordia.habitats.mujoco.habitat import MuJoCo
from primordia.habitats.mujoco.target import Target
from primordia.random import dice
from tests.robots import born, of_task, opened

mujoco = pytest.importorskip("mujoco")

TARGET: dict[str, Any] = {
    "body": "target",
    "by": "fingertip",
    "within": 0.5,
    "joints": ("target_x", "target_y"),
    "radius": 0.25,
}


def test_positions_of_targets_are_uniform_in_the_disc() -> None:
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
    """The arm is placed by the first two words alone."""
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
    ("change", "says"),
    [
        (
            {"body": "ball"},
            "there is no body 'ball'; known: world, body0, body1, fingertip, target",
        ),
        ({"by": "nose"}, "there is no body 'nose'; known"),
        ({"joints": ("target_x", "z")}, "there is no joint 'z'; known: joint0, joint1, target_x"),
    ],
)
def test_a_target_names_parts_of_the_model(change: dict[str, Any], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        MuJoCo(file="gymnasium:reacher.xml", target={**TARGET, **change})


@pytest.mark.parametrize("setting", ["within", "radius"])
def test_a_target_has_a_distance_and_a_radius(setting: str) -> None:
    assert getattr(Target(**{**TARGET, setting: 1e-9}), setting) == 1e-9
    with pytest.raises(ValueError, match=setting):
        Target(**{**TARGET, setting: 0.0})


def test_a_reached_target_feeds_once_and_then_moves() -> None:
    habitat = of_task("Reacher-forager", 600)
    born(habitat, 600)
    all_alive, places = np.ones(600, bool), []
    for _ in range(20):
        before = habitat._bodies.views["qpos"][:, 2:].copy()
        senses, outcome = habitat.step(np.full((600, 2), 0.05, np.float32), all_alive)
        fed, after = outcome.food == 1, habitat._bodies.views["qpos"][:, 2:]
        apart = np.hypot(*habitat._bodies.views["xpos"]["fingertip"][:, :2].T)
        assert ((outcome.food == 0) | fed).all()
        assert (after[~fed] == before[~fed]).all()
        assert (after[fed] != before[fed]).all()
        np.testing.assert_array_equal(senses[:, 4:6], after.astype(np.float32))
        assert (np.hypot(*before[fed].T) <= apart[fed] + 0.06).all()
        places.append(after[fed])
    radius = np.hypot(*np.concatenate(places).T)
    assert len(radius) > 50
    assert radius.max() <= 0.2
    assert np.median(radius) == pytest.approx(0.2 / np.sqrt(2), rel=0.15)


def test_a_target_moves_only_if_a_living_body_reaches_it_at_the_end_of_a_tick() -> None:
    """Only the target needs the places of bodies. A target that has moved is at rest."""
    target = {**TARGET, "within": 0.2}
    own: dict[str, Any] = {"file": "gymnasium:reacher.xml", "senses": ("qpos",)}
    habitat = opened(60, **own, target=target, position_noise=2.0, velocity_noise=40.0, substeps=1)
    born(habitat, 60)
    model, alive, moves = habitat._model, np.arange(60) % 3 > 0, 0
    data = mujoco.MjData(model)
    for _ in range(4):
        before = habitat._bodies.views["qpos"].copy()
        habitat.step(np.ones((60, 2), np.float32), alive)
        after, speeds = (habitat._bodies.views[name] for name in ("qpos", "qvel"))
        assert (speeds[:, 2:] == 0).all()
        np.testing.assert_array_equal(after[~alive], before[~alive])
        for cell in np.flatnonzero(alive):
            data.qpos[:] = [*after[cell, :2], *before[cell, 2:]]
            mujoco.mj_kinematics(model, data)
            apart = data.body("target").xpos - data.body("fingertip").xpos
            moved = bool((after[cell, 2:] != before[cell, 2:]).any())
            assert moved == (math.dist(apart, [0, 0, 0]) < 0.2)
            moves += moved
    assert 20 < moves < 140
    habitat.close()


def test_targets_of_saved_robots_move_to_the_same_places() -> None:
    original, loaded = (of_task("Reacher-forager", 100) for _ in range(2))
    born(original, 100)

    def places(habitat: MuJoCo) -> np.ndarray:
        for _ in range(10):
            habitat.step(np.full((100, 2), 0.05, np.float32), np.ones(100, bool))
        return habitat._bodies.views["qpos"].copy()

    before, saved = places(original), original.save()
    after = places(original)
    assert (after[:, 2:] != before[:, 2:]).any()
    loaded.load(saved)
    np.testing.assert_array_equal(places(loaded), after)
