"""Ablation: an organism plays its games again without senses, memory, learning, or a block of weights."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from primordia.assays.subjects import GAMES, TICKS, Subjects
from primordia.brains.layout import BODY
from primordia.organism.playing.games import Players, lifespans_in_games
from primordia.organism.playing.seats import Frozen


@dataclass(frozen=True)
class Ablation:
    """An organism's life without a sense, its memory, its learning, or a block of weights."""

    without: str
    organism: int
    world: int
    intact: float
    """mean ticks that the intact organism lived in its games"""
    lifespan: float
    """mean ticks that the ablated organism lived in the same games"""

    @property
    def kept(self) -> float:
        """Life after the ablation, as a share of the intact life."""
        return self.lifespan / self.intact

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {**asdict(self), "kept": self.kept}


class _Loss(NamedTuple):
    """The ablated parts of K organisms."""

    name: str
    frozen: Frozen
    players: Players


def ablate(
    subjects: Subjects, each_sense: bool = False, games: int = GAMES, ticks: int = TICKS
) -> list[Ablation]:
    """Let each subject live again: without senses, memory and plasticity, then without each block.

    Ablated senses keep their values from the start of each game. An ablated memory is zero in each
    tick. A brain without plasticity has its inherited weights for life. Ablated weights are zero, and so
    are the genes of an ablated body, which is then a founder's.

    Args:
        subjects: the organisms.
        each_sense: whether to ablate each single sense, too.
        games: number of games of each organism; 1 if the habitat draws nothing at random.
        ticks: number of ticks after which a game is cut.
    """
    number = subjects.games(games)
    intact = lifespans_in_games(subjects.players, number, ticks).mean(axis=1)
    found = []
    for loss in _losses(subjects, each_sense):
        spans = lifespans_in_games(loss.players, number, ticks, loss.frozen).mean(axis=1)
        columns = (subjects.organism, subjects.world, intact, spans)
        rows = zip(*(column.tolist() for column in columns), strict=True)
        found += [Ablation(loss.name, *row) for row in rows]
    return found


def _losses(subjects: Subjects, each_sense: bool) -> Iterator[_Loss]:
    players, law = subjects.players, subjects.law
    count, layout = len(players.genomes), law.heredity.layout
    nothing = Frozen(np.zeros((count, law.senses), bool), np.zeros((count, 1), bool))
    yield _Loss("senses", nothing._replace(senses=~nothing.senses), players)
    if law.memory:
        yield _Loss("memory", nothing._replace(memory=~nothing.memory), players)
    if (innate := law.brain.innate()) is not None:
        yield _Loss("plasticity", nothing, players._replace(law=replace(law, brain=innate)))
    for block in layout.names:
        kept = layout.split(players.genomes)
        kept[block] = np.zeros_like(kept[block])
        is_body = layout.genes and block == BODY
        name = "inherited body" if is_body else f"{block} weights"
        yield _Loss(name, nothing, players._replace(genomes=layout.join(kept)))
    for sense in range(law.senses if each_sense else 0):
        senses = np.tile(np.arange(law.senses) == sense, (count, 1))
        yield _Loss(f"sense {sense}", nothing._replace(senses=senses), players)
