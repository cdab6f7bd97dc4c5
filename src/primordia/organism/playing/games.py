"""Games: organisms play side by side, each many times, without neighbours or children."""

from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

import jax
import numpy as np

from primordia.errors import InputError
from primordia.habitats.archipelago import Archipelago
from primordia.habitats.contract import AnyHabitat
from primordia.law.law import Law
from primordia.law.metabolism import Rates
from primordia.organism.playing import in_jax, on_host
from primordia.organism.playing.seats import Frozen, Manner, Seats, Stretch
from primordia.progress import steps, tell
from primordia.random.wide import Wide

AT_ONCE = {"host": 128, "jax": 1024}
"""Games that are played side by side, by kind of habitat; a game in JAX needs little more memory than a
genome."""
MIX = np.uint64(0x9E3779B97F4A7C15)
"""An odd number that mixes the bits of courses."""


class Players(NamedTuple):
    """K organisms, with all inputs that determine their games."""

    law: Law
    habitat: AnyHabitat
    genomes: np.ndarray
    """float32 (K, P)"""
    keys: Wide
    """(K,), key of everything random in a player's games"""
    rates: Rates
    """metabolism of each player, each float32 (K,)"""
    island: np.ndarray | None = None
    """number of the island on which each player plays, int (K,); None: the habitat has no islands"""

    def by_island(self) -> "Iterator[tuple[np.ndarray, Players]]":
        """Yield the index of the players of each island, (n,), and these players in its habitat."""
        if self.island is None:
            yield np.arange(len(self.genomes)), self
            return
        for number in np.unique(self.island).tolist():
            index = np.flatnonzero(self.island == number)
            here = self.habitat
            if isinstance(here, Archipelago):
                here = here.habitats[number]
            yield index, self.take(index)._replace(habitat=here)

    @property
    def deterministic(self) -> bool:
        """Whether all games of a player are the same."""
        random = self.habitat.words - self.law.heredity.layout.genes
        return random == 0 and self.law.motor.kind == "direct"

    def take(self, index: slice | np.ndarray) -> "Players":
        """Return the players at an index."""
        own = self.genomes, self.keys, self.rates, self.island
        genomes, keys, rates, island = jax.tree.map(lambda leaf: np.asarray(leaf)[index], own)
        return self._replace(genomes=genomes, keys=keys, rates=rates, island=island)


class Games(NamedTuple):
    """Results when each of K players plays E games, arrays (K, E); or of one player, arrays (E,)."""

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
        """Return the action of each player at a tick of its first game, which is repeated when it
        ends: (K,) or (K, A)."""
        return np.stack([each[(tick - 1) % len(each)] for each in self.actions])


def play(
    players: Players,
    games: int,
    ticks: int,
    *,
    frozen: Frozen | None = None,
    script: Games | None = None,
) -> Games:
    """Let each player play a number of games, until all games are over or cut.

    Args:
        players: the organisms.
        games: number of games of each player.
        ticks: length at which a game is cut.
        frozen: the inputs of each player, senses and memory, whose values stay as at the start of a game.
        script: earlier games of the same players, whose actions are repeated regardless of senses.
    """
    index, parts = zip(*_in_parts(players, games, ticks, frozen, script), strict=True)
    *arrays, actions = zip(*parts, strict=True)
    order = np.argsort(np.concatenate(index))
    listed = list(chain.from_iterable(actions))
    in_order = (np.concatenate(each)[order] for each in arrays)
    return Games._make([*in_order, [listed[k] for k in order]])


def lifespans(players: Players, ticks: int) -> np.ndarray:
    """Return each player's lifespan in one game, in ticks; `ticks` is the limit: int64 (K,)."""
    return lifespans_in_games(players, 1, ticks)[:, 0]


def lifespans_in_games(
    players: Players, games: int, ticks: int, frozen: Frozen | None = None
) -> np.ndarray:
    """Return each player's lifespan in each game, in ticks; `ticks` is the limit: int64 (K, E)."""
    found = np.zeros((len(players.genomes), games), np.int64)
    for index, part in _in_parts(players, games, ticks, frozen, None):
        found[index] = part.ticks  # the actions of a part are dropped
    return found


def _in_parts(
    players: Players, games: int, ticks: int, frozen: Frozen | None, script: Games | None
) -> Iterator[tuple[np.ndarray, Games]]:
    """Play the games of some players at once, then of the next; a player's games are not separated.

    Yield the index of these players, (n,), and their games.

    Raises:
        InputError: there is no game, or no tick.
    """
    if games < 1 or ticks < 1:
        raise InputError("at least one game of at least one tick is needed")
    size = max(AT_ONCE[players.habitat.kind] // games, 1)
    parts = [
        (index[first : first + size], here.take(slice(first, first + size)))
        for index, here in players.by_island()
        for first in range(0, len(index), size)
    ]
    for some, own in steps(parts, "playing"):
        repeated = script and script._replace(actions=[script.actions[k] for k in some])
        held = frozen and frozen.take(some)
        yield some, _play_at_once(own, games, ticks, held, repeated)


def _play_at_once(
    players: Players, games: int, ticks: int, frozen: Frozen | None, script: Games | None
) -> Games:
    """Play all games at once; the games of one player are adjacent."""
    count = len(players.genomes) * games
    length, food = np.zeros(count, np.int64), np.zeros(count)
    course, factor = np.zeros(count, np.uint64), np.uint64(1)
    over, actions = np.zeros(count, bool), []
    for stretch in stretches(players, games, Manner(ticks, frozen), script):
        playing = stretch.playing
        length += playing.sum(axis=0)
        if stretch.food is not None:
            # Food is added tick by tick, since sums of floats depend on their order.
            food = np.cumsum([food, *np.where(playing, stretch.food, 0)], axis=0)[-1]
        factors = np.cumprod(np.full(len(playing), MIX)) * factor
        course += (np.where(playing, _marks(stretch), 0) * factors[:, None]).sum(axis=0)
        factor = factors[-1]
        actions.append(stretch.action[:, ::games])
        over = ~stretch.alive
        tell("playing", float(over.mean()))
        if over.all():
            break
    results = [array.reshape(-1, games) for array in (length, over, food, course)]
    taken = zip(np.concatenate(actions).swapaxes(0, 1), length[::games], strict=True)
    return Games._make([*results, [each[:ticks] for each, ticks in taken]])


def stretches(
    players: Players, games: int, manner: Manner, script: Games | None = None
) -> Iterator[Stretch]:
    """Begin all games of K players of one island, and play them in the manner given for each player."""
    law, habitat = players.law.alone, players.habitat
    player = np.repeat(np.arange(len(players.genomes)), games)
    genomes, keys, rates, _ = players.take(player)[2:]
    game = np.tile(np.arange(games, dtype=np.int32), len(players.genomes))
    seated = Seats(genomes, keys, game, rates)
    repeated = None if script is None else lambda tick: script.actions_at(tick)[player]
    manner = manner._replace(frozen=manner.frozen and manner.frozen.take(player), script=repeated)
    if habitat.kind == "host":
        return on_host.stretches(law, habitat, seated, manner)
    return in_jax.stretches(law, habitat, seated, manner)


def _marks(stretch: Stretch) -> np.ndarray:
    """Return a hash of the senses and the food of each tick, uint64 (T, N)."""
    high, low = stretch.mark[..., 0].astype(np.uint64), stretch.mark[..., 1].astype(np.uint64)
    marks = high << np.uint64(32) | low
    if stretch.food is None:
        return marks
    gained = np.ascontiguousarray(stretch.food, np.float32).view(np.uint32).astype(np.uint64)
    return marks + gained * MIX
