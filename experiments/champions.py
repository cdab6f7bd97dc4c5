"""Keep the genome of the best organism of every world of an experiment.

    python experiments/champions.py experiments/atari/*.toml experiments/robots/*.toml

The experiments must have been run (`primordia experiment`). One genome from each world of the reference
goes to `genomes/` beside the file. The organism is the one that `experiments/games.py` found best among
all that are alive. If that script was not run, it is the longest-lived organism. `primordia run TASK
--ancestor FILE --genesis fill` starts a run from these genomes.
"""

import csv
from collections.abc import Iterable
from pathlib import Path

import named
from games import BEST, longest_lived

from primordia.brains import genomes
from primordia.history.lineage import rebuild_all
from primordia.organism.organism import Organism
from primordia.runs.opening import opened
from primordia.runs.records import Records


def report(file: Path) -> None:
    """Write the genomes of the champions of an experiment, in the order of worlds."""
    run = opened([named.arms(file)[0]])
    config, champions = run.config, best_known(file, run)
    about = {
        "task": config.task,
        "seeds": words(run.world_seeds[organism.world] for organism in champions),
        "organisms": words(organism.id for organism in champions),
        "ages": words(organism.age for organism in champions),
    }
    path = file.parent / "genomes" / f"{file.stem}.safetensors"
    path.parent.mkdir(exist_ok=True)
    kept = rebuild_all(run, [(organism.id, organism.world) for organism in champions])
    genomes.write(path, run.layout, kept, about)
    print(path)


def best_known(file: Path, run: Records) -> list[Organism]:
    """Return the best organism of each world that is known."""
    games = file.parent / "results" / f"{file.stem}-games.csv"
    rows = csv.DictReader(games.read_text().splitlines()) if games.exists() else []
    label = BEST.format(run.path.name)
    best = {int(row["world"]): int(row["organism"]) for row in rows if row["who"] == label}
    if not best:
        return longest_lived(run.path)
    return [Organism(run, run.lives.row(best[world], world)) for world in sorted(best)]


def words(numbers: Iterable[int]) -> str:
    """Join numbers with spaces: metadata holds text only."""
    return " ".join(map(str, numbers))


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
