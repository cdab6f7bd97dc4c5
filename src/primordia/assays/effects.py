"""Effects of mutations: mutants of an organism play the parent's own games.

A mutant plays the games that its parent plays, with the same random numbers. In a game without
chance a genome always lives equally long. So if a mutant lives exactly as long as its parent, the
mutation had no effect on the lifespan.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from primordia.assays.mutants import Operator, moments_of, mutants, own_operator
from primordia.assays.subjects import FOUNDERS, GAMES, TICKS, Subjects, founders
from primordia.mutations.blocks import FounderBlock
from primordia.mutations.calibrated import Calibrated
from primordia.mutations.contract import Mutation
from primordia.mutations.gaussian import Block, Gaussian
from primordia.organism.playing.games import lifespans_in_games

MUTANTS = 24
"""Default number of mutants that each mutation makes of an organism."""
SCALES = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3)
"""Default standard deviations of noise, as shares of the standard deviation of founders' weights."""


@dataclass(frozen=True)
class Effect:
    """The effect of one mutation on one organism."""

    mutation: str
    organism: int
    world: int
    lifespan: float
    """mean ticks that the organism lived in its games"""
    mutants: np.ndarray
    """mean ticks that each mutant lived in the same games, float64 (M,)"""

    @property
    def as_long(self) -> float:
        """Share of the mutants that lived exactly as long as the parent."""
        return float((self.mutants == self.lifespan).mean())

    @property
    def longer(self) -> float:
        """Share of the mutants that lived longer than the parent."""
        return float((self.mutants > self.lifespan).mean())

    @property
    def tenth_longer(self) -> float:
        """Share of the mutants that lived longer than the parent by a tenth or more."""
        return float((10 * self.mutants >= 11 * self.lifespan).mean())

    @property
    def third_shorter(self) -> float:
        """Share of the mutants whose lifespan was at least a third below the parent's."""
        return float((3 * self.mutants <= 2 * self.lifespan).mean())

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "mutation": self.mutation,
            "organism": self.organism,
            "world": self.world,
            "lifespan": self.lifespan,
            "mutants": len(self.mutants),
            "as_long": self.as_long,
            "longer": self.longer,
            "tenth_longer": self.tenth_longer,
            "third_shorter": self.third_shorter,
            "median": float(np.median(self.mutants)),
            "longest": float(self.mutants.max()),
        }


def effects(
    subjects: Subjects,
    scales: Sequence[float] = SCALES,
    differs: Sequence[float] = (),
    count: int = MUTANTS,
    games: int = GAMES,
    ticks: int = TICKS,
) -> list[Effect]:
    """Make mutants of each subject by the run's own mutation and by others, and let the mutants live.

    Args:
        subjects: the parents.
        scales: standard deviations of Gaussian noise on all weights, as shares of the standard
            deviation of founders' weights in each block.
        differs: shares by which calibrated mutations change behaviour; see `mutations.calibrated`.
            A parent remembers moments of one game.
        count: number of mutants that each mutation makes of each parent.
        games: number of games of each genome; 1 if the habitat draws nothing at random.
        ticks: number of ticks after which a game is cut.

    Raises:
        InputError: the run's own mutation makes no mutants.
    """
    operators = [own_operator(subjects), *_others(subjects, scales, differs)]
    number = subjects.games(games)
    lived = lifespans_in_games(subjects.players, number, ticks).mean(axis=1)
    return [
        effect
        for operator in operators
        for effect in _of_operator(subjects, operator, lived, count, number, ticks)
    ]


def _of_operator(
    subjects: Subjects, operator: Operator, lived: np.ndarray, count: int, games: int, ticks: int
) -> Iterable[Effect]:
    rule, parents = operator.mutation.moments, len(lived)
    remembered = None if rule is None else moments_of(subjects.players, rule, ticks)
    genomes = mutants(subjects, operator, count, remembered)
    same = subjects.players.take(np.repeat(np.arange(parents), count))
    spans = lifespans_in_games(
        same._replace(genomes=genomes.reshape(parents * count, -1)), games, ticks
    )
    of_each = spans.mean(axis=1).reshape(parents, count)
    numbers = zip(subjects.organism.tolist(), subjects.world.tolist(), strict=True)
    for (organism, world), own, theirs in zip(numbers, lived.tolist(), of_each, strict=True):
        yield Effect(operator.name, organism, world, own, theirs)


def _others(
    subjects: Subjects, scales: Sequence[float], differs: Sequence[float]
) -> list[Operator]:
    """Return Gaussian mutations and calibrated ones, in units of the deviations of founders."""
    deviations = founder_deviations(subjects).items()
    made: dict[str, Mutation] = {}
    for scale in scales:
        blocks = {name: Block(scale=scale * own) for name, own in deviations}
        made[f"scale {scale:g}"] = Gaussian(probability=1.0, blocks=blocks)
    founder_blocks = {name: FounderBlock(founder_scale=own) for name, own in deviations}
    for value in differs:
        made[f"differs {value:g}"] = Calibrated(
            probability=1.0, differs=value, blocks=founder_blocks
        )
    return [Operator.of(name, mutation, subjects) for name, mutation in made.items()]


def founder_deviations(subjects: Subjects) -> dict[str, float]:
    """Return the standard deviation of founders' weights in each block, measured from founders."""
    parts = subjects.law.heredity.layout.split(founders(subjects.config, FOUNDERS))
    return {name: float(part.std()) for name, part in parts.items()}
