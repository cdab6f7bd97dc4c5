"""One organism of a run: what is recorded of it, and all that follows from that."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from primordia.history.lineage import descent, rebuild
from primordia.law.world import BirthCause, Cause
from primordia.organism.evaluation import Evaluation, evaluate
from primordia.organism.policy import Policy
from primordia.organism.replay import replay as show
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives


@dataclass(frozen=True)
class Organism:
    """An organism that lives or has lived."""

    run: Archive
    row: int
    """of the run's lives"""

    def __repr__(self) -> str:
        end = self.cause or "alive"
        return (
            f"<organism {self.id} of world {self.world}: born {self.born}, age {self.age}, {end}>"
        )

    @property
    def everyone(self) -> Lives:
        """All lives of the run."""
        return self.run.lives

    @property
    def id(self) -> int:
        """Birth number within its world."""
        return int(self.everyone.id[self.row])

    @property
    def world(self) -> int:
        """Where it lived."""
        return int(self.everyone.world[self.row])

    @property
    def parent(self) -> int | None:
        """Birth number of the parent; None if it came from nothing."""
        parent = int(self.everyone.parent[self.row])
        return None if parent < 0 else parent

    @property
    def cell(self) -> int:
        """Where in its world."""
        return int(self.everyone.cell[self.row])

    @property
    def birth_cause(self) -> str:
        """`founder`, `copy` or `mutant`."""
        return BirthCause(self.everyone.birth_cause[self.row]).label

    @property
    def born(self) -> int:
        """Tick."""
        return int(self.everyone.born[self.row])

    @property
    def age(self) -> int:
        """Ticks lived, in all or so far."""
        return int(self.everyone.lifespan[self.row])

    @property
    def cause(self) -> str | None:
        """Of its death; None if it is alive."""
        cause = self.everyone.cause[self.row]
        return Cause(cause).label if self.everyone.died[self.row] else None

    def descent(self) -> list[int]:
        """Birth numbers from its founder down to itself."""
        return [int(self.everyone.id[row]) for row in descent(self.everyone, self.id, self.world)]

    def genome(self) -> np.ndarray:
        """Its weights, float32 (P,), rebuilt from the records."""
        return rebuild(self.run, self.id, self.world)

    def policy(self) -> Policy:
        """Its brain by itself."""
        return Policy(self.run.law, self.genome())

    def evaluate(self, **options: Any) -> Evaluation:
        """How it does in whole games; see `evaluation.evaluate`."""
        return evaluate(self.run, [(self.id, self.world)], **options)[0]

    def replay(
        self, out: str | Path | None = None, ages: tuple[int | None, int | None] = (None, None)
    ) -> Path:
        """Its life on video -> the file; see `replay.replay`."""
        return show(self.run, self.id, self.world, Path(out) if out is not None else None, ages)
