"""The lives of an organism's ancestors: genomes of the line of descent live again.

If bodies are inherited, their brains and bodies live again apart, too: each brain in the body of the
line's last organism, and each body with the last organism's brain. So it can be seen which came first.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from operator import ne
from typing import Any

import numpy as np

from primordia.assays.subjects import GAMES, TICKS, of_run
from primordia.history import pedigree, series
from primordia.history.islands import names_of
from primordia.history.rebuilding import descent
from primordia.law.world import BirthCause
from primordia.organism.playing.games import lifespans_in_games
from primordia.runs.records import Records

MOST = 200
"""Default number of genomes of a line that live again."""
PARTS = "brain", "body"
"""Parts of a genome that live again apart, by their fields of `Step`."""
GOOD = 0.9
"""A genome counts as good if it lives at least this share of the last genome's life."""


@dataclass(frozen=True)
class Step:
    """A genome on the line of descent, and its life."""

    generation: int
    """births on the line after its first organism"""
    organism: int
    born: int
    """tick of birth"""
    birth_cause: str
    recorded: int
    """ticks that the organism has lived in its world so far"""
    reborn: float
    """mean ticks that the genome lived in the games of the line's last organism"""
    island: str | None = None
    """name of the island on which the organism was born; None if its world has no islands"""
    brain: float | None = None
    """mean ticks that the genome's brain lived in the last organism's body; None: bodies are the same"""
    body: float | None = None
    """mean ticks that the last organism's brain lived in the genome's body; None: bodies are the same"""

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {name: value for name, value in asdict(self).items() if value is not None}


@dataclass(frozen=True)
class Line:
    """The genomes of a line, oldest first."""

    organism: int
    world: int
    generations: int
    genomes: int
    """number of different genomes of the line; the steps are a sample of them"""
    steps: list[Step]
    migrations: int | None = None
    """number of births of the line on another island than the parent's; None if the world has no
    islands"""

    @property
    def good(self) -> Step:
        """The earliest good genome after which all genomes are good, too; see GOOD."""
        return self._good_from("reborn")

    @property
    def good_parts(self) -> dict[str, Step]:
        """The same for `brain` and `body`, each with the last organism's other part; {} if bodies are
        the same."""
        return {} if self.spans("body") is None else {part: self._good_from(part) for part in PARTS}

    def spans(self, part: str) -> np.ndarray | None:
        """Return ticks lived, float64 (steps,), by a field of `Step`; None if bodies are the same."""
        found = np.array([getattr(step, part) for step in self.steps], float)
        return None if np.isnan(found).any() else found

    def _good_from(self, part: str) -> Step:
        spans = self.spans(part)
        assert spans is not None
        below = np.flatnonzero(spans < GOOD * spans[-1])
        return self.steps[below[-1] + 1 if len(below) else 0]

    @property
    def largest(self) -> tuple[Step, Step] | None:
        """Neighbouring steps between which lifespan grew by the largest factor; None if it never grew."""
        pairs = list(zip(self.steps, self.steps[1:], strict=False))
        grown = [pair for pair in pairs if pair[1].reborn > pair[0].reborn]
        return max(grown, key=lambda pair: pair[1].reborn / pair[0].reborn, default=None)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        largest = None if self.largest is None else [step.organism for step in self.largest]
        names = "organism", "world", "generations", "genomes"
        values = {name: getattr(self, name) for name in names}
        if self.migrations is not None:
            values["migrations"] = self.migrations
        values["steps"] = [step.to_dict() for step in self.steps]
        values |= {"good_from": self.good.organism, "largest_step": largest}
        parts = {f"{part}_good_from": step.organism for part, step in self.good_parts.items()}
        return values | parts


def line(
    run: Records,
    organism: int,
    world: int = 0,
    most: int = MOST,
    games: int = GAMES,
    ticks: int = TICKS,
    habitat: Mapping[str, Any] | None = None,
) -> Line:
    """Let the ancestors of an organism live again, all in the same games.

    Copies have their parent's genome, so only founders, mutants and children of two parents live again.
    The line of a fork's organism begins with the oldest ancestor in the fork's records.

    Args:
        run: the organism's run, or its arm.
        organism: birth number.
        world: the organism's world.
        most: largest number of genomes that live again. These are evenly spaced over the line, from the
            line's first genome to its last.
        games: number of games of each genome; 1 if the habitat draws nothing at random.
        ticks: number of ticks after which a game is cut.
        habitat: changed settings of the habitat.

    Raises:
        InputError: no such organism was born, or the habitat has no such setting.
    """
    rows = descent(run.lives, organism, world)
    changed = _changed(run, rows)
    chosen = changed[series.places(len(changed), most)]
    subject = of_run(run, [(organism, world)], habitat)
    same = subject.players.take(np.zeros(len(chosen), int))
    lived = {
        part: lifespans_in_games(same._replace(genomes=own), subject.games(games), ticks).mean(
            axis=1
        )
        for part, own in _parts(run, pedigree.genomes(run, rows[chosen])).items()
    }
    lives = run.lives.take(rows[chosen])
    homes = names_of(run.config.islands, run.lives.cell[rows])
    moved = None if homes is None else sum(map(ne, homes[1:], homes))
    steps = [
        Step(
            generation=int(generation),
            organism=int(lives.id[k]),
            born=int(lives.born[k]),
            birth_cause=BirthCause(lives.birth_cause[k]).label,
            recorded=int(lives.lifespan[k]),
            island=None if homes is None else homes[generation],
            **{part: float(spans[k]) for part, spans in lived.items()},
        )
        for k, generation in enumerate(chosen)
    ]
    return Line(organism, world, len(rows) - 1, len(changed), steps, moved)


def _parts(run: Records, genomes: np.ndarray) -> dict[str, np.ndarray]:
    """Return the genomes of a line (K, P), and those with the last body and with the last brain."""
    if not (genes := run.layout.genes):
        return {"reborn": genomes}
    last = genomes[-1:]
    brains = np.concatenate([genomes[:, :-genes], np.repeat(last[:, -genes:], len(genomes), 0)], 1)
    bodies = np.concatenate([np.repeat(last[:, :-genes], len(genomes), 0), genomes[:, -genes:]], 1)
    return {"reborn": genomes, "brain": brains, "body": bodies}


def _changed(run: Records, rows: np.ndarray) -> np.ndarray:
    """Return 0 and the indices at which the genome changed in a line of descent; `rows` is (D,)."""
    lives = run.lives.take(rows)
    changed = (lives.birth_cause != BirthCause.COPY) | (run.mates_of(lives) >= 0)
    changed[0] = True
    return np.flatnonzero(changed)
