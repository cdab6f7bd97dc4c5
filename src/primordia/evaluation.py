"""Evaluation: an organism plays whole games, under fresh keys, from other starts, or without seeing.

It was selected for its life in its own world. How it does in the game as others score it, and whether it
looks at the game at all, is asked here.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, NamedTuple

import jax.numpy as jnp
import numpy as np

from primordia.climate import climate_at
from primordia.config import Config
from primordia.errors import InputError
from primordia.games import Games, Player, play
from primordia.keys import Purpose, stream
from primordia.lineage import rebuild
from primordia.lives import lives
from primordia.metabolism import Rates
from primordia.report import opened, world_ticks
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
        ticks: a game that still goes on then is cut.
        senses: `live`; `frozen`, they stay as they are when a game begins; `ignored`, it does what it
            did in a game with its task's own settings, over and over, whatever happens.
        changes: settings of the habitat, such as `sticky=0.25, noops=30`.

    Raises:
        InputError: no such organism, or a setting that the habitat does not have.
    """
    if games < 1 or ticks < 1:
        raise InputError("evaluate: play one game or more, of one tick or more")
    config, _ = opened(run)
    lives(run).row(organism, world)
    changed = config.model_copy(update={"habitat": {**config.habitat, **changes}})
    before, after = _players(run, config, organism, world), _players(run, changed, organism, world)
    script = play(before[-1], 1, ticks).actions if senses == "ignored" else None
    count = 1 if after[0].deterministic else games
    played = [
        play(player, count, ticks, frozen=senses == "frozen", script=script) for player in after
    ]
    whole = played[1] if len(played) > 1 else None
    return Evaluation(organism, world, senses, played[0], whole)


def _players(run: Path, config: Config, organism: int, world: int) -> list[Player]:
    """The organism in its task, and in the original game if there is one."""
    habitat = config.build_habitat()
    law = config.build_law(habitat)
    end = world_ticks(opened(run)[1].arrays())[world : world + 1].astype(np.int64)
    climate = climate_at(run, config, law, world)(end)
    rates = Rates(*(jnp.asarray(climate[f"metabolism.{name}"]) for name in Rates._fields))
    key = stream(wide([config.seed + world]), Purpose.EVALUATION, wide([organism]))
    own = Player(law, habitat, rebuild(run, organism, world), key, rates)
    if not hasattr(habitat, "original"):
        return [own]
    return [own, own._replace(habitat=habitat.original(), law=replace(law, metabolism=None))]
