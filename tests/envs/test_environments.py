"""Our tasks as Gymnasium environments: the same numbers as in a run, alone and side by side."""

import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

import gymnasium
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

import primordia
import primordia.envs
from primordia.config import load
from primordia.envs import LifeEnv, LifeVectorEnv
from primordia.law.world import Cause
from primordia.organism.reliving.relived import RelivedLife
from primordia.settings.tables import tasks
from tests.worlds import HOSTED

RANDOM = {"senses": (51, 49, 54), "sticky": 0.25, "noops": 30, "frame_skip": 3,
          "food": "ram[51] > 130", "workers": 0}  # fmt: skip
SMALL: dict[str, Any] = {"cells": 6, "seeds": 2, "genesis": "fill", "hazard": 0.003}
RIPPLES = {"food": "0.25", "effort": "abs(obs[1])", "workers": 0}
OWN: dict[str, dict[str, Any]] = {
    "Pong-survival": {**SMALL, "habitat": RANDOM, "metabolism": {"store": 60.0, "gain": 0.75}},
    "Reacher-forager-costly": SMALL,
    "gym:tests.ponds:Pond-v0": {**HOSTED, "replication": 0.3, "habitat": RIPPLES},
}
"""Settings of slow runs, with food and effort."""
LONG = 10_000
"""Ticks after which a body should have died, so that a test of deaths ends also without them."""
SIMULATORS = {"atari": "ale_py", "mujoco": "mujoco", "gymnasium": "Box2D"}
SHOWN = {"CartPole-survival", "Reacher-forager"}
"""Tasks in JAX and on the host, with both kinds of action. The others are slow."""


def marked(names: Iterable[str], shown: set[str]) -> list[Any]:
    """Return names as parameters; those that are not in `shown` are slow."""
    return [pytest.param(name, marks=() if name in shown else pytest.mark.slow) for name in names]


def needed(task: str) -> None:
    if package := SIMULATORS.get(load(task).habitat["name"]):
        pytest.importorskip(package)


@pytest.mark.parametrize("task", marked(tasks(), SHOWN))
def test_every_task_is_an_environment_that_gymnasium_accepts(task: str) -> None:
    needed(task)
    env = gymnasium.make(f"primordia/{task}-v0")
    with warnings.catch_warnings():  # Gymnasium advises against boxes without bounds
        warnings.filterwarnings("ignore", message=".*A Box (observation|action) space m.*")
        warnings.filterwarnings("ignore", message=".*For Box action spaces.*")
        check_env(env.unwrapped, skip_render_check=True)
    assert env.spec is not None
    assert env.spec.max_episode_steps is None
    env.close()


@pytest.mark.parametrize(
    ("task", "settings"),
    [
        ("CartPole-survival", {"cells": 8, "hazard": 0.002}),
        *(pytest.param(task, own, marks=pytest.mark.slow) for task, own in OWN.items()),
    ],
)
def test_a_life_has_the_numbers_that_it_has_in_a_run(
    task: str, settings: dict[str, Any], tmp_path: Path
) -> None:
    """The actions of an organism of a run, taken in the environment, from its birth to its death.

    It lives in the last world, whose seed is that of the run plus its number, and was born later.
    """
    needed(task)
    stop, last = {"ticks": 300, "until": "none"}, settings.get("seeds", 1) - 1
    run = primordia.run(task, tmp_path / "run", settings, stop=stop, seed=7)
    lives = run.lives()
    ended = lives.died & (lives.cause != Cause.HAZARD)
    which = ended & (lives.lifespan > 20) & (lives.world == last) & (lives.born > 0)
    row = np.flatnonzero(which & (lives.cell > 0))[0]
    life = RelivedLife.of(run.opened(), int(lives.id[row]), last)
    env = LifeEnv(task, settings)
    place = {"tick": int(life.record.born[0]), "cell": int(life.record.cell[0])}
    senses, _ = env.reset(seed=7 + last, options=place)
    for stretch in life.stretches():
        for i, action in enumerate(stretch.action):
            np.testing.assert_array_equal(senses, stretch.senses[i])
            senses, reward, died, truncated, info = env.step(action)
            assert info["food"] == stretch.eaten[i] / 1024
            assert info.get("energy", 0) == (stretch.energy[i] / 1024 if "energy" in info else 0)
            assert (reward, truncated) == (0, False)
    assert died
    assert life.cause is not None
    assert info["cause"] == life.cause.label
    env.close()


def played(env: Any, seed: int, actions: np.ndarray) -> list[tuple[Any, ...]]:
    """Return the results of one environment, life after life."""
    results: list[tuple[Any, ...]] = [(env.reset(seed=seed)[0],)]
    for action in actions:
        results.append(env.step(action))
        if results[-1][2]:
            results.append((env.reset()[0],))
    return results


