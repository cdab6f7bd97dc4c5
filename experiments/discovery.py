"""When has an organism of a world first lived long?

    python experiments/discovery.py experiments/learning/baldwin.toml
    python experiments/discovery.py --ticks 7141 experiments/skill/boxing-alike.toml

The experiment must have been run (`primordia experiment`). A life is long if it has `--ticks`, which are
the `saturation_ticks` by default. The table goes to `results/` beside the file, as Markdown and CSV.
"""

import argparse
from functools import partial
from pathlib import Path

from by_world import Row, measure

from primordia.runs.records import Records

NOTE = (
    "Of each world: the tick at which an organism has first lived long, and the births until then, if"
    " there is such an organism; all births, the longest life, and how many lives were long."
)


def report(file: Path, ticks: int | None) -> None:
    """Measure all arms of an experiment, and write the table."""
    measure(file, "discovery", partial(worlds_of, ticks), NOTE)


def worlds_of(ticks: int | None, run: Records) -> list[Row]:
    """Return a row for each world. The first two values are "" if no life was long."""
    rows, age = [], ticks or run.config.saturation_ticks
    for seed, lives in zip(run.world_seeds, run.lives.by_world(), strict=True):
        born = lives.born[lives.lifespan >= age]
        tick = int(born.min()) + age if len(born) else ""
        births = int((lives.born <= tick).sum()) if len(born) else ""
        found = {"tick": tick, "births": births, "all births": len(lives)}
        longest = int(lives.lifespan.max())
        rows.append({"seed": int(seed), **found, "longest life": longest, "long lives": len(born)})
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--ticks", type=int)
    given = parser.parse_args()
    for each in given.files:
        report(each, given.ticks)
