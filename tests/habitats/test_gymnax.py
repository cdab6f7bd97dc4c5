"""Environments in JAX: lives from words and age, senses, actions, death, food, and errors."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import lax

from primordia.compiled import shared
from primordia.config import validated
from primordia.errors import InputError
from primordia.habitats.contract import Ability, Continuous, Discrete, Outcome
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.habitats.gymnax.quantities import kind, parts
from primordia.jaxprs import uses_first
from primordia.testing import check_habitat

WORDS = np.arange(8, dtype=np.uint32).reshape(4, 2)
STILL = np.zeros((4, 2), np.float32)


def walk(**settings: Any) -> Gymnax:
    return Gymnax(env="tests.walks:Walk", **settings)


class Past(NamedTuple):
    """What was seen of four bodies from birth on, (T + 1, 4, ...), and the outcomes of T ticks."""

    state: Any
    senses: np.ndarray
    age: np.ndarray
    held: np.ndarray | None
    outcome: Outcome
    born: Any


def all_of(habitat: Gymnax, words: Any, actions: Any) -> Past:
    """Return what is seen of lives with these actions, which are compiled as a whole."""

    def tick(bodies: Any, action: Any) -> Any:
        after, outcome = habitat.step(bodies, action)
        return after, (after, outcome)

    born = habitat.reset(words)
    later, outcome = lax.scan(tick, born, actions)[1]
    ages = jax.tree.map(lambda one, more: jnp.concatenate([one[None], more]), born, later)
    template = habitat.simulator.example.state
    state = jax.vmap(jax.vmap(lambda packed: packed.state(habitat.senses_size, template)))
    return Past(state(ages.packed), habitat.sense(ages), ages.age.lo, ages.held, outcome, born)


def lived(habitat: Gymnax, action: Any = STILL) -> Any:
    """Return what is seen of lives with one action of each body."""
    actions = np.broadcast_to(action, (9, *action.shape))
    return jax.tree.map(np.asarray, shared(all_of, habitat)(WORDS, actions))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["Walk", "Choice", "Turning"])
def test_an_environment_of_ones_own_keeps_the_contract(name: str) -> None:
    check_habitat(Gymnax(env=f"tests.walks:{name}", food="reward", squash=True))


def test_the_key_of_a_tick_is_that_of_the_birth_folded_with_the_age() -> None:
    with jax.threefry_partitionable(True):
        folded = jax.vmap(lambda key: jax.random.uniform(jax.random.fold_in(key, 3)))
        drawn = jax.jit(folded)(jax.random.wrap_key_data(WORDS, impl="threefry2x32"))
    np.testing.assert_array_equal(lived(walk()).state["gust"][3], drawn)


def test_the_environments_time_limit_ends_a_life_only_if_it_is_kept() -> None:
    assert lived(walk()).outcome.fatal.all(axis=1).tolist() == [False] * 8 + [True]
    assert walk().simulator.params.max_steps_in_episode > 2**30
    assert walk(time_limit=True).simulator.params.max_steps_in_episode == 5


def test_without_a_condition_no_life_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """The test gives the values of a tick: two of four walks are done."""
    done = [True, False, False, True]
    values = {"done": np.array(done)}
    monkeypatch.setattr(Gymnax, "tick", lambda self, bodies, action: (bodies, values))
    for fatal, ends in (
        ("", [False] * 4),
        ("done", done),
        ("not done", [False, True, True, False]),
    ):
        assert walk(fatal=fatal).step(None, STILL)[1].fatal.tolist() == ends


def test_death_and_food_can_speak_of_all_that_the_environment_says() -> None:
    """The energy of a walk is 4 at birth, so half of its range is 2. Its senses are squashed."""
    said = {
        "fatal": 'state["tired"] and not done or obs[2] < -4.5',
        "food": 'max(reward - 0.2, 0) + min(abs(obs[0]), 1) + sum(info["crossed"])',
    }
    past = lived(walk(**said, params={"energy": 4}, squash=True))
    fatal = [False, True, True, *[False] * 5, True]
    assert past.outcome.fatal.tolist() == [[each] * 4 for each in fatal]
    place = past.state["place"]
    size, crossed = np.abs(place[1:, :, 0]), (place[1:] > 0).sum(axis=2)
    food = np.maximum(size - 0.2, 0) + np.minimum(size, 1) + crossed
    np.testing.assert_allclose(past.outcome.food, food, 1e-6)
    assert lived(walk()).outcome.food is None
    squashed = place[..., 0] / (1 + np.abs(place[..., 0]))
    np.testing.assert_allclose(past.senses[..., 0], squashed, 1e-6)
    np.testing.assert_array_equal(past.senses[..., 1], place[..., 1])
    np.testing.assert_allclose(past.senses[:3, 0, 2], [1, 0.5, 0], atol=1e-6)


def test_outputs_within_one_fill_the_bounds_of_actions() -> None:
    """A gust moves a walk by half of its action."""
    for output, action in [(-1, -2), (0, 1), (1, 4), (7, 4), (-7, -2)]:
        place = lived(walk(), np.full((4, 2), output, np.float32)).state["place"]
        moved = place[1:] - np.float32(0.9) * place[:-1]
        np.testing.assert_allclose(moved, action / 2, atol=1e-5)
    assert walk().action == Continuous(2)


def test_senses_are_scaled_where_their_space_has_bounds() -> None:
    past = lived(walk(), np.ones((4, 2), np.float32))
    np.testing.assert_array_equal(past.senses[..., :2], past.state["place"])
    np.testing.assert_allclose(past.senses[3, :, 2], (6 - 4.5) / 4.5, 1e-6)


def test_an_environment_like_playgrounds_is_perceived_as_by_a_policy_and_ends_when_done() -> None:
    habitat = Gymnax(env="tests.walks:Played", food='info["far"]', fatal="done")
    assert (habitat.action, habitat.senses_size) == (Continuous(2), 2)
    past = lived(habitat, np.full((4, 2), 0.75, np.float32))
    ticks = np.arange(10, dtype=np.float32)[:, None, None]
    np.testing.assert_allclose(past.senses, past.senses[0] + 0.75 * ticks, 1e-5)
    far = np.abs(past.senses[1:]).max(axis=2)
    np.testing.assert_array_equal(past.outcome.food, far)
    np.testing.assert_array_equal(past.outcome.fatal, far > 2)
    assert not past.age.any(), "its ticks draw nothing"
    assert not habitat.simulator.changes_state()
    assert Gymnax(env="tests.walks:Overwriting").simulator.changes_state()


def test_ages_are_counted_where_a_tick_draws() -> None:
    assert (lived(walk()).age == np.arange(10)[:, None]).all()
    assert Gymnax(env="tests.walks:Played", sticky=0.5)._draws


def test_what_is_scored_has_the_reward_and_the_time_limit() -> None:
    kept = walk(time_limit=True).model_dump() | {"fatal": "done", "food": "reward"}
    assert walk(fatal="obs[0] > 9", food="2").original().model_dump() == kept


def test_parts_are_named_by_their_places_and_arrays_are_lists_of_numbers() -> None:
    tree = {"a": {"b": 1.5, "c": np.arange(6).reshape(2, 3)}, "d": [True, np.float32(2)]}
    found = parts(tree)
    assert {name: each.tolist() for name, each in found.items()} == {
        "a.b": 1.5, "a.c": [*range(6)], "d.0": True, "d.1": 2.0,
    }  # fmt: skip
    kinds = {"a.b": "amount", "a.c": 6, "d.0": "condition", "d.1": "amount"}
    assert kind({"state": found}) == {"state": kinds}


def test_equal_settings_share_compiled_code() -> None:
    assert hash(walk(params={"energy": 4})) == hash(walk(params={"energy": 4}))
    assert walk(params={"energy": 4}) != walk(params={"energy": 5})


def test_a_picture_is_drawn_of_what_is_sensed() -> None:
    habitat = walk()
    assert habitat.can(Ability.PICTURE)
    body = jax.tree.map(lambda leaf: leaf[0], lived(habitat).born)
    assert len(habitat.picture(body, STILL[0]).getcolors()) > 2


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"env": "tests.walks:Mute"}, "a brain needs two or more choices"),
    ({"env": "tests.walks:Growing"}, "the state has one form"),
    (
        {"env": "tests.walks:Nothing"},
        "has no default_params, reset_env, step_env, action_space, which",
    ),
    ({"env": "tests.walks:Missing"}, "cannot be made"),
    ({"env": "tests.walks:Walk", "params": {"gust": 1.0}}, "did you mean 'gusts'"),
    (
        {"env": "tests.walks:Walk", "params": {"gusts": "strong"}},
        "type and shape of its default, 0.5",
    ),
    ({"env": "tests.walks:Walk", "rate": 0.0}, "habitat.rate"),
    ({"env": "tests.walks:Walk", "sight": 2}, "sight: needs centre"),
    ({"env": "tests.walks:Walk", "centre": 0}, "centre: the observations are no grid"),
    ({"env": "tests.walks:Walk", "fatal": "state"}, "'state' has parts"),
    ({"env": "tests.walks:Walk", "fatal": "obs[3] > 0"}, "obs goes from obs[0] to obs[2]"),
    ({"env": "tests.walks:Walk", "food": "lives"}, "known: done, info, obs, reward, state"),
]


@pytest.mark.parametrize(("table", "says"), WRONG)
def test_what_cannot_be_lived_in_is_refused_in_one_line(table: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError) as refused:
        validated({"task": "T", "habitat": {"name": "gymnax", **table}}, source="test")
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


def test_the_module_of_an_environment_is_code_of_the_run() -> None:
    table = {"name": "gymnax", "env": "tests.walks:Walk"}
    config = validated({"task": "T", "habitat": table}, source="test")
    assert "tests.walks" in config.own_modules


def test_a_library_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "octax.environments", None)
    with pytest.raises(ValueError, match=r"pip install 'primordia\[octax\]'"):
        Gymnax(env="octax:never")


def test_it_is_known_whether_a_function_uses_its_first_argument() -> None:
    assert uses_first(lambda a, b: (a + b, b), 1.0, 2.0)
    assert uses_first(lambda a, b: (b, a), 1.0, 2.0)
    assert not uses_first(lambda a, b: b + 1, 1.0, 2.0)


def test_a_sticky_choice_is_that_of_the_tick_before_with_its_probability() -> None:
    """Rooms are senses of which one is one."""
    habitat = Gymnax(env="tests.walks:Choice", sticky=0.25)
    assert (habitat.action, habitat.senses_size) == (Discrete(3), 4)
    chosen = np.tile(1 + np.arange(400, dtype=np.int32)[:, None] % 2, 4)
    past = jax.tree.map(np.asarray, shared(all_of, habitat)(WORDS, chosen))
    np.testing.assert_array_equal(past.senses[:, 0], np.eye(4)[past.state["energy"][:, 0] % 4])
    place = past.state["place"][..., 0]
    made = np.round((place[1:] - place[:-1] * 0.9) / 0.5).astype(int)
    assert ((made == chosen) | (made == past.held[:-1])).all()
    # An action that alternates differs from the one made in a fifth of the ticks.
    differs = (made != chosen).mean(axis=0)
    np.testing.assert_allclose(differs, 0.2, atol=0.06)
    assert len(np.unique(differs)) > 1
