"""Games: organisms play side by side, each many times, without neighbours or children."""

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
from primordia.organism.mind import Mind, think
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide

AT_ONCE = 128
"""Games played side by side, if not told otherwise; the games of one player are never separated."""
AT_ONCE_IN_JAX = 1024
"""The same in a habitat of arrays, where each game costs little more memory than a genome."""
MIX = np.uint64(0x9E3779B97F4A7C15)
"""An odd number, which mixes the bits of courses."""


class Players(NamedTuple):
    """K organisms, and all else that their games are a function of."""

    law: Law
    habitat: AnyHabitat
    genomes: np.ndarray
    """float32 (K, P)"""
    keys: Wide
    """(K,), key of everything random in a player's games"""
    rates: Rates
    """metabolism of each player, float32 (K,) each"""

    @property
    def deterministic(self) -> bool:
        """Whether all games of a player are the same."""
        return self.habitat.words == 0 and self.law.motor.kind == "direct"

    def take(self, index: slice | np.ndarray) -> "Players":
        """Return the players at an index."""
        rates = Rates(*(rate[index] for rate in self.rates))
        return self._replace(genomes=self.genomes[index], keys=self.keys.take(index), rates=rates)


class Games(NamedTuple):
    """Results of E games of each of K players, (K, E) each; or of one player, (E,)."""

    ticks: np.ndarray
    """int64: length until the game was over or cut"""
    over: np.ndarray
    """bool: False if the game was cut"""
    food: np.ndarray
    """float64: food gathered"""
    course: np.ndarray
    """uint64: a hash of all senses and food; games that differ in either have different courses"""
    actions: list[np.ndarray]
    """actions of each player in its first game, int32 (T,) or float32 (T, A)"""

    def of_player(self, player: int) -> "Games":
        """Return the games of one player."""
        *arrays, actions = self
        return Games._make([*(array[player] for array in arrays), [actions[player]]])

    def actions_at(self, tick: int) -> np.ndarray:
        """Return the action of each player at a tick of its first game, repeated: (K,) or (K, A)."""
        return np.stack([each[(tick - 1) % len(each)] for each in self.actions])


def play(
    players: Players,
    games: int,
    ticks: int,
    *,
    frozen: bool = False,
    script: Games | None = None,
    at_once: int | None = None,
) -> Games:
    """Let each player play a number of games, until all games are over or cut.

    Args:
        players: the organisms.
        games: number of games of each player.
        ticks: length at which a game is cut.
        frozen: whether senses stay as they are at the start.
        script: earlier games of the same players; their actions are repeated, whatever is perceived.
        at_once: games played side by side.
    """
    size, parts = max((at_once or AT_ONCE) // games, 1), []
    for first in range(0, len(players.genomes), size):
        some = slice(first, first + size)
        part_of_script = script and script._replace(actions=script.actions[some])
        parts.append(_play_at_once(players.take(some), games, ticks, frozen, part_of_script))
    *arrays, actions = zip(*parts, strict=True)
    return Games._make([*map(np.concatenate, arrays), list(chain.from_iterable(actions))])


def lifespans(players: Players, ticks: int) -> np.ndarray:
    """Return the ticks that each player lives in one game, int64 (K,), cut at a length."""
    at_once = AT_ONCE if players.habitat.kind == "host" else AT_ONCE_IN_JAX
    parts = (players.take(slice(k, k + at_once)) for k in range(0, len(players.genomes), at_once))
    # Part by part, since games keep all actions of their players.
    return np.concatenate([play(part, 1, ticks, at_once=at_once).ticks[:, 0] for part in parts])


def _play_at_once(
    players: Players, games: int, ticks: int, frozen: bool, script: Games | None
) -> Games:
    """Play all games at once; the games of one player are adjacent."""
    boards, count = _Boards(players, games), len(players.genomes) * games
    playing, course = np.ones(count, bool), np.zeros(count, np.uint64)
    length, food, actions = np.zeros(count, np.int64), np.zeros(count), []
    with _opened(players.habitat, count) as table:
        senses = first = np.array(table.reset(np.arange(count), boards.words()))
        for tick in range(1, ticks + 1):
            if script is None:
                action = boards.think(first if frozen else senses, tick)
            else:
                action = np.repeat(script.actions_at(tick), games, axis=0)
            actions.append(action[::games].copy())
            senses, outcome = table.step(action, playing)
            dies = boards.judge(outcome, senses)
            length += playing
            if outcome.food is not None:
                food += np.where(playing, outcome.food, 0)
            course = np.where(playing, _next_course(course, senses, food), course)
            playing = playing & ~dies
            if not playing.any():
                break
    results = [array.reshape(-1, games) for array in (length, ~playing, food, course)]
    taken = zip(np.stack(actions, axis=1), length[::games], strict=True)
    return Games._make([*results, [each[:ticks] for each, ticks in taken]])


def _next_course(course: np.ndarray, senses: np.ndarray, food: np.ndarray) -> np.ndarray:
    """Return the hash of each game's course after one more tick."""
    place = np.arange(1, senses.shape[1] + 1, dtype=np.uint64) * MIX
    words = np.ascontiguousarray(senses, np.float32).view(np.uint32).astype(np.uint64)
    return (course * MIX ^ food.view(np.uint64)) * MIX + words @ place


class _Boards:
    """Brains and energy stores, one of each for each game."""

    def __init__(self, players: Players, games: int) -> None:
        law, self._words = players.law, players.habitat.words
        per_game = partial(jnp.repeat, repeats=games, axis=0)
        cells = jnp.asarray(np.tile(np.arange(games), len(players.genomes)), jnp.int32)
        genome = law.heredity.layout.split(per_game(jnp.asarray(players.genomes)))
        self._mind = Mind(genome, players.keys.map(per_game), cells)
        self._memory = jnp.zeros((len(cells), law.memory), jnp.float32)
        self._rates = Rates(*map(per_game, players.rates))
        self._vitals = Vitals(to_fixed_point(self._rates.store), jnp.zeros(len(cells), jnp.int32))
        self._faulty = jnp.zeros(len(cells), bool)
        self._think, self._judge = shared(think, law), shared(judge, law)

    def words(self) -> np.ndarray:
        """Return the random words that bodies begin with, uint32 (K E, words)."""
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
    """Yield a habitat that is stepped on the host, opened with a body for each game."""
    table = habitat if habitat.kind == "host" else OnHost(habitat)
    table.open(games)
    try:
        yield table
    finally:
        table.close()
