"""Keep the genome of the champion of every world of an experiment.

    python experiments/champions.py experiments/atari/*.toml experiments/robots/*.toml

The experiments must have been run (`primordia experiment`). One genome from each world of the reference
goes to `genomes/` beside the file: that of the longest-lived organism born in the later half of the
births. `primordia run TASK --ancestor FILE --genesis fill` starts a run from these genomes.
"""

from collections.abc import Iterable
from pathlib import Path

import named
import numpy as np

import primordia
from primordia.brains import genomes
from primordia.history import pedigree


def report(file: Path) -> None:
    """Write the genomes of the champions of an experiment, in the order of worlds."""
    arm = primordia.load(named.arms(file)[0])
    run, champions = arm.opened(), arm.champions()
    about = {
        "task": run.config.task,
        "seeds": words(run.world_seeds[organism.world] for organism in champions),
        "organisms": words(organism.id for organism in champions),
        "ages": words(organism.age for organism in champions),
    }
    path = file.parent / "genomes" / f"{file.stem}.safetensors"
    path.parent.mkdir(exist_ok=True)
    rows = np.array([run.lives.row(organism.id, organism.world) for organism in champions])
    genomes.write(path, run.layout, pedigree.genomes(run, rows), about)
    print(path)


def words(numbers: Iterable[int]) -> str:
    """Join numbers with spaces: metadata holds text only."""
    return " ".join(map(str, numbers))


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
