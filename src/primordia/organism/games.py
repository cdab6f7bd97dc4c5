"""Games: organisms play many times over, side by side, with no neighbours and no children."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from itertools import chain
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np

from primordia.compiled import shared
from primordia.habitats.contract import AnyHabitat, HostHabitat, Outcome
from primordia.habitats.on_host import OnHost
from primordia.law.genesis import body_words
from primordia.law.law import Law
from primordia.law.life import Vitals, judge
from primordia.law.metabolism import Rates, to_fixed_point
from primordia.organism.life.instant import Mind, think
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide

AT_ONCE = 128
"""games side by side; a player's own are never parted"""
MIX = np.uint64(0x9E3779B97F4A7C15)
"""an odd number, for courses"""


class Players(NamedTuple):
    """Who play, K of them, and what their games are a function of."""

    law: Law
    habitat: AnyHabitat
    genomes: np.ndarray
    """float32 (K, P)"""
    keys: Wide
    """(K,), of everything random in each one's games"""
    rates: Rates
    """of each one's metabolism, float32 (K,) each"""

    @property
    def deterministic(self) -> bool:
        """Whether all games of one are the same."""
        return self.habitat.words == 0 and self.law.motor.kind == "direct"

    def take(self, which: slice | np.ndarray) -> "Players":
        """Those at an index."""
        rates = Rates(*(rate[which] for rate in self.rates))
        return self._replace(genomes=self.genomes[which], keys=self.keys.take(which), rates=rates)


class Games(NamedTuple):
    """What became of E games of each of K players, (K, E) each; or of one player, (E,)."""

    ticks: np.ndarray
    """int64: until it was over, or cut"""
    over: np.ndarray
    """bool: it was not cut"""
    food: np.ndarray
    """float64: gathered"""
    course: np.ndarray
    """uint64: differs where what was perceived or gathered in some tick did"""
    actions: list[np.ndarray]
    """each one's in its first game, int32 (T,) or float32 (T, A)"""

    def of(self, player: int) -> "Games":
        """One player's."""
        *each, actions = self
        return Games._make([*(found[player] for found in each), [actions[player]]])

    def done(self, tick: int) -> np.ndarray:
        """What each did in this tick of its first game, over and over: (K,) or (K, A)."""
        return np.stack([each[(tick - 1) % len(each)] for each in self.actions])


def play(
    players: Players,
    games: int,
    ticks: int,
    *,
    frozen: bool = False,
    script: Games | None = None,
) -> Games:
    """Let each play so many games, until all are over or for so many ticks.

    Args:
        players: who.
        games: how many each.
        ticks: when a game is cut.
        frozen: senses stay as they are at the start.
        script: games of the same players, whose actions they take, over and over, whatever is perceived.
    """
    size, parts = max(AT_ONCE // games, 1), []
    for first in range(0, len(players.genomes), size):
        some = slice(first, first + size)
        done = script and script._replace(actions=script.actions[some])
        parts.append(_side_by_side(players.take(some), games, ticks, frozen, done))
    *each, actions = zip(*parts, strict=True)
    return Games._make([*map(np.concatenate, each), list(chain.from_iterable(actions))])


def _side_by_side(
    players: Players, games: int, ticks: int, frozen: bool, script: Games | None
) -> Games:
    """All at once; a player's games are next to each other."""
    tries, count = _Tries(players, games), len(players.genomes) * games
    playing, course = np.ones(count, bool), np.zeros(count, np.uint64)
    length, food, actions = np.zeros(count, np.int64), np.zeros(count), []
    with _opened(players.habitat, count) as table:
        senses = first = np.array(table.reset(np.arange(count), tries.words()))
        for tick in range(1, ticks + 1):
            if script is None:
                action = tries.think(first if frozen else senses, tick)
            else:
                action = np.repeat(script.done(tick), games, axis=0)
            actions.append(action[::games].copy())
            senses, outcome = table.step(action, playing)
            dies = tries.judge(outcome, senses)
            length += playing
            if outcome.food is not None:
                food += np.where(playing, outcome.food, 0)
            course = np.where(playing, _stirred(course, senses, food), course)
            playing = playing & ~dies
            if not playing.any():
                break
    each = [found.reshape(-1, games) for found in (length, ~playing, food, course)]
    taken = zip(np.stack(actions, axis=1), length[::games], strict=True)
    return Games._make([*each, [own[:ticks] for own, ticks in taken]])


def _stirred(course: np.ndarray, senses: np.ndarray, food: np.ndarray) -> np.ndarray:
    """What tells the course of a game from others, one tick on."""
    place = np.arange(1, senses.shape[1] + 1, dtype=np.uint64) * MIX
    words = np.ascontiguousarray(senses, np.float32).view(np.uint32).astype(np.uint64)
    return (course * MIX ^ food.view(np.uint64)) * MIX + words @ place


class _Tries:
    """Brains and stores, one for each game."""

    def __init__(self, players: Players, games: int) -> None:
        law, self._words = players.law, players.habitat.words
        each = partial(jnp.repeat, repeats=games, axis=0)
        cells = jnp.asarray(np.tile(np.arange(games), len(players.genomes)), jnp.int32)
        genome = law.layout.split(each(jnp.asarray(players.genomes)))
        self._mind = Mind(genome, players.keys.map(each), cells)
        self._memory = jnp.zeros((len(cells), law.memory), jnp.float32)
        self._rates = Rates(*map(each, players.rates))
        self._vitals = Vitals(to_fixed_point(self._rates.store), jnp.zeros(len(cells), jnp.int32))
        self._faulty = jnp.zeros(len(cells), bool)
        self._think, self._judge = shared(think, law), shared(judge, law)

    def words(self) -> np.ndarray:
        """Return what the games are begun with, uint32 (K E, words)."""
        key = stream(self._mind.key, Purpose.BODY, wide([0]))
        return np.asarray(body_words(key, self._mind.cell, self._words))

    def think(self, senses: np.ndarray, tick: int) -> np.ndarray:
        """Return the actions for senses (K E, S), int32 (K E,) or float32 (K E, A)."""
        thought = self._think(self._mind, self._memory, senses, wide([tick]))
        self._memory, self._faulty = thought.memory, thought.faulty
        return np.asarray(thought.action)

    def judge(self, outcome: Outcome, senses: np.ndarray) -> np.ndarray:
        """Return which organisms have died at the end of a tick, bool (K E,)."""
        self._vitals, cause = self._judge(self._vitals, self._faulty, senses, outcome, self._rates)
        return np.asarray(cause) >= 0


@contextmanager
def _opened(habitat: AnyHabitat, games: int) -> Iterator[HostHabitat]:
    """A habitat to be stepped on the host, with room for that many bodies."""
    table = habitat if habitat.kind == "host" else OnHost(habitat)
    table.open(games)
    try:
        yield table
    finally:
        table.close()
