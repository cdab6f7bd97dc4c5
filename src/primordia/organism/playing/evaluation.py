"""Evaluation: organisms play whole games with fresh keys, from other starts, or without senses.

Organisms are selected for long life in their own world. Evaluation measures their scores in the
game itself, and whether they react to their senses.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from primordia.config import Config
from primordia.errors import InputError
from primordia.history.islands import number_of
from primordia.organism.playing.games import Games, Players, play
from primordia.organism.playing.players import moved, players_of
from primordia.organism.playing.seats import Frozen
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.records import Records, on_its_device
from primordia.settings.fields import setting_fields
from primordia.settings.islands import KEY
from primordia.settings.tables import NONE, did_you_mean, merged, replaced
from primordia.settings.values import plain

GAMES = 30
TICKS = 100_000
Senses = Literal["live", "frozen", "ignored"]


class Spread(NamedTuple):
    """Minimum, quartiles and maximum."""

    minimum: float
    q1: float
    median: float
    q3: float
    maximum: float

    @classmethod
    def of(cls, values: np.ndarray) -> "Spread":
        """Return the spread of one value over games, (E,)."""
        return cls(*np.percentile(values, [0, 25, 50, 75, 100]).tolist())


@dataclass(frozen=True)
class Evaluation:
    """The results of an organism in a number of games."""

    organism: int
    world: int
    senses: Senses
    lived: Games
    """games under the law of the task: a game is over when the organism dies"""
    whole: Games | None
    """whole games, in which food is the score; None if the habitat has no original task"""
    deterministic: bool
    """whether nothing is random in the games, so that one game is enough"""

    @property
    def games(self) -> int:
        """Number of games played."""
        return len(self.lived.ticks)

    @property
    def distinct(self) -> int:
        """Number of distinct games; two games are distinct if any of their senses or their food
        differ."""
        return len(np.unique((self.whole or self.lived).course))

    @property
    def repeats(self) -> bool:
        """Whether all games of the organism are the same. A single game shows this only if nothing is
        random."""
        return self.deterministic or self.distinct == 1 < self.games

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        result = {
            "organism": self.organism,
            "world": self.world,
            "games": self.games,
            "distinct": self.distinct,
            "senses": self.senses,
            "lifespan": Spread.of(self.lived.ticks)._asdict(),
            "alive_when_cut": int((~self.lived.over).sum()),
        }
        if self.whole is None:
            return result
        score, length = Spread.of(self.whole.food), Spread.of(self.whole.ticks)
        cut = int((~self.whole.over).sum())
        return {**result, "score": score._asdict(), "length": length._asdict(), "cut": cut}


@on_its_device
def evaluate(
    run: Records,
    organisms: Sequence[tuple[int, int]],
    *,
    games: int = GAMES,
    ticks: int = TICKS,
    senses: Senses = "live",
    habitat: Mapping[str, Any] | None = None,
    on: str | None = None,
    **changes: Any,
) -> list[Evaluation]:
    """Let organisms play games side by side; no result depends on other organisms.

    Args:
        run: the organisms' run.
        organisms: birth number and world of each organism.
        games: number of games of each organism; one game if all would be the same.
        ticks: length at which a game is cut; whole games are also cut at the habitat's `episode`.
        senses: `live`: as usual; `frozen`: senses keep their values from the start of a game;
            `ignored`: each organism repeats the actions of another game, which it played with its
            task's settings.
        habitat: changed settings of the habitat, such as `{"senses": [49, 50]}`.
        on: name of the island on which all play; by default each plays on the island of its birth.
        changes: further changed settings as keywords, such as `sticky=0.25, noops=30`.

    Raises:
        InputError: no such organism was born, the habitat has no such setting, there is no such island,
            or the brain does not fit the changed habitat.
    """
    if not organisms:
        return []
    own = players_of(run, np.array([run.lives.row(*each) for each in organisms]))
    return judged(
        run.config,
        own,
        organisms,
        games=games,
        ticks=ticks,
        senses=senses,
        habitat={**(habitat or {}), **changes},
        there=on_island(run, own, [world for _, world in organisms], on),
    )


def on_island(
    run: Records, players: Players, worlds: Sequence[int], on: str | None
) -> Players | None:
    """Return players of these worlds on an island; None if no island is named.

    Raises:
        InputError: there is no such island.
    """
    if on is None:
        return None
    return moved(run, players, np.array(worlds), number_of(run.config.islands, on, "--on"))


def judged(
    config: Config,
    own: Players,
    numbers: Sequence[tuple[int, int]],
    *,
    games: int,
    ticks: int,
    senses: Senses,
    habitat: Mapping[str, Any],
    there: Players | None = None,
) -> list[Evaluation]:
    """Let players play games side by side; `numbers` name the players in results. See `evaluate`.

    `there` are the same players on another island, if they play there.
    """
    if senses not in get_args(Senses):
        raise InputError(f"senses: {senses!r} is not one of {', '.join(get_args(Senses))}")
    players = (there or own)._replace(habitat=changed(config, habitat).build_habitat())
    script = play(elsewhere(own), 1, ticks) if senses == "ignored" else None
    fixed = players.deterministic
    count = 1 if fixed else games
    frozen = all_senses(players) if senses == "frozen" else None
    play_all = partial(play, games=count, frozen=frozen, script=script)
    lived, original = play_all(players, ticks=ticks), _in_the_original(players)
    if original is not None:
        episode = original.habitat.episode or ticks
        whole = play_all(original, ticks=min(ticks, episode))
    return [
        Evaluation(
            organism, world, senses, lived.of_player(k), original and whole.of_player(k), fixed
        )
        for k, (organism, world) in enumerate(numbers)
    ]


def elsewhere(players: Players) -> Players:
    """Return the players with other random bits: their games are none of those that are judged."""
    first = wide(np.zeros(len(players.genomes), np.uint64))
    return players._replace(keys=stream(players.keys, Purpose.REBIRTH, first))


def all_senses(players: Players) -> Frozen:
    """Return the mask that freezes all senses of players and no memory."""
    count = len(players.genomes)
    return Frozen(np.ones((count, players.law.senses), bool), np.zeros((count, 1), bool))


def changed(config: Config, changes: Mapping[str, Any]) -> Config:
    """Return a run's settings with some settings of its habitat changed.

    Raises:
        InputError: the habitat has no such setting, or brains do not fit the changed habitat.
    """
    given: dict[str, Any] = plain(dict(changes))
    before = config.build_habitat()
    known = list(setting_fields(type(before)))
    for name in changes:
        if known and name not in {each.partition(".")[0] for each in known}:
            hint = did_you_mean(name, known)
            raise InputError(f"this run's habitat has no setting {name!r}{hint}")
    values = merged(config.habitat, given)
    if (islands := values.get(KEY)) and KEY not in changes:
        values[KEY] = [_island_changed(each, given) for each in islands]
    values = replaced(values, NONE, None)
    after = config.model_copy(update={"habitat": values})
    habitat = after.build_habitat()
    if (habitat.senses_size, habitat.action) != (before.senses_size, before.action):
        raise InputError(
            f"the changed settings ({', '.join(changes)}) give the habitat {habitat.senses_size} senses"
            f" and {habitat.action.size} actions; the brain is made for {before.senses_size} senses and"
            f" {before.action.size} actions"
        )
    return after


def _island_changed(island: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return an island's table with those changes whose settings it states itself."""
    table = island.get("habitat", {})
    return {
        **island,
        "habitat": merged(table, {name: changes[name] for name in changes if name in table}),
    }


def _in_the_original(players: Players) -> Players | None:
    """Return the players in the habitat's original task, without metabolism; None without such a task."""
    original = players.habitat.original()
    if original is None:
        return None
    return players._replace(habitat=original, law=replace(players.law, metabolism=None))
