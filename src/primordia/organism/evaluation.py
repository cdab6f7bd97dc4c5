"""Evaluation: organisms play whole games, under fresh keys, from other starts, or without seeing.

They were selected for their lives in their own worlds. How they do in the game as others score it, and
whether they look at the game at all, is asked here.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal, NamedTuple

import jax.numpy as jnp
import numpy as np

from primordia.config import Config
from primordia.errors import InputError
from primordia.habitats.contract import AnyHabitat
from primordia.history.climate import climate_at
from primordia.history.lineage import rebuild_all
from primordia.law.metabolism import Rates
from primordia.organism.games import Games, Players, play
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.archive import Archive
from primordia.settings.fields import setting_fields
from primordia.settings.tables import NONE, did_you_mean, merged, replaced

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
    run: Archive,
    organisms: Sequence[tuple[int, int]],
    *,
    games: int = GAMES,
    ticks: int = TICKS,
    senses: Senses = "live",
    habitat: Mapping[str, Any] | None = None,
    **changes: Any,
) -> list[Evaluation]:
    """Let organisms play, side by side; how many there are changes nothing for any of them.

    Args:
        run: where they lived.
        organisms: birth number and world of each.
        games: how many each; one is played where all would be the same.
        ticks: a game that still goes on then is cut; whole games also where others cut them.
        senses: `live`; `frozen`, they stay as they are when a game begins; `ignored`, each does what it
            did in a game with its task's own settings, over and over, whatever happens.
        habitat: settings of the habitat to be changed, such as `{"senses": [49, 50]}`.
        changes: more of them, such as `sticky=0.25, noops=30`.

    Raises:
        InputError: no such organism, a setting that the habitat does not have, or one with which the
            brain no longer fits.
    """
    if games < 1 or ticks < 1:
        raise InputError("evaluate: play one game or more, of one tick or more")
    if not organisms:
        return []
    own = players_of(run, organisms)
    wanted = {**(habitat or {}), **changes}
    players = own._replace(habitat=_changed(run.config, own.habitat, wanted))
    script = play(own, 1, ticks) if senses == "ignored" else None
    count = 1 if players.deterministic else games
    played = partial(play, games=count, frozen=senses == "frozen", script=script)
    lived, original = played(players, ticks=ticks), _in_the_original(players)
    if original is not None:
        episode = original.habitat.episode or ticks
        whole = played(original, ticks=min(ticks, episode))
    return [
        Evaluation(organism, world, senses, lived.of(k), original and whole.of(k))
        for k, (organism, world) in enumerate(organisms)
    ]


def players_of(run: Archive, organisms: Sequence[tuple[int, int]]) -> Players:
    """Organisms by birth number and world, with all that games in their own task are a function of.

    Raises:
        InputError: no such organism was born.
    """
    genomes = rebuild_all(run, organisms)
    births, worlds = np.array(organisms, np.int64).T
    climates = {w: climate_at(run, w)(run.ends[[w]]) for w in set(worlds.tolist())}
    each = (np.concatenate([climates[w][f"metabolism.{n}"] for w in worlds]) for n in Rates._fields)
    rates = Rates(*map(jnp.asarray, each))
    keys = stream(wide(run.config.seed + worlds), Purpose.EVALUATION, wide(births))
    return Players(run.law, run.config.build_habitat(), genomes, keys, rates)


def _changed(config: Config, before: AnyHabitat, changes: dict[str, Any]) -> AnyHabitat:
    """Return a run's habitat with some settings changed."""
    known = list(setting_fields(type(before)))
    for name in changes:
        if known and name not in {each.partition(".")[0] for each in known}:
            meant = did_you_mean(name, known)
            raise InputError(f"evaluate: this run's habitat has no setting {name!r}{meant}")
    values = replaced(merged(config.habitat, changes), NONE, None)
    habitat = config.model_copy(update={"habitat": values}).build_habitat()
    if (habitat.senses_size, habitat.action) != (before.senses_size, before.action):
        raise InputError(
            f"evaluate: with other {', '.join(changes)} the habitat has {habitat.senses_size} senses"
            f" and {habitat.action.size} actions; the brain is made for {before.senses_size} and"
            f" {before.action.size}"
        )
    return habitat


def _in_the_original(players: Players) -> Players | None:
    """The same in the original game, where there is one; nobody starves in it."""
    original = players.habitat.original()
    if original is None:
        return None
    return players._replace(habitat=original, law=replace(players.law, metabolism=None))
