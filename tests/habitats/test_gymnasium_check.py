"""The check of Gymnasium environments finds what is wrong, and how lives can go on."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from primordia.habitats.gymnasium import check, state
from primordia.habitats.gymnasium.check import LIVES, measure
from primordia.habitats.gymnasium.environment import make
from primordia.habitats.gymnasium.probe import check_food, info_of
from tests import ponds
from tests.ponds import Pond

FAULTS = {
    "Unseeded": ("restart", False, "another beginning: the environment ignores its seed"),
    "Hidden": ("restart", False, "the same seed and actions give another life"),
    "Shared": ("restart", False, "draws random numbers from outside (such as np.random"),
    "Worn": ("snapshot", True, "reset does not restore everything"),
    "Grasping": ("snapshot", False, "step changes the action"),
    "Outside": ("snapshot", False, "outside the declared space"),
    "Broken": ("snapshot", False, "an observation is not finite"),
    "Crashing": ("snapshot", False, "step raises an error: ZeroDivisionError: the pond is empty"),
    "Unborn": ("snapshot", False, "reset raises an error: RuntimeError: no water"),
}


@pytest.fixture
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Live shorter lives; those of ponds end, or show their faults, within 60 ticks."""
    monkeypatch.setattr(check, "TICKS", 120)


@pytest.mark.usefixtures("_quick")
@pytest.mark.parametrize("name", FAULTS)
def test_each_fault_is_found(name: str) -> None:
    saving, fresh, says = FAULTS[name]
    found = measure(f"tests.ponds:{name}-v0", {})
    assert (found.saving, found.fresh) == (saving, fresh)
    assert any(says in fault for fault in found.faults)


@pytest.mark.usefixtures("_quick")
@pytest.mark.parametrize(
    ("name", "saving", "why"),
    [
        ("Pond", "snapshot", ""),
        ("Closed", "replay", "draws is a range_iterator, which cannot be saved"),
        ("Sealed", "replay", "a life does not go on exactly from a saved state"),
    ],
)
def test_sound_environments_have_no_fault(name: str, saving: str, why: str) -> None:
    found = measure(f"tests.ponds:{name}-v0", {})
    assert (found.saving, found.fresh, found.faults) == (saving, False, [])
    assert found.why.endswith(why)
    assert bool(found.why) == bool(why)
    assert found.ended


def test_the_lifespan_is_the_mean_of_the_ticks_lived_in_the_first_lives(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The test counts the steps of each life. Some lives have not ended when the measurement stops."""
    spans, left = list[int](), list[bool]()
    reset, step = Pond.reset, Pond.step

    def begin(self: Pond, **given: Any) -> Any:
        spans.append(0)
        left.append(False)
        return reset(self, **given)

    def go_on(self: Pond, action: Any) -> Any:
        found = step(self, action)
        spans[-1] += 1
        left[-1] = found[2]
        return found

    monkeypatch.setattr(Pond, "reset", begin)
    monkeypatch.setattr(Pond, "step", go_on)
    found = measure("tests.ponds:Pond-v0", {"edge": 4.0})
    assert found.lifespan == pytest.approx(np.mean(spans[:LIVES]))
    assert found.ended == sum(left[:LIVES])
    assert abs(np.mean(spans[:LIVES]) - np.median(spans[:LIVES])) > 1
    assert 0 < found.ended < LIVES


def test_an_environment_is_made_without_its_time_limit() -> None:
    """The pond is registered with a limit of 50 steps."""
    env = make("tests.ponds:Pond-v0", {"edge": 1e9})
    env.reset(seed=1)
    assert [env.step(np.zeros(1, np.float32))[2:4] for _ in range(60)] == [(False, False)] * 60


FOODS: list[tuple[Any, str | None]] = [
    (2, None),
    (2.5, None),
    (np.float32(2.5), None),
    (np.int64(2), None),
    ("2", "food: tests.ponds:food gives '2', which is not a number"),
    (np.zeros(1), "food: tests.ponds:food gives .*, which is not a number"),
    (None, "food: tests.ponds:food gives None"),
    (ValueError("no\nworms"), "food: tests.ponds:food fails: ValueError: no worms$"),
]


@pytest.mark.parametrize(("amount", "says"), FOODS)
def test_a_function_of_food_returns_a_number(
    amount: Any, says: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The function is given what a step returns."""
    given: list[tuple[Any, ...]] = []

    def food(*step: Any) -> Any:
        given.append(step)
        if isinstance(amount, Exception):
            raise amount
        return amount

    monkeypatch.setattr(ponds, "food", food)
    if says is None:
        check_food("tests.ponds:Pond-v0", {}, "tests.ponds:food")
    else:
        with pytest.raises(ValueError, match=says):
            check_food("tests.ponds:Pond-v0", {}, "tests.ponds:food")
    ((observation, reward, terminated, truncated, info),) = given
    assert (reward, terminated, truncated, info["age"]) == (observation[1], False, False, 1)


def test_an_environment_that_comes_with_gymnasium_goes_on_from_its_state() -> None:
    assert measure("FrozenLake-v1", {}).saving == "snapshot"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["InvertedPendulum-v5", "Hopper-v5"])
def test_robots_go_on_from_their_state(name: str) -> None:
    pytest.importorskip("mujoco")
    assert measure(name, {}).saving == "snapshot"


@pytest.mark.slow
def test_what_has_no_plain_state_is_lived_again() -> None:
    pytest.importorskip("Box2D")
    assert measure("LunarLander-v3", {}).saving == "replay"
    found = measure("BipedalWalker-v3", {})
    assert (found.saving, found.fresh) == ("replay", True)


def test_a_state_names_no_class_to_be_made() -> None:
    """A state of another environment is refused, and what it names is not looked for."""
    pond, cart = make("tests.ponds:Pond-v0", {}), make("CartPole-v1", {})
    for env in (pond, cart):
        env.reset(seed=1)
    with pytest.raises(state.UnknownStateError, match="is a Pond here, not a CartPoleEnv"):
        state.decode(pond, state.encode(cart))


@pytest.mark.parametrize("name", ["tests.ponds:Odd-v0", "CartPole-v1", "InvertedPendulum-v5"])
def test_a_restored_environment_has_the_state_that_was_saved(name: str) -> None:
    """The state of the restored environment, written again, is the same to the last byte."""
    if name.endswith("v5"):
        pytest.importorskip("mujoco")
    one, other = make(name, {}), make(name, {})
    for env, seed in ((one, 1), (other, 2)):
        env.action_space.seed(0)
        env.reset(seed=seed)
    for _ in range(3):
        one.step(one.action_space.sample())
    saved = state.encode(one)
    state.decode(other, saved)
    assert state.encode(other) == saved
    if name.endswith("v5"):
        inner: Any = other.unwrapped
        assert inner.mujoco_renderer.data is inner.data
        saver: Any = one.unwrapped
        for field in ("time", "ctrl", "qpos", "qvel", "qacc_warmstart"):
            np.testing.assert_array_equal(getattr(inner.data, field), getattr(saver.data, field))


def test_values_of_info_have_names_that_settings_can_write(monkeypatch: pytest.MonkeyPatch) -> None:
    reset = Pond.reset

    def begin(self: Pond, **given: Any) -> Any:
        return reset(self, **given)[0], {7: 1.0, ("a", "b"): 2, "depth": 3.0}

    monkeypatch.setattr(Pond, "reset", begin)
    assert info_of("tests.ponds:Pond-v0", {"edge": 2.75}) == {"age": 0, "depth": 0}
