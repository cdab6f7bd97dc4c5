"""The Seaquest of the examples is MinAtar's, tick by tick."""

from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from examples import seaquest
from examples import seaquest_rules as rules
from examples.seaquest_rules import ABOARD, SIDE, Draws, State

from primordia.config import load

Env: Any = pytest.importorskip("minatar.environments.seaquest").Env
ROOT = Path(__file__).parent.parent
CHANNELS = {"back": 1, "shot": 2, "trail": 3, "bullet": 4, "fish": 5, "submarine": 6, "diver": 9}
"""MinAtar's numbers of the channels of `cells`"""
OXYGEN, ON_BOARD = 7, 8


class Dealt:
    """Numbers for MinAtar that stand for known draws."""

    def __init__(self, game: Env, drawn: Draws) -> None:
        low = {True: 0.0, False: 0.9}
        enemy = [low[drawn.enemy_right], low[drawn.enemy_armed], drawn.enemy_row]
        diver = [low[drawn.diver_right], drawn.diver_row]
        self.left = enemy * (game.e_spawn_timer == 0) + diver * (game.d_spawn_timer == 0)

    def rand(self) -> float:
        return self.left.pop(0)

    def randint(self, low: int, high: int) -> int:
        assert (low, high) == (1, 9)
        return self.left.pop(0)


@jax.jit
def ticked(state: State, action: Any, drawn: Draws) -> Any:
    """Return the next state, points, whether the game is over, and what MinAtar would show."""
    state, points, over = rules.tick(state, action, drawn)
    every = jnp.arange(SIDE)
    oxygen, divers = seaquest.gauges(state)
    screen = jnp.zeros((SIDE, SIDE, 10), bool).at[state.y, state.x, 0].set(True)
    screen = screen.at[:, :, tuple(CHANNELS.values())].set(
        seaquest.cells(state, every, every)[:, :, 1:]
    )
    screen = screen.at[-1, :, OXYGEN].set(oxygen).at[-1, 3 : 3 + ABOARD, ON_BOARD].set(divers[::-1])
    return state, points, over, screen


def drawn_by(chance: np.random.Generator) -> Draws:
    """Return draws of one tick."""
    right, armed, diver_right = chance.random(3) < 0.5
    row, diver_row = chance.integers(1, 9, 2).tolist()
    return Draws(bool(right), bool(armed), row, bool(diver_right), diver_row)


@pytest.mark.parametrize(("ramped", "least", "crowd"), [(False, 10, 3), (True, 80, 20)])
def test_games_are_those_of_minatar(ramped: bool, least: int, crowd: int) -> None:
    """A player that survives everything plays at random, in an empty sea or in the most crowded one."""
    chance, game, state = np.random.default_rng(ramped), Env(), rules.first()
    if ramped:
        game.e_spawn_speed, game.move_speed, game.ramp_index, game.diver_count = 1, 2, 25, ABOARD
        level = {"spawn": 1, "move": 2, "ramp": 25, "aboard": ABOARD}
        state = state._replace(**{name: jnp.int32(number) for name, number in level.items()})
    score, deaths, most = 0, 0, 0
    for _ in range(1_500):
        action, drawn = int(chance.integers(6)), drawn_by(chance)
        game.random = Dealt(game, drawn)
        points, over = game.act(action)
        assert not game.random.left
        state, mine, mine_over, screen = ticked(state, action, drawn)
        assert (mine, mine_over) == (points, over)
        np.testing.assert_array_equal(screen, game.state())
        numbers = (game.e_spawn_speed, game.move_speed, game.ramp_index, game.diver_count)
        assert (state.spawn, state.move, state.ramp, state.aboard) == numbers
        score, deaths = score + points, deaths + over
        most = max(most, len(game.e_fish + game.e_subs))
        game.terminal = False
    assert score >= least
    assert deaths >= least
    assert most >= crowd
    assert game.ramp_index > 5


def test_draws_are_those_of_minatar() -> None:
    """Half of the enemies swim to the right, a third are submarines, and rows are equally frequent."""
    drawn = jax.vmap(rules.draws)(jax.random.split(jax.random.key(0), 20_000))
    for flags, share in (
        (drawn.enemy_right, 1 / 2),
        (drawn.enemy_armed, 1 / 3),
        (drawn.diver_right, 1 / 2),
    ):
        assert abs(flags.mean() - share) < 0.02
    for rows in (drawn.enemy_row, drawn.diver_row):
        assert np.unique(rows).tolist() == list(range(1, 9))
        assert np.abs(np.bincount(rows)[1:] / len(rows) - 1 / 8).max() < 0.02


def test_a_player_perceives_the_cells_around_it_and_the_gauges() -> None:
    """It is at the right side of the screen, with a fish above its back, and a diver below it."""
    state = rules.first()
    fish = state.enemies._replace(there=np.arange(40) == 7, x=np.full(40, 8), y=np.full(40, 2))
    diver = state.divers._replace(there=np.arange(3) == 2, x=np.full(3, 9), y=np.full(3, 4))
    state = state._replace(enemies=fish, divers=diver, right=jnp.bool_(True))
    numbers = {"x": 9, "y": 3, "oxygen": 39, "aboard": 2}
    state = state._replace(**{name: jnp.int32(number) for name, number in numbers.items()})
    senses = np.asarray(seaquest.senses(state))
    near, gauges = senses[: 9 * 8].reshape(3, 3, 8), senses[9 * 8 :]
    beyond = [[row, 2, 0] for row in range(3)]
    back, fish_above, its_trail, diver_below = [1, 0, 1], [0, 0, 5], [0, 1, 3], [2, 1, 7]
    assert sorted(np.argwhere(near).tolist()) == sorted(
        [*beyond, back, fish_above, its_trail, diver_below]
    )
    assert gauges.tolist() == [True] + [False] * 9 + [True] * 2 + [False] * 4


def test_players_of_the_example_feed_under_water_only() -> None:
    """One player stays at the surface, and another one dives; the picture shows both gauges."""
    habitat: Any = load(ROOT / "examples" / "seaquest.toml").build_habitat()
    bodies = habitat.reset(np.array([[1, 2], [3, 4]], np.uint32))
    bodies, outcome = jax.jit(habitat.step)(bodies, jnp.array([0, rules.DOWN]))
    assert outcome.food.tolist() == [0, 1]
    assert not outcome.fatal.any()
    pixels = seaquest.Seaquest().picture(rules.first()._replace(aboard=jnp.int32(1)), None)
    assert pixels.shape == (400, 400, 3)
    assert pixels[-1, [0, 330]].tolist() == [[*seaquest.TANK], [*seaquest.DIVER]]
