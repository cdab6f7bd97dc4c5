"""Robots: equal to Gymnasium's environments step for step; births, targets, deaths and failures."""

from typing import Any

import numpy as np
import pytest

from primordia.config import load
from primordia.habitats.contract import Outcome
from tests.robots import born, of_task, opened

mujoco = pytest.importorskip("mujoco")
gymnasium = pytest.importorskip("gymnasium")

TICKS = 60
FOUR = np.ones(4, bool)


def started_alike(name: str, habitat: Any, body: int, **options: Any) -> Any:
    """Return Gymnasium's environment in the state that a body was born in."""
    env = gymnasium.make(name, disable_env_checker=True, **options).unwrapped
    env.reset(seed=0)
    seen = habitat._bodies.views
    env.set_state(seen["qpos"][body].copy(), seen["qvel"][body].copy())
    return env


ALIKE: list[Any] = [
    ("HalfCheetah-forager", "HalfCheetah-v5", {}, {}, slice(0, 17)),
    pytest.param("Walker-survival-forager", "Walker2d-v5", {"xml_file": "walker2d.xml"},
                 {"timestep": "none"}, slice(0, 17), marks=pytest.mark.slow),
    ("Hopper-survival", "Hopper-v5", {}, {}, slice(0, 11)),
    pytest.param("Humanoid-homeostasis", "Humanoid-v5", {}, {"timestep": "none"}, slice(0, 45),
                 marks=pytest.mark.slow),
    ("Reacher-forager", "Reacher-v5", {}, {}, slice(0, 8)),
]  # fmt: skip


@pytest.mark.parametrize(("task", "name", "options", "changes", "common"), ALIKE)
def test_senses_and_physics_are_gymnasiums_to_the_bit(
    task: str, name: str, options: dict, changes: dict, common: slice
) -> None:
    habitat = of_task(task, **changes)
    senses = born(habitat)
    envs = [started_alike(name, habitat, body, **options) for body in range(4)]
    rng, alive, compared = np.random.default_rng(1), FOUR.copy(), 0
    for _ in range(TICKS):
        high = envs[0].action_space.high
        action = high * rng.uniform(-1, 1, (4, habitat.action.size)).astype(np.float32)
        before = habitat._bodies.views["qpos"][:, 0].copy()
        senses, outcome = habitat.step(action, FOUR)
        for body, env in enumerate(envs):
            # Gymnasium's target stays in place, ours moves when it is reached.
            if task == "Reacher-forager":
                env.data.qpos[2:] = habitat._bodies.views["qpos"][body, 2:]
            seen, _, terminated, _, _ = env.step(action[body])
            if not alive[body] or (outcome.food[body] and task == "Reacher-forager"):
                continue
            np.testing.assert_array_equal(senses[body, common], seen[common].astype(np.float32))
            compared += 1
            if task == "HalfCheetah-forager":
                assert outcome.food[body] == np.float32(env.data.qpos[0] - before[body])
            if task.startswith(("Walker", "Humanoid")):
                assert outcome.fatal[body] == terminated
        alive &= ~outcome.fatal
    assert compared > (200 if task in ("HalfCheetah-forager", "Reacher-forager") else 40)


@pytest.mark.parametrize(
    ("task", "name", "tolerance"),
    [
        ("HalfCheetah-forager", "HalfCheetah-v5", 1e-5),
        ("Walker-survival-forager", "Walker2d-v5", 1e-5),
        ("Hopper-survival", "Hopper-v5", 1e-5),
        ("Humanoid-forager", "Humanoid-v5", 1e-5),
        ("Reacher-forager", "Reacher-v5", 0.02),
    ],
)
def test_scores_are_gymnasiums(task: str, name: str, tolerance: float) -> None:
    """Games also end as in Gymnasium. There are three differences.

    Gymnasium rewards its reacher for the place of the fingertip one substep earlier. Its humanoid pays
    for contacts. It gives no reward for health in the tick of a fall.
    """
    habitat = load(task).build_habitat().original()
    assert habitat.episode == gymnasium.spec(name).max_episode_steps
    habitat.open(4)
    born(habitat)
    env = started_alike(name, habitat, 2)
    rng, paid, ours = np.random.default_rng(5), 0.0, 0.0
    for _ in range(50):
        limit = env.action_space.high[0]
        action = rng.uniform(-limit, limit, (4, habitat.action.size)).astype(np.float32)
        _, outcome = habitat.step(action, FOUR)
        _, reward, terminated, _, parts = env.step(action[2])
        paid, ours = paid + reward - parts.get("reward_contact", 0), ours + float(outcome.food[2])
        assert outcome.fatal[2] == terminated
        if terminated:
            ours -= env._healthy_reward
            break
    assert ours == pytest.approx(paid, rel=tolerance, abs=tolerance)


def test_a_body_is_a_function_of_its_words_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """The body does not depend on the number of bodies, its cell, or the number of cores.

    Each core has a thread; with one core, that is the thread that calls.
    """
    monkeypatch.setenv("PRIMORDIA_CORES", "1")
    one = of_task("Reacher-forager", 1)
    monkeypatch.setenv("PRIMORDIA_CORES", "2")
    many = of_task("Reacher-forager", 37)
    assert (one._bodies.batch.nthread, many._bodies.batch.nthread) == (1, 2)
    words = np.random.default_rng(3).integers(0, 2**32, (37, many.words), np.uint32)
    both = [many.reset(np.arange(37), words)[21], one.reset(np.array([0]), words[21:22])[0]]
    np.testing.assert_array_equal(*both)
    for tick in range(30):
        action = np.sin(np.arange(74).reshape(37, 2) + tick / 9).astype(np.float32)
        (senses, outcome), (sole, its) = (
            many.step(action, np.ones(37, bool)),
            one.step(action[21:22], np.ones(1, bool)),
        )
        np.testing.assert_array_equal(senses[21], sole[0])
        assert (outcome.food[21], outcome.effort[21]) == (its.food[0], its.effort[0])


