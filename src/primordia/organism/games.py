"""Games: one organism plays many times over, side by side, with no neighbours and no children."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from primordia.habitats import Habitat, HostHabitat, Outcome
from primordia.keys import Purpose, stream
from primordia.law import Law
from primordia.law.brain import split
from primordia.law.genesis import body_words
from primordia.law.metabolism import Rates, fixed, metabolise
from primordia.organism.life.instant import Mind, think
from primordia.wide import Wide, wide

MIX = np.uint64(0x9E3779B97F4A7C15)
"""an odd number, for courses"""


class Player(NamedTuple):
    """Who plays, and what its tries are a function of."""

    law: Law
    habitat: Habitat | HostHabitat
    genome: np.ndarray
    """float32 (P,), or (E, P) if somebody else plays each game"""
    key: Wide
    """(1,), of everything random"""
    rates: Rates
    """of its metabolism, float32 (1,) each"""

    @property
    def deterministic(self) -> bool:
        """Whether all its games are the same."""
        return self.habitat.words == 0 and self.law.motor.kind == "direct"


class Games(NamedTuple):
    """What became of them, (E,) each."""

    ticks: np.ndarray
    """int64: until it was over, or cut"""
    over: np.ndarray
    """bool: it was not cut"""
    food: np.ndarray
    """float64: gathered"""
    course: np.ndarray
    """uint64: differs where what was perceived or gathered in some tick did"""
    actions: list[np.ndarray]
    """of the first game, tick by tick"""


def play(
    player: Player,
    games: int,
    ticks: int,
    *,
    frozen: bool = False,
    script: list[np.ndarray] | None = None,
) -> Games:
    """Play until all games are over, or for so many ticks.

    Args:
        player: who.
        games: how many.
        ticks: when a game is cut.
        frozen: senses stay as they are at the start.
        script: actions to take, over and over, whatever is perceived.
    """
    tries, playing = _Tries(player, games), np.ones(games, bool)
    length, food = np.zeros(games, np.int64), np.zeros(games)
    course, actions = np.zeros(games, np.uint64), []
    with _opened(player.habitat, games) as table:
        senses = first = np.array(table.reset(np.arange(games), tries.words()))
        for tick in range(1, ticks + 1):
            action = tries.think(first if frozen else senses, tick)
            if script is not None:
                action = np.broadcast_to(script[(tick - 1) % len(script)], action.shape)
            actions.append(np.array(action[0]))
            senses, outcome = table.step(action, playing)
            dies = tries.judge(outcome, senses)
            length += playing
            if outcome.food is not None:
                food += np.where(playing, outcome.food, 0)
            course = np.where(playing, _stirred(course, senses, food), course)
            playing = playing & ~dies
            if not playing.any():
                break
    return Games(length, ~playing, food, course, actions)


def _stirred(course: np.ndarray, senses: np.ndarray, food: np.ndarray) -> np.ndarray:
    """What tells the course of a game from others, one tick on."""
    place = np.arange(1, senses.shape[1] + 1, dtype=np.uint64) * MIX
    words = np.ascontiguousarray(senses, np.float32).view(np.uint32).astype(np.uint64)
    return (course * MIX ^ food.view(np.uint64)) * MIX + words @ place


class _Tries:
    """The organism's brain and its energy, once a game."""

    def __init__(self, player: Player, games: int) -> None:
        law, self._player = player.law, player
        self._cells = jnp.arange(games, dtype=jnp.int32)
        genome = split(law.brain, jnp.asarray(_one_a_game(player.genome, games)))
        self._mind = Mind(genome, player.key, self._cells)
        self._memory = jnp.zeros((games, law.brain.memory), jnp.float32)
        self._energy = jnp.broadcast_to(fixed(jnp.asarray(player.rates.store)), (games,))
        self._think, self._eat = jax.jit(partial(think, law)), jax.jit(metabolise)

    def words(self) -> np.ndarray:
        """What the games are begun with, uint32 (E, words)."""
        key = stream(self._player.key, Purpose.BODY, wide([0]))
        return np.asarray(body_words(key, self._cells, self._player.habitat.words))

    def think(self, senses: np.ndarray, tick: int) -> np.ndarray:
        """Senses (E, S) -> actions, int32 (E,) or float32 (E, A)."""
        self._memory, action = self._think(self._mind, self._memory, senses, wide([tick]))
        return np.asarray(action)

    def judge(self, outcome: Outcome, senses: np.ndarray) -> np.ndarray:
        """Who is dead after a tick, bool (E,)."""
        dies = np.asarray(outcome.fatal) | ~np.isfinite(senses).all(axis=1)
        if outcome.fault is not None:
            dies = dies | np.asarray(outcome.fault)
        if self._player.law.metabolism is None:
            return dies
        rates = self._player.rates
        self._energy = self._eat(self._energy, outcome.food, outcome.effort, rates)
        return dies | (np.asarray(self._energy) <= 0)


def _one_a_game(genome: np.ndarray, games: int) -> np.ndarray:
    return np.broadcast_to(genome, (games, genome.shape[-1]))


@contextmanager
def _opened(habitat: Any, games: int) -> Iterator[Any]:
    """A habitat to be stepped on the host, with room for so many bodies."""
    table = habitat if hasattr(habitat, "open") else _OnHost(habitat)
    table.open(games)
    try:
        yield table
    finally:
        if hasattr(table, "close"):
            table.close()


class _OnHost:
    """A habitat in JAX, stepped as those on the host are."""

    def __init__(self, inner: Habitat) -> None:
        self._reset, self._sense = inner.reset, jax.jit(inner.sense)
        self._step = jax.jit(inner.step)

    def open(self, cells: int) -> None:
        """Bodies are made as they are needed."""

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        """All are born at once."""
        self._bodies = self._reset(jnp.asarray(words))
        return np.asarray(self._sense(self._bodies))

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """All are stepped, whoever is alive."""
        self._bodies, outcome = self._step(self._bodies, jnp.asarray(action))
        return np.asarray(self._sense(self._bodies)), outcome
