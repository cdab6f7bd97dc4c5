"""Environments in JAX: their libraries, time limits, parameters, and packed states."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats.gymnax import libraries
from primordia.habitats.gymnax.libraries import NEVER, package_of
from primordia.habitats.gymnax.packed import pack
from primordia.habitats.gymnax.playground import is_playground
from primordia.habitats.gymnax.simulator import Simulator, _as, _params


@pytest.mark.parametrize(
    ("name", "package"),
    [
        ("CartPole-v1", "gymnax"),
        ("Craftax-Symbolic-v1", "craftax"),
        ("octax:pong", "octax"),
        ("playground:CartpoleBalance", "playground"),
        ("tests.walks:Walk", "tests.walks"),
    ],
)
def test_the_package_of_an_environment_follows_from_its_name(name: str, package: str) -> None:
    assert package_of(name) == package


@pytest.mark.parametrize(
    ("env", "packages"),
    [
        ("tests.walks:Walk", set()),
        ("CartPole-v1", {"gymnax", "flax"}),
        ("Craftax-Pixels-v1", {"craftax", "flax"}),
        ("octax:pong", {"octax", "flax"}),
        ("playground:CartpoleBalance", {"playground", "mujoco-mjx", "mujoco", "flax"}),
    ],
)
def test_the_versions_are_those_of_the_packages_that_compute_an_environment(
    env: str, packages: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(libraries, "version", lambda name: f"1 of {name}")
    found = libraries.versions.__wrapped__(env)
    assert found == {name: f"1 of {name}" for name in packages}


@pytest.mark.parametrize("time_limit", [False, True])
def test_the_time_limit_of_a_game_of_octax_is_set_when_it_is_made(
    time_limit: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[tuple[str, dict[str, Any]]] = []

    def create(name: str, **limits: Any) -> tuple[str, None]:
        made.append((name, limits))
        return f"the game {name}", None

    modules = {
        "octax.environments": SimpleNamespace(__path__=["here"], create_environment=create),
        "octax.wrappers": SimpleNamespace(OctaxGymnaxWrapper=lambda env: (env,)),
    }
    monkeypatch.setattr(libraries, "import_module", modules.__getitem__)
    found = [SimpleNamespace(name=name) for name in ("pong", "space_flight")]
    monkeypatch.setattr(libraries, "iter_modules", lambda path: found)
    assert libraries.make("octax:space-flight10", time_limit) == ("the game space-flight10",)
    limits = {} if time_limit else {"max_num_steps_per_episodes": NEVER}
    assert made == [("space-flight10", limits)]
    with pytest.raises(ValueError, match="octax has no environment 'pongg'; did you mean 'pong'"):
        libraries.make("octax:pongg", time_limit)


class Cut:
    """An environment that is done only at age 3 and reports a time limit from age 5 on."""

    def reset_env(self, key: Any, params: Any) -> tuple[Any, Any]:
        return jnp.float32(0), jnp.int32(0)

    def step_env(self, key: Any, state: Any, action: Any, params: Any) -> tuple[Any, ...]:
        return jnp.float32(state), state + 1, 1, state + 1 == 3, {}

    def is_truncated(self, state: Any, params: Any) -> Any:
        return state >= params

    def action_space(self, params: Any) -> Any:
        return SimpleNamespace(n=2, shape=(), dtype=jnp.int32)


@pytest.mark.parametrize("time_limit", [False, True])
def test_a_reported_time_limit_ends_a_life_only_if_the_limit_is_kept(
    time_limit: bool,
) -> None:
    env, key = Simulator(Cut(), 5, time_limit), jnp.zeros(2, jnp.uint32)
    state, done = env.reset(key)[1], []
    for _ in range(6):
        stepped = env.step(key, state, jnp.int32(0))
        state = stepped.state
        done.append(bool(stepped.done))
        assert (stepped.reward.dtype, float(stepped.reward)) == (jnp.float32, 1.0)
    assert done == [False, False, True, False, time_limit, time_limit]


@dataclass(frozen=True)
class Limits:
    max_steps_in_episode: int = 5
    max_timesteps: int = 7
    energy: int = 9


@pytest.mark.parametrize(
    ("given", "time_limit", "means"),
    [
        ({}, True, Limits()),
        ({}, False, Limits(NEVER, NEVER, 9)),
        ({"energy": 3}, False, Limits(NEVER, NEVER, 3)),
        ({"max_timesteps": 4}, False, Limits(NEVER, 4, 9)),
        ({"max_steps_in_episode": 4}, True, Limits(4, 7, 9)),
    ],
)
def test_a_limit_that_is_a_parameter_is_off_unless_it_is_given_or_kept(
    given: dict[str, Any], time_limit: bool, means: Limits
) -> None:
    env = SimpleNamespace(default_params=Limits())
    params = _params(env, "any", given, time_limit)
    assert params == means
    limits = ["max_steps_in_episode", "max_timesteps"]
    assert Simulator(env, params, time_limit).limits == limits


class Changing(Cut):
    """An environment whose state has two parts. The test gives the state at birth and the later one."""

    def __init__(self, born: Any, later: Any) -> None:
        self.born, self.later = born, later

    def reset_env(self, key: Any, params: Any) -> tuple[Any, Any]:
        return jnp.float32(0), self.born

    def step_env(self, key: Any, state: Any, action: Any, params: Any) -> tuple[Any, ...]:
        return jnp.float32(0), self.later, 1, False, {}


@pytest.mark.parametrize("place", [0, 1])
def test_no_array_of_a_state_changes_its_shape(place: int) -> None:
    born, later = ([jnp.zeros(2), jnp.zeros(3)] for _ in range(2))
    later[place] = jnp.zeros(4)
    with pytest.raises(ValueError, match="one form after a reset and another after a step"):
        Simulator(Changing(born, later), None, False).reset(jnp.zeros(2, jnp.uint32))


def test_a_state_with_a_key_of_the_new_kind_is_refused() -> None:
    """Its bits are no array that a checkpoint could hold."""
    states = [jnp.zeros(2), jax.random.key(0)]
    with pytest.raises(ValueError, match=r"^env: .* make it with jax\.random\.PRNGKey$"):
        Simulator(Changing(states, states), None, False).reset(jnp.zeros(2, jnp.uint32))


def test_a_number_has_a_type_that_holds_its_values_at_birth_and_later() -> None:
    key = jnp.zeros(2, jnp.uint32)
    born, later = [jnp.int32(3), jnp.float32(0.5)], [jnp.float32(2.5), jnp.int32(4)]
    env = Simulator(Changing(born, later), None, False)
    state = env.reset(key)[1]
    assert [(each.dtype, each.item()) for each in state] == [(jnp.float32, 3), (jnp.float32, 0.5)]
    state = env.step(key, state, jnp.int32(0)).state
    assert [(each.dtype, each.item()) for each in state] == [(jnp.float32, 2.5), (jnp.float32, 4)]


@pytest.mark.parametrize("drift", [(0, 0), (1, 0), (0, 1)])
def test_an_environment_repeats_if_its_functions_are_the_same_in_each_trace(
    drift: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """An array or a number of a step is another one in each trace. JAX forgets what it has traced
    before; here it only says so, to save time."""
    calls, cleared, (array, number) = list[None](), list[str](), drift

    class Drifting(Cut):
        def step_env(self, *given: Any) -> tuple[Any, ...]:
            calls.append(None)
            seen, *others = super().step_env(*given)
            added = jnp.asarray(np.arange(9.0) + array * len(calls)).sum()
            return seen * (1.5 + number * len(calls)) + added, *others

    monkeypatch.setattr(jax, "clear_caches", lambda: cleared.append("all"))
    assert Simulator(Drifting(), 5, False).repeats() is not any(drift)
    assert cleared == ["all"]


def test_an_environment_like_playgrounds_has_all_of_its_members() -> None:
    members: dict[str, Any] = {"reset": print, "step": print, "action_size": 2}
    assert is_playground(SimpleNamespace(**members))
    assert not is_playground(SimpleNamespace(**members, reset_env=print))
    for name in members:
        some = {key: value for key, value in members.items() if key != name}
        assert not is_playground(SimpleNamespace(**some))


GIVEN: list[tuple[Any, Any, Any]] = [
    (0.5, 2, 2.0),
    (0.5, 0.25, 0.25),
    (3, 4, 4),
    (True, False, False),
    ("a", "b", "b"),
    ((1, 2), [3, 4, 5], (3, 4, 5)),
    ([1, 2], [3], [3]),
    (jnp.zeros(2), [3, 4], [3.0, 4.0]),
    (jnp.int32(1), 7, 7),
]
"""a parameter's default, a value in settings, the parameter"""