def test_each_position_and_velocity_has_a_word_of_its_own() -> None:
    """So no velocity follows from a position."""
    habitat = of_task("HalfCheetah-forager", 1)
    words = np.random.default_rng(8).integers(0, 2**32, (1, habitat.words), np.uint32)
    sizes = [habitat._bodies.views[name].shape[1] for name in ("qpos", "qvel")]
    assert habitat.words == sum(sizes)

    def place(word: int | None = None) -> list[np.ndarray]:
        changed = words.copy()
        if word is not None:
            changed[0, word] ^= np.uint32(0x5A5A5A5A)
        habitat.reset(np.array([0]), changed)
        return [habitat._bodies.views[name][0].copy() for name in ("qpos", "qvel")]

    before = place()
    for which, size in enumerate(sizes):
        for k in range(size):
            after = place(sum(sizes[:which]) + k)
            assert np.flatnonzero(after[which] != before[which]).tolist() == [k]
            np.testing.assert_array_equal(after[1 - which], before[1 - which])


def test_births_are_spread_as_the_settings_say() -> None:
    uniform = opened(2000, position_noise=0.25, velocity_noise=0.5)
    born(uniform, 2000)
    for name, most in (("qpos", 0.25), ("qvel", 0.5)):
        assert np.abs(uniform._bodies.views[name]).max() == pytest.approx(most, rel=1e-3)
        assert uniform._bodies.views[name].std() == pytest.approx(most / np.sqrt(3), rel=0.02)
    gaussian = opened(2000, velocity_sd=2.0)
    born(gaussian, 2000)
    assert (gaussian._bodies.views["qpos"] == 0).all()
    assert gaussian._bodies.views["qvel"].std() == pytest.approx(2.0, rel=0.02)
    assert np.abs(gaussian._bodies.views["qvel"]).max() > 6


def test_the_dead_are_not_stepped_and_a_failure_does_not_disturb_other_bodies() -> None:
    habitat, undisturbed = opened(), opened()
    for each in (habitat, undisturbed):
        born(each)
    habitat._bodies.views["qvel"][1] = 1e200
    alive, action = np.array([True, True, False, True]), np.full((4, 6), 0.5, np.float32)
    for _ in range(5):
        before = habitat._bodies.views["qpos"][2].copy(), habitat._bodies.views["qvel"][2].copy()
        senses, outcome = habitat.step(action, alive)
        others, _ = undisturbed.step(action, FOUR)
        np.testing.assert_array_equal(before[0], habitat._bodies.views["qpos"][2])
        np.testing.assert_array_equal(before[1], habitat._bodies.views["qvel"][2])
        np.testing.assert_array_equal(senses[[0, 3]], others[[0, 3]])
        assert outcome.fault[1] or not np.isfinite(senses[1]).all()


@pytest.mark.parametrize(
    "amount", ["height", "pitch", 'xpos["ffoot"][0]', "forward", "com_forward", "travelled"]
)
def test_an_amount_that_nothing_else_observes_is_that_of_the_end_of_the_tick(amount: str) -> None:
    """So MuJoCo derives positions after a tick for the sake of each amount alone."""
    habitat = opened(1, food=amount, velocity_noise=1.0)
    born(habitat, 1)
    data = mujoco.MjData(habitat._model)

    def place() -> tuple[float, np.ndarray]:
        data.qpos[:] = habitat._bodies.views["qpos"][0]
        mujoco.mj_kinematics(habitat._model, data)
        mujoco.mj_comPos(habitat._model, data)
        return data.qpos[0], data.subtree_com[0, :2].copy()

    for _ in range(3):
        x, com = place()
        _, outcome = habitat.step(np.full((1, 6), -0.4, np.float32), np.ones(1, bool))
        new_x, new_com = place()
        expected = {
            "height": data.body("torso").xpos[2],
            "pitch": data.qpos[2],
            'xpos["ffoot"][0]': data.body("ffoot").xpos[0],
            "forward": new_x - x,
            "com_forward": (new_com - com)[0],
            "travelled": np.hypot(*(new_com - com)),
        }
        np.testing.assert_allclose(outcome.food, expected[amount], rtol=1e-6)


def test_effort_and_death_may_each_observe_what_nothing_else_does() -> None:
    """The speeds at birth are up to 1 m/s, and a tick has 0.05 s."""

    def stepped(**settings: Any) -> tuple[np.ndarray, Outcome]:
        habitat = opened(**settings, velocity_noise=1.0)
        born(habitat)
        return habitat.step(np.zeros((4, 6), np.float32), FOUR)

    effort = np.asarray(stepped(effort="travelled")[1].effort)
    assert ((effort > 0) & (effort < 0.1)).all()
    fatal = stepped(fatal="com_forward * height > 0")[1].fatal.tolist()
    senses, _ = stepped(senses=("com_forward",))
    assert fatal == (senses[:, 0] > 0).tolist()
    assert set(fatal) == {False, True}


def test_controls_are_clipped_to_their_ranges() -> None:
    habitat = opened(effort="sum(ctrl * ctrl)")
    born(habitat)
    _, outcome = habitat.step(np.full((4, 6), 50.0, np.float32), FOUR)
    assert outcome.effort.tolist() == [6.0] * 4
