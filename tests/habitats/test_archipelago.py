"""Habitats made of habitats: what islands share, what each does, and which do not fit together."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.compiled import shared
from primordia.config import load
from primordia.errors import InputError
from primordia.habitats.archipelago import Parts, archipelago, at, joined, split
from primordia.habitats.bodies import not_finite, select_bodies
from primordia.habitats.cartpole.habitat import CartPole
from primordia.habitats.contract import Continuous, Discrete, HostHabitat, JaxHabitat, Outcome
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.habitats.scaled import scaled
from primordia.runs.digest import digests
from primordia.runs.fork import _form
from primordia.settings.islands import Islands
from tests.habitats.test_parameters import ACTIONS, BODIES, WORDS, HeldPoles
from tests.toys import Clocked, Mill, Mirror, Watch

SHORE = Islands(("west", "east"), (0, 2, 5))
"""Cells 0 and 1, and cells 2 to 4."""
METHODS = "reset", "step", "sense"


class Keys(JaxHabitat):
    """Bodies that remember which choice their organism made last."""

    senses_size: int
    action: Any
    buttons: tuple[str, ...] | None
    words = 1

    def __init__(self, senses: int, *buttons: str, count: int = 0) -> None:
        self.senses_size, self.buttons = senses, buttons or None
        self.action = Discrete(len(buttons) or count)

    def reset(self, words: Array) -> Array:
        return jnp.full(len(words), -1, jnp.int32)

    def sense(self, bodies: Array) -> Array:
        return jnp.ones((len(bodies), self.senses_size), jnp.float32) * bodies[:, None]

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        if self.senses_size == 1:
            return action, Outcome(action == 0)
        twice, half = action * jnp.float32(2), jnp.full(action.shape, 0.5, jnp.float32)
        return action, Outcome(action == 0, twice, capacity=half)


def test_a_button_is_one_choice_on_all_islands_and_nothing_where_it_is_missing() -> None:
    """The choices are left, noop, right and jump; on the second island jump, left and noop."""
    both: Any = archipelago(
        [Keys(1, "left", "noop", "right"), Keys(3, "jump", "left", "noop")], SHORE
    )
    assert (both.buttons, both.action) == (("left", "noop", "right", "jump"), Discrete(4))
    assert (both.senses_size, both.words) == (3, 1)
    bodies, step = both.reset(np.zeros((5, 1), np.uint32)), jax.jit(both.step)
    sense = jax.jit(both.sense)
    west, east = [0, 1, 2, 1], [1, 2, 2, 0]
    for button in range(4):
        after, outcome = step(bodies, np.full(5, button, np.int32))
        assert [each.tolist() for each in after.island] == [[west[button]] * 2, [east[button]] * 3]
        own = [west[button]] * 2 + [east[button]] * 3
        assert outcome.fatal.tolist() == [each == 0 for each in own]
        assert outcome.food.tolist() == [0.0] * 2 + [2.0 * east[button]] * 3
        assert outcome.capacity.tolist() == [1.0] * 2 + [0.5] * 3
        senses = np.asarray(sense(after))
        assert senses[:2, 1:].sum() == 0, "the senses that an island lacks are 0"
        assert senses[:, 0].tolist() == own
    assert at(both, 1) is both.habitats[0]
    assert at(both, 2) is both.habitats[1]


def test_parts_are_selected_checked_split_and_joined_island_by_island() -> None:
    """Two worlds of five cells; rows are counted world by world."""
    rows = np.arange(10.0)
    west, east = split(rows, SHORE.sizes)
    assert (west.tolist(), east.tolist()) == ([0, 1, 5, 6], [2, 3, 4, 7, 8, 9])
    assert joined([west, east], SHORE.sizes).tolist() == rows.tolist()
    old = Parts((west, east), SHORE.sizes)
    new = Parts((west + 100, np.where(east == 8, np.nan, east + 100)), SHORE.sizes)
    mask = np.array([True, False] * 5)
    chosen = joined(jax.jit(select_bodies)(mask, new, old).island, SHORE.sizes)
    expected = np.where(mask, np.r_[100.0:108.0, np.nan, 109.0], np.arange(10.0))
    np.testing.assert_array_equal(chosen, expected)
    failed = jax.jit(not_finite)
    assert np.flatnonzero(failed(new)).tolist() == [8]
    assert failed(old).tolist() == [False] * 10


def test_bodies_on_islands_on_the_host_are_those_in_jax() -> None:
    """In two worlds: also after a birth in some cells, and after they are saved and loaded."""
    in_jax: Any = archipelago([Mill(), Watch()], SHORE)
    held: Any = archipelago([Mirror("mill"), Mirror("watch")], SHORE)
    rng, cells = np.random.default_rng(6), np.arange(10)
    words = rng.integers(0, 2**32, (10, in_jax.words), np.uint32)
    held.open(10)
    held.reset(cells, words[::-1])
    born = np.array([8, 1, 5, 0])
    senses = held.reset(born, words[born])
    reset, step, sense = (shared(getattr(type(in_jax), name), in_jax) for name in METHODS)
    bodies = reset(words)
    np.testing.assert_array_equal(senses, np.asarray(sense(bodies))[born])
    held.reset(cells, words)
    for tick in range(4):
        action = rng.normal(size=(10, in_jax.action.size)).astype(np.float32)
        bodies, expected = step(bodies, action)
        senses, outcome = held.step(action, np.ones(10, bool))
        np.testing.assert_array_equal(senses, sense(bodies))
        for name in ("fatal", "food", "effort"):
            np.testing.assert_array_equal(getattr(outcome, name), getattr(expected, name))
        if tick == 1:
            saved = {name: each.copy() for name, each in held.save().items()}
            held.reset(cells, words)
            held.load(saved)
    assert len(np.unique(senses[:, 0])) == 5


def test_counts_of_islands_have_columns_of_their_own() -> None:
    class Twice(Clocked):
        counted = "ticks_down", "rounds"

    host: Any = archipelago([Clocked("meadow"), Twice("meadow")], SHORE)
    assert host.tallies == ("ticks", "ticks_down", "rounds")
    host.open(10)
    host.reset(np.arange(10), np.zeros((10, host.words), np.uint32))
    alive = np.arange(10) != 3
    for _ in range(4):
        senses, outcome = host.step(np.zeros(10, np.int32), alive)
    assert senses.shape == (10, 2)
    assert len(outcome.fatal) == 10
    first = np.isin(np.arange(10) % 5, [0, 1])
    ticks = np.where(alive, 4, 0)
    expected = [
        np.where(first, ticks, 0),
        np.where(first, -ticks, ticks),
        np.where(first, 0, -ticks),
    ]
    np.testing.assert_array_equal(host.tally(), np.stack(expected, axis=1))
    saved: Any = host.save()
    other: Any = archipelago([Clocked("meadow"), Twice("meadow")], SHORE)
    other.open(10)
    other.load(saved)
    np.testing.assert_array_equal(other.tally(), host.tally())
    assert {name: len(array) for name, array in saved.items() if name.startswith("island")} == {
        "island.0.mirror": 4, "island.0.tally": 4, "island.1.mirror": 6, "island.1.tally": 6
    }  # fmt: skip
    host.close()


def test_all_islands_begin_a_step_before_one_has_ended_it() -> None:
    """So the worker processes of all islands step at the same time."""
    heard = list[str]()

    class Slow(Mirror):
        def begin(self, action: np.ndarray, alive: np.ndarray) -> Any:
            def end() -> Any:
                heard.append("ends")
                return self.step(action, alive)

            heard.append("begins")
            return end

    host: Any = archipelago([Slow("meadow"), Slow("meadow")], SHORE)
    host.open(10)
    host.reset(np.arange(10), np.zeros((10, host.words), np.uint32))
    host.step(np.zeros(10, np.int32), np.ones(10, bool))
    assert heard == ["begins", "begins", "ends", "ends"]


def test_a_single_island_is_its_own_habitat() -> None:
    only = CartPole()
    assert archipelago([only], Islands(("only",), (0, 5))) is only
    assert at(only, 3) is only


@pytest.mark.parametrize(
    ("one", "other", "message"),
    [
        (Keys(1, "left", "right"), Keys(1, "left", "up"), "west lacks the button 'up'"),
        (Keys(1, count=2), Keys(1, count=3), "west lacks the button '2'"),
        (CartPole(), Mirror(), "west is in JAX, east is on the host"),
    ],
)
def test_islands_that_do_not_fit_together_are_refused(one: Any, other: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        archipelago([one, other], SHORE)


def test_choices_and_amounts_do_not_fit_together() -> None:
    amounts = Keys(1, count=2)
    amounts.action = Continuous(2)
    with pytest.raises(InputError, match="the same kind of actions"):
        archipelago([Keys(1, count=2), amounts], SHORE)


def poles(**settings: Any) -> Any:
    return load("CartPole-survival", {"habitat": settings}).build_habitat()


def test_factors_are_those_of_step_scaled() -> None:
    factors = {"force": 0.5, "pole-length": 3.0}
    light, plain = poles(factors=factors), CartPole()
    row = np.float32([[factors.get(name, 1.0) for name in plain.parameters]] * BODIES)
    bodies = WORDS[:, :4].astype(np.float32) * np.float32(2**-32)
    push = ACTIONS[0]
    mine = shared(type(light).step, light)(bodies, push)[0]
    expected = shared(CartPole.step_scaled, plain)(bodies, push, row)[0]
    np.testing.assert_array_equal(mine, expected)
    usual = shared(CartPole.step_scaled, plain)(bodies, push, np.ones_like(row))[0]
    assert not np.array_equal(mine, usual)
    twice = shared(type(light).step_scaled, light)(bodies, push, row)[0]
    expected = shared(CartPole.step_scaled, plain)(bodies, push, row * row)[0]
    np.testing.assert_array_equal(twice, expected)


def test_factors_on_the_host_hold_from_the_opening_and_for_further_changes() -> None:
    inner = HeldPoles()
    host = scaled(inner, {"gravity": 2.0})
    assert isinstance(host, HostHabitat)
    host.open(4)
    np.testing.assert_array_equal(inner.factors, [[2, 1, 1, 1, 1]] * 4)
    host.set_factors(np.array([1, 3]), np.float32([[3, 1, 1, 1, 5]] * 2))
    np.testing.assert_array_equal(
        inner.factors[[0, 1, 3]], [[2, 1, 1, 1, 1]] + [[6, 1, 1, 1, 5]] * 2
    )


def test_games_name_their_buttons() -> None:
    """Equal names are one button, so they must be those of MinAtar's paper and of the console."""
    breakout = Gymnax(env="Breakout-MinAtar")
    assert breakout.buttons == ("noop", "left", "right")
    assert Gymnax(env="CartPole-v1").buttons is None
    pytest.importorskip("ale_py")
    from primordia.habitats.atari.habitat import Atari

    assert Atari(game="freeway").buttons == ("noop", "up", "down")


def test_empty_cells_of_an_island_do_not_enter_the_digest() -> None:
    """Of two worlds of five cells, cells 1 and 4 of the second are alive."""
    alive = np.zeros(10, bool)
    alive[[6, 9]] = True
    arrays = {
        "world.organisms.alive": alive,
        "bodies.island.0": np.arange(4),
        "bodies.island.1": np.arange(6),
    }
    before = digests({}, arrays, 2, SHORE)
    living = {"bodies.island.0": 3, "bodies.island.1": 5}
    for name, row in living.items():
        for changed in range(len(arrays[name])):
            other = arrays[name].copy()
            other[changed] += 100
            after = digests({}, {**arrays, name: other}, 2, SHORE)
            assert after[0] == before[0]
            assert (after[1] != before[1]) == (changed == row), (name, changed)


def test_saved_states_of_islands_may_have_another_length_in_a_fork() -> None:
    arrays = {"bodies.island.1.states": np.zeros((6, 900)), "bodies.island.1.age": np.zeros((6, 2))}
    assert _form("bodies.island.1.states", arrays) == (6,)
    assert _form("bodies.island.1.age", arrays) == (6, 2)
