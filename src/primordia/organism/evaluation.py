"""Evaluation: an organism plays whole games, under fresh keys, from other starts, or without seeing.

It was selected for its life in its own world. How it does in the game as others score it, and whether it
looks at the game at all, is asked here.
"""

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Literal, NamedTuple

import jax.numpy as jnp
import numpy as np

from primordia.disk.directory import read_config
from primordia.errors import InputError
from primordia.history.climate import climate_at
from primordia.history.lineage import rebuild
from primordia.history.report import opened, world_ticks
from primordia.keys import Purpose, stream
from primordia.law.metabolism import Rates
from primordia.organism.games import Games, Player, play
from primordia.wide import wide

GAMES = 30
TICKS = 100_000
Senses = Literal["live", "frozen", "ignored"]


class Spread(NamedTuple):
    """Quartiles and maximum."""

    q1: float
    median: float
    q3: float
    maximum: float

    @classmethod
    def of(cls, values: np.ndarray) -> "Spread":
        """Of some games."""
        return cls(*np.percentile(values, [25, 50, 75, 100]).tolist())


@dataclass(frozen=True)
class Evaluation:
    """What became of an organism in some games."""

    organism: int
    world: int
    senses: Senses
    lived: Games
    """by the law of its task: a game is over when it dies"""
    whole: Games | None
    """whole games, in which food is the score; None where the habitat knows of none"""

    @property
    def games(self) -> int:
        """How many were played."""
        return len(self.lived.ticks)

    @property
    def distinct(self) -> int:
        """Games that differ in something perceived or gathered."""
        return len(np.unique((self.whole or self.lived).course))

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        found = {
            "organism": self.organism,
            "world": self.world,
            "games": self.games,
            "distinct": self.distinct,
            "senses": self.senses,
            "lifespan": Spread.of(self.lived.ticks)._asdict(),
            "alive_when_cut": int((~self.lived.over).sum()),
        }
        if self.whole is None:
            return found
        score, length = Spread.of(self.whole.food), Spread.of(self.whole.ticks)
        cut = int((~self.whole.over).sum())
        return {**found, "score": score._asdict(), "length": length._asdict(), "cut": cut}


def evaluate(
    run: Path,
    organism: int,
    world: int = 0,
    *,
    games: int = GAMES,
    ticks: int = TICKS,
    senses: Senses = "live",
    **changes: Any,
) -> Evaluation:
    """Let an organism play.

    Args:
        run: the run's directory.
        organism: birth number.
        world: where it lived.
        games: how many; one is played where all would be the same.
        ticks: a game that still goes on then is cut; whole games also where others cut them.
        senses: `live`; `frozen`, they stay as they are when a game begins; `ignored`, it does what it
            did in a game with its task's own settings, over and over, whatever happens.
        changes: settings of the habitat, such as `sticky=0.25, noops=30`.

    Raises:
        InputError: no such organism, a setting that the habitat does not have, or one with which the
            brain no longer fits.
    """
    if games < 1 or ticks < 1:
        raise InputError("evaluate: play one game or more, of one tick or more")
    own = player_of(run, organism, world)
    player = own._replace(habitat=_changed(run, own.habitat, changes))
    script = play(own, 1, ticks).actions if senses == "ignored" else None
    count = 1 if player.deterministic else games
    played = partial(play, games=count, frozen=senses == "frozen", script=script)
    lived, whole = played(player, ticks=ticks), _in_the_original(player)
    if whole is None:
        return Evaluation(organism, world, senses, lived, None)
    episode = getattr(whole.habitat, "episode", None) or ticks
    return Evaluation(organism, world, senses, lived, played(whole, ticks=min(ticks, episode)))


def player_of(run: Path, organism: int, world: int = 0) -> Player:
    """An organism, with all that its games in its own task are a function of.

    Raises:
        InputError: no such organism was born.
    """
    genome = rebuild(run, organism, world)
    config, last = opened(run)
    habitat = config.build_habitat()
    law = config.build_law(habitat)
    end = world_ticks(last.arrays())[world : world + 1].astype(np.int64)
    climate = climate_at(run, config, law, world)(end)
    rates = Rates(*(jnp.asarray(climate[f"metabolism.{name}"]) for name in Rates._fields))
    key = stream(wide([config.seed + world]), Purpose.EVALUATION, wide([organism]))
    return Player(law, habitat, genome, key, rates)


def _changed(run: Path, before: Any, changes: dict[str, Any]) -> Any:
    """The run's habitat with some settings changed."""
    config = read_config(run)
    habitat = config.model_copy(update={"habitat": {**config.habitat, **changes}}).build_habitat()
    if (habitat.senses_size, habitat.action) != (before.senses_size, before.action):
        raise InputError(
            f"evaluate: with other {', '.join(changes)} the habitat has {habitat.senses_size} senses"
            f" and {habitat.action.size} actions; the brain is made for {before.senses_size} and"
            f" {before.action.size}"
        )
    return habitat


def _in_the_original(player: Player) -> Player | None:
    """The same in the original game, where there is one; nobody starves in it."""
    original = player.habitat.original() if hasattr(player.habitat, "original") else None
    if original is None:
        return None
    return player._replace(habitat=original, law=replace(player.law, metabolism=None))