@pytest.mark.parametrize(("default", "given", "means"), GIVEN)
def test_a_parameter_has_the_type_of_its_default(default: Any, given: Any, means: Any) -> None:
    found = _as(default, given, "gusts")
    if isinstance(default, jax.Array):
        assert (found.dtype, found.shape, found.tolist()) == (default.dtype, default.shape, means)
    else:
        assert (type(found), found) == (type(default), means)


@pytest.mark.parametrize(
    ("default", "given"),
    [(3, 4.5), (3, True), (True, 1), (0.5, "a"), (jnp.zeros(2), [1, 2, 3]), ((1, 2), 3), ("a", 1)],
)
def test_a_parameter_of_another_type_is_refused(default: Any, given: Any) -> None:
    with pytest.raises(ValueError, match=r"^params: gusts is .*type and shape of its default"):
        _as(default, given, "gusts")


def test_a_packed_state_is_the_state_bit_for_bit() -> None:
    """Single numbers become words of 32 bits in one array; arrays are unchanged."""
    state = {
        "a": np.float32(-0.1), "b": np.float32([0, 1, 2]), "c": np.bool_(True), "d": np.int32(-7),
        "e": {"f": np.uint32(2**32 - 1), "g": np.zeros((2, 2), bool), "h": np.bool_(False)},
        "i": np.uint8(200), "j": np.float32(np.nan),
    }  # fmt: skip
    senses = np.float32([0.3, -np.inf])
    packed = jax.jit(pack)(senses, state)
    assert (packed.words.shape, len(packed.arrays)) == ((2 + 6,), 3)
    form = jax.eval_shape(lambda: state)
    found, back = jax.jit(lambda each: (each.senses(2), each.state(2, form)))(packed)
    np.testing.assert_array_equal(found, senses)
    assert {*back} == {*state}
    for one, other in zip(jax.tree.leaves(back), jax.tree.leaves(state), strict=True):
        assert one.dtype == other.dtype
        np.testing.assert_array_equal(one, other)
