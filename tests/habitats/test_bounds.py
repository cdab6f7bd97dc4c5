"""Bounds of the habitats' settings: the last value is accepted, the next one is refused."""

from typing import Any

import pytest

from primordia.config import load
from primordia.errors import InputError

SIMULATORS = {"Pong-survival": "ale_py", "Hopper-survival": "mujoco"}
BOUNDS: list[tuple[str, str, Any, Any]] = [
    ("CartPole-survival", "angle_limit", 0.01, 0.0),
    ("CartPole-survival", "angle_limit", 180.0, 180.01),
    ("CartPole-survival", "track_limit", 1e-3, 0.0),
    ("CartPole-survival", "spread", 0.0, -1e-9),
    ("CartPole-survival", "spread", 1e9, 1.1e9),
    ("CartPole-survival", "senses", ("x",), ()),
    ("Pong-survival", "frame_skip", 1, 0),
    ("Pong-survival", "frame_skip", 100, 101),
    ("Pong-survival", "sticky", 0.0, -1e-9),
    ("Pong-survival", "sticky", 0.99, 1.0),
    ("Pong-survival", "noops", 0, -1),
    ("Pong-survival", "noops", 10_000, 10_001),
    ("Pong-survival", "senses", (0, 127), (0, 128)),
    ("Pong-survival", "senses", (127, 0), (0, -1)),
    ("Pong-survival", "mode", 0, -1),
    ("Pong-survival", "difficulty", 0, -1),
    ("Pong-survival", "workers", 0, -1),
    ("Hopper-survival", "timestep", 1e-6, 0.0),
    ("Hopper-survival", "substeps", 1, 0),
    ("Hopper-survival", "substeps", 1000, 1001),
    ("Hopper-survival", "position_noise", 0.0, -1e-9),
    ("Hopper-survival", "velocity_noise", 0.0, -1e-9),
    ("Hopper-survival", "velocity_sd", 0.0, -1e-9),
    ("Hopper-survival", "episode", 1, 0),
]
"""task, setting, a value that is accepted, a value that is refused"""


@pytest.mark.parametrize(("task", "setting", "accepted", "refused"), BOUNDS)
def test_a_value_at_the_bound_is_accepted_and_one_beyond_it_is_not(
    task: str, setting: str, accepted: Any, refused: Any
) -> None:
    if package := SIMULATORS.get(task):
        pytest.importorskip(package)
    habitat = load(task, {"habitat": {setting: accepted}}).build_habitat()
    assert getattr(habitat, setting) == accepted
    with pytest.raises(InputError, match=setting):
        load(task, {"habitat": {setting: refused}}).build_habitat()
