"""One organism of a run: its record, and all that can be derived from the record."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from operator import index
from pathlib import Path
from typing import Any, SupportsIndex

import numpy as np

from primordia.errors import InputError
from primordia.history import pedigree
from primordia.history.islands import names_of
from primordia.history.rebuilding import descent
from primordia.law.world import BirthCause, Cause
from primordia.organism.playing.evaluation import Evaluation, evaluate
from primordia.organism.policy import Policy
from primordia.organism.reliving.compare import Reliving, relive
from primordia.organism.reliving.replay import replay
from primordia.runs.lives import Lives
from primordia.runs.records import Records


@dataclass(frozen=True)
class Organism:
    """An organism, living or dead."""

    run: Records
    row: int
    """row in the run's lives"""

    def __repr__(self) -> str:
        end = self.cause or "alive"
        return (
            f"<organism {self.id} of world {self.world}: born {self.born}, age {self.age}, {end}>"
        )

    @property
    def lives(self) -> Lives:
        """All lives of the run."""
        return self.run.lives

    @property
    def id(self) -> int:
        """Birth number within the world."""
        return int(self.lives.id[self.row])

    @property
    def world(self) -> int:
        """Number of the world."""
        return int(self.lives.world[self.row])

    @property
    def parent(self) -> int | None:
        """Birth number of the parent; None for a founder."""
        parent = int(self.lives.parent[self.row])
        return None if parent < 0 else parent

    @property
    def cell(self) -> int:
        """Number of the cell within the world."""
        return int(self.lives.cell[self.row])

    @property
    def island(self) -> str | None:
        """Name of the island on which it was born and lives; None if its world has no islands."""
        names = names_of(self.run.config.islands, self.lives.cell[[self.row]])
        return None if names is None else names[0]

    @property
    def birth_cause(self) -> str:
        """`founder`, `copy` or `mutant`."""
        return BirthCause(self.lives.birth_cause[self.row]).label

    @property
    def born(self) -> int:
        """Tick of birth."""
        return int(self.lives.born[self.row])

    @property
    def age(self) -> int:
        """Ticks lived so far."""
        return int(self.lives.lifespan[self.row])

    @property
    def cause(self) -> str | None:
        """Cause of death; None for a living organism."""
        cause = self.lives.cause[self.row]
        return Cause(cause).label if self.lives.died[self.row] else None

    def descent(self) -> list[int]:
        """Return the birth numbers of the organism's ancestors, founder first, then its own number."""
        return [int(self.lives.id[row]) for row in descent(self.lives, self.id, self.world)]

    def genome(self) -> np.ndarray:
        """Return the weights, float32 (P,), rebuilt from the records."""
        return pedigree.genomes(self.run, np.array([self.row]))[0]

    def policy(self) -> Policy:
        """Return the brain as `policy(senses) -> action`."""
        return Policy(self.run.law, self.genome())

    def evaluate(self, **options: Any) -> Evaluation:
        """Let the organism play games; see `evaluation.evaluate`."""
        return evaluate(self.run, [(self.id, self.world)], **options)[0]

    def replay(
        self,
        out: str | Path | None = None,
        ages: tuple[int | None, int | None] = (None, None),
        beside: Sequence["int | Organism"] = (),
    ) -> Path:
        """Make a video of the organism's life, or of several lives. Return the file; see
        `replay.replay`.

        Args:
            out: an .mp4 or .gif file.
            ages: first and last age shown.
            beside: others whose lives are shown too: birth numbers in the same world, or organisms of
                any run.
        """
        path = Path(out) if out is not None else None
        others = [
            each if isinstance(each, int) else (each.run, each.id, each.world) for each in beside
        ]
        return replay(self.run, self.id, self.world, path, ages, beside=others)

    def relive(
        self,
        since: int | None = None,
        save: str | Path | None = None,
        film: str | Path | None = None,
    ) -> Reliving:
        """Live the organism's life again and compare it with the record; see `compare.relive`."""
        save, film = (None if each is None else Path(each) for each in (save, film))
        return relive(self.run, self.id, self.world, since=since, save=save, film=film)


def numbers_of(
    run: Records, organisms: Iterable[Organism | int], world: int = 0
) -> list[tuple[int, int]]:
    """Return birth number and world of each organism; birth numbers are those of the given world.

    Raises:
        InputError: an organism is one of another run, or was not born, or is none.
    """
    found, here = [], [path.resolve() for path in run.paths]
    for each in organisms:
        if isinstance(each, SupportsIndex):
            run.lives.row(index(each), world)  # raises if it was not born
            found.append((index(each), world))
        elif not hasattr(each, "run"):
            raise InputError(f"{each!r} is neither an organism nor a birth number")
        elif [path.resolve() for path in each.run.paths] == here:
            found.append((each.id, each.world))
        else:
            raise InputError(f"organism {each.id} is one of {each.run.path}, and not of {run.path}")
    return found
