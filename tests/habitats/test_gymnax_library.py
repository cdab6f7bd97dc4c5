"""The environments of gymnax and Craftax: the same as in their own libraries, and exact."""

from importlib import import_module
from importlib.util import find_spec
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import lax

from primordia.config import load, validated
from primordia.errors import InputError
from primordia.habitats.framed import MARGIN
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.habitats.gymnax.task import task
from primordia.testing import check_habitat

pytestmark = pytest.mark.skipif(
    find_spec("gymnax") is None, reason="pip install --no-deps --group no-deps"
)

CLASSIC = ["CartPole-v1", "Acrobot-v1", "MountainCar-v0", "MountainCarContinuous-v0", "Pendulum-v1",
           "Catch-bsuite"]  # fmt: skip
MINATAR = [
    f"{name}-MinAtar" for name in ("Asterix", "Breakout", "Freeway", "Seaquest", "SpaceInvaders")
]
WORDS = np.random.default_rng(5).integers(2**32, size=(6, 2), dtype=np.uint32)


@pytest.mark.parametrize(
    "name",
    ["Catch-bsuite", *(pytest.param(name, marks=pytest.mark.slow) for name in MINATAR[:2])],
)
def test_a_life_is_what_the_library_computes(name: str) -> None:
    habitat, (env, params) = Gymnax(env=name, food="reward"), import_module("gymnax").make(name)
    folded = jax.vmap(jax.random.fold_in, (0, None))
    begin, go_on = jax.vmap(env.reset_env, (0, None)), jax.vmap(env.step_env, (0, 0, 0, None))

    def both(words: Any) -> Any:
        def tick(carry: Any, age: Any) -> Any:
            (bodies, state), action = carry, jnp.full(6, age % habitat.action.size, jnp.int32)
            seen, state, reward, done, _ = go_on(folded(words, age), state, action, params)
            bodies, outcome = habitat.step(bodies, action)
            ours = habitat.sense(bodies), outcome.fatal, outcome.food
            return (bodies, state), (ours, (seen.reshape(6, -1), done, reward))

        born = habitat.reset(words), begin(folded(words, 0), params)[1]
        return lax.scan(tick, born, jnp.arange(1, 12))[1]

    with jax.threefry_partitionable(True):
        ours, theirs = jax.jit(both)(WORDS)
    jax.tree.map(np.testing.assert_array_equal, ours, theirs)
    assert ours[1].any()


@pytest.mark.slow
@pytest.mark.parametrize("name", [*CLASSIC, *MINATAR])
def test_bits_depend_on_words_and_actions_alone(name: str) -> None:
    check_habitat(Gymnax(env=name, food="reward"))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["Craftax-Classic-Symbolic-v1"])
def test_craftax_keeps_the_contract(name: str) -> None:
    pytest.importorskip("craftax")
    check_habitat(Gymnax(env=name, food="reward"))


@pytest.mark.slow
def test_a_task_is_made_from_lives_at_random() -> None:
    table = task("CartPole-v1").table
    assert 1 / 40 < table["replication"] < 1 / 15
    assert validated(table, source="test").build_habitat().env in table["about"]


def test_a_name_that_is_not_known_suggests_one() -> None:
    with pytest.raises(InputError, match="did you mean 'Breakout-MinAtar'"):
        task("Breakout-minatar")
    pytest.importorskip("craftax")
    with pytest.raises(InputError, match="did you mean 'Craftax-Symbolic-v1'"):
        task("Craftax-Symbolik-v1")


def test_a_task_has_the_grid_as_senses_and_the_versions_of_its_libraries() -> None:
    habitat: Any = load("MinAtar-Breakout-survival").build_habitat()
    assert habitat.senses_size == 400
    assert set(habitat.versions) == {"gymnax", "flax"}


@pytest.mark.parametrize(
    ("name", "view", "size"),
    [
        ("CartPole-v1", {}, (600, 400)),
        pytest.param("Breakout-MinAtar", {}, (400, 400), marks=pytest.mark.slow),
        ("Catch-bsuite", {}, (200, 400)),
        ("Catch-bsuite", {"centre": 0, "sight": 1}, (200, 400)),
        pytest.param("Craftax-Classic-Symbolic-v1", {}, (576, 576), marks=pytest.mark.slow),
    ],
)
def test_a_life_is_drawn_by_its_library_or_as_it_is_sensed(
    name: str, view: dict[str, int], size: tuple[int, int], capfd: pytest.CaptureFixture[str]
) -> None:
    """Where a player perceives a part of a grid, the whole grid is drawn."""
    habitat = Gymnax(env=name, **view)
    body = jax.tree.map(lambda leaf: np.asarray(leaf)[0], jax.jit(habitat.reset)(WORDS))
    picture = habitat.picture(body, np.int32(0))
    assert picture.size == (size[0], size[1] + MARGIN)
    assert len(picture.getcolors(maxcolors=100_000)) >= 3
    assert capfd.readouterr() == ("", "")


@pytest.mark.slow
def test_a_task_of_mujoco_playground_keeps_the_contract() -> None:
    needs = "pip install 'primordia[playground]'"
    pytest.importorskip("mujoco_playground", reason=needs, exc_type=ImportError)
    habitat = Gymnax(env="playground:PendulumSwingup", food="max(reward, 0)")
    check_habitat(habitat)
    body = jax.tree.map(lambda leaf: np.asarray(leaf)[0], habitat.reset(WORDS))
    assert len(habitat.picture(body, np.zeros(1, np.float32)).getcolors(maxcolors=100_000)) > 100
    with pytest.raises(ValueError, match="did you mean 'CartpoleBalance'"):
        Gymnax(env="playground:CartpoleBalnce")
