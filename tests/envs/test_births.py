"""Births in environments: the given places and seeds, and the returned senses."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from primordia.envs import LifeEnv, LifeVectorEnv

TASK = "CartPole-survival"


def test_a_given_place_replaces_the_number_of_the_life() -> None:
    """Without a place, life number n is born at tick n in cell 0."""
    env = LifeEnv(TASK)
    lives = [env.reset(seed=3)[0], env.reset()[0]]
    for options, life in (({"tick": 0}, 0), ({"tick": np.int64(1), "cell": np.uint8(0)}, 1)):
        np.testing.assert_array_equal(env.reset(options=options)[0], lives[life])
    for place in ({"tick": 2**31 - 1}, {"tick": 0, "cell": 1}):
        assert (env.reset(options=place)[0] != lives).all()


def test_seeds_that_differ_in_any_bit_give_other_lives() -> None:
    env, seeds = LifeEnv(TASK), [0, 2**32, 7 + 2**40]
    alone = [env.reset(seed=seed)[0] for seed in seeds]
    assert len(np.unique([*alone, env.reset(seed=7)[0]], axis=0)) == 4
    many = LifeVectorEnv(TASK, 3)
    np.testing.assert_array_equal(many.reset(seed=seeds)[0], alone)
    single = LifeVectorEnv(TASK)
    np.testing.assert_array_equal(single.reset(seed=7 + 2**40)[0], alone[2:])


@pytest.mark.parametrize("kind", [LifeEnv, LifeVectorEnv])
def test_returned_senses_do_not_change_later(kind: Any) -> None:
    env = kind(TASK)
    returned = [env.reset(seed=1)[0]]
    copies = [returned[0].copy()]
    action = env.action_space.sample() * 0
    for _ in range(3):
        for play in (lambda: env.step(action), env.reset):
            returned.append(play()[0])
            copies.append(returned[-1].copy())
    np.testing.assert_array_equal(returned, copies)
