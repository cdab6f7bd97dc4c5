"""What an environment is asked for: actions, a place of birth, arguments; and what it refuses."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from gymnasium.error import ResetNeeded

from primordia.envs import LifeEnv, LifeVectorEnv
from primordia.envs.bodies import as_rows
from primordia.habitats.contract import Compound, Continuous, Discrete


@pytest.mark.parametrize("action", [2, -1, 0.5, [0], None, "left"])
def test_an_action_that_does_not_exist_is_an_error(action: Any) -> None:
    env = LifeEnv("CartPole-survival")
    env.reset(seed=1)
    with pytest.raises(ValueError, match="1 of the whole numbers from 0 to 1"):
        env.step(action)
    many = LifeVectorEnv("CartPole-survival", 2)
    many.reset(seed=1)
    with pytest.raises(ValueError, match=r"2 of the whole numbers from 0 to 1|inhomogeneous"):
        many.step([0, action])


@pytest.mark.parametrize("action", [[0.1], [0.1, 0.2, 0.3], 0.1])
def test_an_action_has_the_shape_of_the_space(action: Any) -> None:
    pytest.importorskip("mujoco")
    env = LifeEnv("Reacher-forager")
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"give the shape \(1, 2\)"):
        env.step(action)
    env.close()


def test_a_life_begins_with_reset_and_ends_with_death() -> None:
    env = LifeEnv("CartPole-survival")
    with pytest.raises(ResetNeeded):
        env.step(0)
    env.reset(seed=1)
    assert any(env.step(0)[2] for _ in range(1_000))
    with pytest.raises(ResetNeeded):
        env.step(0)
    many = LifeVectorEnv("CartPole-survival", 2)
    with pytest.raises(ResetNeeded):
        many.step([0, 0])
    many.reset(seed=[3, 4])
    with pytest.raises(ValueError, match="2 of the whole numbers from 0 to 1"):
        many.step([0, 0, 0])


@pytest.mark.parametrize(
    "options", [{"tik": 1}, {"tick": -1}, {"tick": 2**31}, {"cell": 1.5}, {"cell": "a"}]
)
def test_a_place_of_birth_must_exist(options: dict[str, Any]) -> None:
    env, other = LifeEnv("CartPole-survival"), LifeEnv("CartPole-survival")
    with pytest.raises(ValueError, match="options: "):
        env.reset(options=options)
    for each in (env, other):
        each.reset(seed=4)
    with pytest.raises(ValueError, match="options: "):
        env.reset(seed=5, options=options)
    assert (env.reset()[0] == other.reset()[0]).all(), "a refused reset begins no life"


def test_wrong_arguments_of_environments_are_errors() -> None:
    with pytest.raises(ValueError, match="render_mode: 'human'"):
        LifeEnv("CartPole-survival", render_mode="human")
    for count in (0, -1, 2.0, "2", 10**9):
        with pytest.raises(ValueError, match="num_envs"):
            LifeVectorEnv("CartPole-survival", count)
    many = LifeVectorEnv("CartPole-survival", 2)
    for wrong in ({"seed": [1]}, {"options": {"reset_mask": [True]}}):
        with pytest.raises(ValueError, match="for each of 2 bodies"):
            many.reset(**wrong)


def test_a_task_may_be_a_path(tmp_path: Path) -> None:
    (file := tmp_path / "small.toml").write_text("task = 'CartPole-survival'\ncells = 4")
    assert LifeEnv(file).observation_space.shape == (4,)
    with pytest.raises(TypeError, match="NoneType"):
        LifeEnv(None)


def test_a_compound_action_has_its_parts_side_by_side() -> None:
    kind = Compound((Discrete(3), Continuous(2)))
    rows = as_rows((np.array([2, 0]), np.array([[0.5, 1.0], [1.5, 2.0]])), kind, 2)
    np.testing.assert_array_equal(rows, np.array([[2, 0.5, 1], [0, 1.5, 2]], np.float32))
    for wrong in (([2, 3], [[0.0, 0.0]] * 2), ([2, 0],), ([2, 0], [[0.0]] * 2)):
        with pytest.raises(ValueError, match=r"actions: give|zip"):
            as_rows(wrong, kind, 2)
