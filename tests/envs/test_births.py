"""Births in environments: places, seeds and settings that a caller gives; arrays that a caller keeps."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from primordia.envs import LifeEnv, LifeVectorEnv
from primordia.envs.bodies import as_rows, label
from primordia.habitats.contract import Compound, Continuous, Discrete

TASK = "CartPole-survival"


def test_a_place_that_is_given_replaces_the_number_of_the_life() -> None:
    """Life number n is born at tick n in cell 0. Tick 0 and cell 0 are places, too."""
    env = LifeEnv(TASK)
    lives = [env.reset(seed=3)[0], env.reset()[0]]
    for options, life in (({"tick": 0}, 0), ({"tick": np.int64(1), "cell": np.uint8(0)}, 1)):
        np.testing.assert_array_equal(env.reset(options=options)[0], lives[life])
    for place in ({"tick": 2**31 - 1}, {"tick": 0, "cell": 1}):
        assert (env.reset(options=place)[0] != lives).all()


def test_all_bits_of_a_seed_count_also_those_of_the_seed_0() -> None:
    env, seeds = LifeEnv(TASK), [0, 2**32, 0, 7 + 2**40, 7]
    alone = [env.reset(seed=seed)[0] for seed in seeds]
    assert len(np.unique(alone, axis=0)) == 4
    many = LifeVectorEnv(TASK, 5)
    np.testing.assert_array_equal(many.reset(seed=seeds)[0], alone)
    single = LifeVectorEnv(TASK)
    np.testing.assert_array_equal(single.reset(seed=7 + 2**40)[0], alone[3:4])


@pytest.mark.parametrize("kind", [LifeEnv, LifeVectorEnv])
def test_senses_that_were_given_do_not_change_later(kind: Any) -> None:
    env = kind(TASK)
    given = [env.reset(seed=1)[0]]
    kept = [given[0].copy()]
    action = env.action_space.sample() * 0
    for _ in range(3):
        for play in (lambda: env.step(action), env.reset):
            given.append(play()[0])
            kept.append(given[-1].copy())
    np.testing.assert_array_equal(given, kept)


def test_settings_that_differ_from_those_of_the_task_hold() -> None:
    settings = {"habitat": {"senses": ["theta"]}}
    assert LifeEnv(TASK, settings).observation_space.shape == (1,)
    assert LifeVectorEnv(TASK, 2, settings).reset(seed=1)[0].shape == (2, 1)


def test_choices_of_every_integer_type_are_rows_and_there_is_a_row_for_each_body() -> None:
    for dtype in (np.uint8, np.int64):
        rows = as_rows(np.array([2, 0], dtype), Discrete(3), 2)
        assert (rows.tolist(), rows.dtype) == ([2, 0], np.int32)
    for count in (1, 3):
        with pytest.raises(ValueError, match=rf"give the shape \(2, 2\), not \({count}, 2\)"):
            as_rows(np.zeros((count, 2)), Continuous(2), 2)


def test_a_single_body_takes_the_parts_of_a_compound_action() -> None:
    """The test replaces the bodies and notes their actions."""
    kind = Compound((Discrete(3), Continuous(2), Discrete(2)))
    noted: list[Any] = []

    def step(action: np.ndarray, alive: np.ndarray) -> np.ndarray:
        noted.append(action.tolist())
        return np.array([-1 if len(noted) < 2 else 0])

    env: Any = object.__new__(LifeEnv)
    bodies = {"habitat": SimpleNamespace(action=kind), "step": step, "senses": np.zeros((1, 4)),
              "food": np.array([2.5]), "energy": np.array([7.0])}  # fmt: skip
    env._bodies, env._alive, env._reward = SimpleNamespace(**bodies), np.ones(1, bool), 1.5
    _, *result = env.step((2, np.array([0.5, -1]), np.int64(1)))
    assert result == [1.5, False, False, {"food": 2.5, "energy": 7.0}]
    _, *result = env.step((0, [0.25, 1], 0))
    assert result == [0.0, True, False, {"food": 2.5, "energy": 7.0, "cause": label(0)}]
    assert noted == [[[2, 0.5, -1, 1]], [[0, 0.25, 1, 0]]]
