"""Keep the genome of the best organism of every world of an experiment.

    python experiments/champions.py experiments/atari/*.toml experiments/robots/*.toml

For experiments that have been run (`experiments/run.py`): one genome from each world of the reference, to
`genomes/` beside the file. Whose, `experiments/games.py` has found out among all that are alive; where it
has not, the longest-lived's. `primordia run TASK --ancestor FILE --genesis fill` begins with them.
"""

import csv
from collections.abc import Iterable
from pathlib import Path

import files
from games import BEST, longest_lived

from primordia.brains import genomes
from primordia.history.lineage import rebuild_all
from primordia.organism.organism import Organism
from primordia.runs.archive import Archive


def report(file: Path) -> None:
    """Write the genomes, in the order of worlds."""
    run = Archive(files.runs(file)[0])
    config, champions = run.config, best_known(file, run)
    about = {
        "task": config.task,
        "seeds": words(config.seed + each.world for each in champions),
        "organisms": words(each.id for each in champions),
        "ages": words(each.age for each in champions),
    }
    path = file.parent / "genomes" / f"{file.stem}.safetensors"
    path.parent.mkdir(exist_ok=True)
    kept = rebuild_all(run, [(each.id, each.world) for each in champions])
    genomes.write(path, run.law.layout, kept, about)
    print(path)


def best_known(file: Path, run: Archive) -> list[Organism]:
    """Of each world."""
    games = file.parent / "results" / f"{file.stem}-games.csv"
    rows = csv.DictReader(games.read_text().splitlines()) if games.exists() else []
    found = {
        int(r["world"]): int(r["organism"]) for r in rows if r["who"] == BEST.format(run.path.name)
    }
    if not found:
        return longest_lived(run.path)
    return [Organism(run, run.lives.row(found[world], world)) for world in sorted(found)]


def words(numbers: Iterable[int]) -> str:
    """As metadata can hold them."""
    return " ".join(map(str, numbers))


if __name__ == "__main__":
    files.each(report, __doc__)