@pytest.mark.parametrize(
    ("task", "mode"),
    [
        ("CartPole-survival", AutoresetMode.NEXT_STEP),
        ("CartPole-survival", AutoresetMode.DISABLED),
        ("Reacher-forager", AutoresetMode.NEXT_STEP),
        pytest.param("Reacher-forager", AutoresetMode.DISABLED, marks=pytest.mark.slow),
    ],
)
def test_environments_side_by_side_are_those_alone(task: str, mode: AutoresetMode) -> None:
    needed(task)
    made = gymnasium.make_vec(
        f"primordia/{task}-v0", num_envs=3, reward=1.0, autoreset_mode=mode.value
    )
    many: Any = made.unwrapped
    assert isinstance(many, LifeVectorEnv)
    many.action_space.seed(1)
    alone = [LifeEnv(task, reward=1.0) for _ in range(3)]
    one = [env.reset(seed=5 + number)[0] for number, env in enumerate(alone)]
    senses, _ = many.reset(seed=5)
    over, deaths = np.zeros(3, bool), 0
    for _ in range(120):
        np.testing.assert_array_equal(senses, one)
        if mode is AutoresetMode.DISABLED and over.any():
            senses, _ = many.reset(options={"reset_mask": over})
            for number in np.flatnonzero(over):
                one[number] = alone[number].reset()[0]
            np.testing.assert_array_equal(senses, one)
            over = np.zeros(3, bool)
        actions = many.action_space.sample()
        senses, rewards, ended, cut, info = many.step(actions)
        for number, env in enumerate(alone):
            if over[number]:
                one[number] = env.reset()[0]
                assert (rewards[number], ended[number]) == (0, False)
                continue
            one[number], reward, died, _, own = env.step(actions[number])
            assert (rewards[number], ended[number]) == (reward, died)
            assert {name for name in info if name[0] != "_" and info[f"_{name}"][number]} == {*own}
            assert {name: info[name][number] for name in own} == own
        assert not cut.any()
        deaths += ended.sum()
        over = ended
    assert deaths
    many.close()


def test_bodies_that_have_died_do_not_change_until_a_reset() -> None:
    """The first body dies long before the others, which are pushed left and right in turn."""
    many = LifeVectorEnv("CartPole-survival", 3, reward=1.0, autoreset_mode="Disabled")
    before, _ = many.reset(seed=2)
    over, deaths, ticks = np.zeros(3, bool), list[int](), 0
    while not over.all() and ticks < LONG:
        seen, rewards, ended, cut, info = many.step(np.array([0, ticks % 2, 1 - ticks % 2]))
        died, ticks = ended & ~over, ticks + 1
        deaths += [ticks] * int(died.sum())
        np.testing.assert_array_equal(seen[over], before[over])
        assert (seen[~over] != before[~over]).any(axis=1).all()
        assert ended[over].all()
        assert rewards.tolist() == np.where(ended, 0.0, 1.0).tolist()
        assert info.get("_cause", np.zeros(3, bool)).tolist() == died.tolist()
        assert not cut.any()
        before, over = seen, ended
    assert over.all()
    assert deaths[0] + 9 < deaths[1]


def test_bodies_keep_the_seeds_that_they_were_given() -> None:
    one = LifeEnv("CartPole-survival")
    lives = {seed: [one.reset(seed=seed)[0], one.reset()[0]] for seed in (5, 3, 9)}
    many = LifeVectorEnv("CartPole-survival", 3)
    np.testing.assert_array_equal(
        many.reset(seed=[5, 3, 9])[0], [each[0] for each in lives.values()]
    )
    np.testing.assert_array_equal(many.reset()[0], [each[1] for each in lives.values()])
    many.reset(seed=np.int64(5))
    masked = LifeVectorEnv("CartPole-survival", 3)
    masked.reset(seed=list(np.array([5, 3, 9])), options={"reset_mask": [True, False, False]})
    np.testing.assert_array_equal(masked.reset()[0], [lives[5][1], lives[3][0], lives[9][0]])
    masked.reset(seed=[9, 9, 3], options={"reset_mask": [True, False, False]})
    np.testing.assert_array_equal(masked.reset()[0], [lives[9][1], lives[3][1], lives[9][1]])


def test_bodies_without_a_seed_get_random_ones() -> None:
    first, second = (
        LifeVectorEnv("CartPole-survival", 3).reset(seed=[5, None, None])[0] for _ in "ab"
    )
    np.testing.assert_array_equal(first[0], second[0])
    assert len(np.unique([*first, *second], axis=0)) == 5


def test_the_first_life_without_a_seed_is_that_of_the_seed_drawn_for_it() -> None:
    env = LifeEnv("CartPole-survival")
    lives = [env.reset()[0], env.reset()[0]]
    again = [env.reset(seed=env.np_random_seed)[0], env.reset()[0]]
    np.testing.assert_array_equal(again, lives)
