"""Keep the genome of the longest-lived organism of every world of an experiment.

    python experiments/champions.py experiments/atari/*.toml

For experiments that have been run (`experiments/run.py`): one genome from each world of the reference, to
`genomes/` beside the file. `primordia run TASK --ancestor FILE --genesis fill` begins a world with them.
"""

from collections.abc import Iterable
from pathlib import Path

import files
import numpy as np
from games import longest_lived

from primordia.disk import genomes
from primordia.disk.directory import read_config


def report(file: Path) -> None:
    """Write the genomes, in the order of worlds."""
    run = files.runs(file)[0]
    config, champions = read_config(run), longest_lived(run)
    about = {
        "task": config.task,
        "seeds": words(config.seed + each.world for each in champions),
        "organisms": words(each.id for each in champions),
        "ages": words(each.age for each in champions),
    }
    path = file.parent / "genomes" / f"{file.stem}.safetensors"
    path.parent.mkdir(exist_ok=True)
    brain = config.build_brain(config.build_habitat())
    genomes.write(path, brain, np.stack([each.genome() for each in champions]), about)
    print(path)


def words(numbers: Iterable[int]) -> str:
    """As metadata can hold them."""
    return " ".join(map(str, numbers))


if __name__ == "__main__":
    files.each(report, __doc__)
