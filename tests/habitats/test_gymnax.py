"""Environments in JAX: lives from words and age, senses, actions, death, food, and errors."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import lax

from primordia.config import validated
from primordia.errors import InputError
from primordia.habitats.contract import Ability, Continuous, Discrete
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.habitats.gymnax.quantities import kind, parts
from primordia.jaxprs import uses_first
from primordia.testing import check_habitat

WORDS = np.arange(8, dtype=np.uint32).reshape(4, 2)
STILL = np.zeros((4, 2), np.float32)


def walk(**settings: Any) -> Gymnax:
    return Gymnax(env="tests.walks:Walk", **settings)


def state_of(habitat: Gymnax, bodies: Any) -> Any:
    """Return the states of bodies as the environment has them."""
    template = habitat.simulator.example.state
    return jax.vmap(lambda packed: packed.state(habitat.senses_size, template))(bodies.packed)


def lived(habitat: Gymnax, ticks: int, action: Any = STILL) -> tuple[Any, list[Any]]:
    """Return the bodies after some ticks, and the outcome of each tick."""
    bodies, outcomes = habitat.reset(WORDS), []
    for _ in range(ticks):
        bodies, outcome = habitat.step(bodies, action)
        outcomes.append(outcome)
    return bodies, outcomes


@pytest.mark.slow
@pytest.mark.parametrize("name", ["Walk", "Choice", "Turning"])
def test_an_environment_of_ones_own_keeps_the_contract(name: str) -> None:
    check_habitat(Gymnax(env=f"tests.walks:{name}", food="reward", squash=True))


def test_the_key_of_a_tick_is_that_of_the_birth_folded_with_the_age() -> None:
    bodies, _ = lived(walk(), 3)
    with jax.threefry_partitionable(True):
        folded = jax.vmap(lambda key: jax.random.uniform(jax.random.fold_in(key, 3)))
        drawn = jax.jit(folded)(jax.random.wrap_key_data(WORDS, impl="threefry2x32"))
    np.testing.assert_array_equal(state_of(walk(), bodies)["gust"], drawn)


def test_the_environments_time_limit_ends_a_life_only_if_it_is_kept() -> None:
    def ends(**settings: Any) -> list[bool]:
        return [bool(outcome.fatal.all()) for outcome in lived(walk(**settings), 9)[1]]

    assert ends() == [False] * 8 + [True]
    assert ends(time_limit=True) == [False] * 4 + [True] * 5
    assert ends(params={"energy": 3}, time_limit=True).index(True) == 2


def test_without_a_condition_no_life_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """The test gives the values of a tick: two of four walks are done."""
    done = [True, False, False, True]
    values = {"done": jnp.array(done)}
    monkeypatch.setattr(Gymnax, "tick", lambda self, bodies, action: (bodies, values))
    for fatal, ends in (
        ("", [False] * 4),
        ("done", done),
        ("not done", [False, True, True, False]),
    ):
        assert walk(fatal=fatal).step(None, STILL)[1].fatal.tolist() == ends


def test_death_and_food_can_speak_of_all_that_the_environment_says() -> None:
    _, outcomes = lived(walk(fatal='state["energy"] < 7 or obs[2] > 8.5'), 4)
    assert [bool(each.fatal[0]) for each in outcomes] == [False, False, True, True]
    _, outcomes = lived(walk(fatal='state["tired"] and not done', food='sum(info["crossed"])'), 8)
    assert [bool(each.fatal[0]) for each in outcomes] == [False] * 6 + [True, True]
    crossed = (np.asarray(state_of(walk(), lived(walk(), 1)[0])["place"]) > 0).sum(axis=1)
    np.testing.assert_array_equal(outcomes[0].food, crossed.astype(np.float32))


def test_food_may_use_functions_and_is_not_reported_unless_asked_for() -> None:
    bodies, (outcome,) = lived(walk(food="max(reward - 0.2, 0) + min(abs(obs[0]), 1)"), 1)
    place = np.abs(np.asarray(state_of(walk(), bodies)["place"])[:, 0])
    np.testing.assert_allclose(
        outcome.food, np.maximum(place - 0.2, 0) + np.minimum(place, 1), 1e-6
    )
    assert lived(walk(), 1)[1][0].food is None


def test_outputs_within_one_fill_the_bounds_of_actions() -> None:
    def moved(output: float) -> np.ndarray:
        habitat = walk(params={"gusts": 1.0})
        born = np.asarray(state_of(habitat, habitat.reset(WORDS))["place"])
        bodies, _ = lived(habitat, 1, np.full((4, 2), output, np.float32))
        return np.asarray(state_of(habitat, bodies)["place"]) - np.float32(0.9) * born

    for output, action in [(-1, -2), (0, 1), (1, 4), (7, 4), (-7, -2)]:
        np.testing.assert_allclose(moved(output), action, atol=1e-6)
    assert walk().action == Continuous(2)


def test_senses_are_scaled_where_their_space_has_bounds() -> None:
    habitat = walk()
    bodies, _ = lived(habitat, 3, np.ones((4, 2), np.float32))
    place = np.asarray(state_of(habitat, bodies)["place"])
    np.testing.assert_array_equal(habitat.sense(bodies)[:, :2], place)
    np.testing.assert_allclose(habitat.sense(bodies)[:, 2], (6 - 4.5) / 4.5, 1e-6)
    squashing = walk(squash=True)
    squashed = squashing.sense(lived(squashing, 3, np.ones((4, 2), np.float32))[0])
    np.testing.assert_allclose(squashed[:, 0], place[:, 0] / (1 + np.abs(place[:, 0])), 1e-6)
    np.testing.assert_array_equal(squashed[:, 1], place[:, 1])


def test_a_choice_is_an_action_and_rooms_are_senses_of_which_one_is_one() -> None:
    habitat = Gymnax(env="tests.walks:Choice")
    assert (habitat.action, habitat.senses_size) == (Discrete(3), 4)
    bodies, _ = lived(habitat, 2, np.zeros(4, np.int32))
    np.testing.assert_array_equal(habitat.sense(bodies)[0], np.eye(4)[7 % 4])


def test_an_environment_like_playgrounds_is_perceived_as_by_a_policy_and_ends_when_done() -> None:
    habitat = Gymnax(env="tests.walks:Played", food='info["far"]', fatal="done")
    assert (habitat.action, habitat.senses_size) == (Continuous(2), 2)
    bodies, outcomes = lived(habitat, 4, np.full((4, 2), 0.75, np.float32))
    born = np.asarray(habitat.sense(habitat.reset(WORDS)))
    np.testing.assert_allclose(habitat.sense(bodies), born + 3, 1e-5)
    for tick, outcome in enumerate(outcomes, start=1):
        far = np.abs(born + 0.75 * tick).max(axis=1)
        np.testing.assert_allclose(outcome.food, far, 1e-5)
        np.testing.assert_array_equal(outcome.fatal, far > 2)
    assert not habitat.simulator.changes_state()
    assert Gymnax(env="tests.walks:Overwriting").simulator.changes_state()


def test_what_is_scored_has_the_reward_and_the_time_limit() -> None:
    original = walk(fatal="obs[0] > 9", food="2").original()
    _, outcomes = lived(original, 5)
    assert outcomes[4].fatal.all()
    assert (outcomes[0].food > 0).all()


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
    body = jax.tree.map(lambda leaf: np.asarray(leaf)[0], habitat.reset(WORDS))
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


def test_ages_are_counted_only_where_a_tick_draws() -> None:
    assert (np.asarray(lived(walk(), 3)[0].age.lo) == 3).all()
    assert not np.asarray(lived(Gymnax(env="tests.walks:Played"), 3)[0].age.lo).any()
    assert (np.asarray(lived(Gymnax(env="tests.walks:Played", sticky=0.5), 3)[0].age.lo) == 3).all()


def test_a_sticky_action_is_that_of_the_tick_before_with_its_probability() -> None:
    habitat, ticks = Gymnax(env="tests.walks:Choice", sticky=0.25), 400
    chosen = np.tile(1 + np.arange(ticks, dtype=np.int32)[:, None] % 2, 4)

    def tick(bodies: Any, action: Any) -> tuple[Any, Any]:
        after, _ = habitat.step(bodies, action)
        before, now = (state_of(habitat, each)["place"][:, 0] for each in (bodies, after))
        return after, (now - before * 0.9, bodies.held)

    moved, held = jax.jit(lambda words: lax.scan(tick, habitat.reset(words), chosen)[1])(WORDS)
    made = np.round(np.asarray(moved) / 0.5).astype(int)
    assert ((made == chosen) | (made == held)).all()
    # An action that alternates differs from the one made in a fifth of the ticks.
    differs = (made != chosen).mean(axis=0)
    np.testing.assert_allclose(differs, 0.2, atol=0.06)
    assert len(np.unique(differs)) > 1
