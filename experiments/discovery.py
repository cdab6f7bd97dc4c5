"""When has an organism of a world first lived long?

    python experiments/discovery.py experiments/learning/baldwin.toml

The experiment must have been run (`primordia experiment`). A life is long if it has `saturation_ticks`.
The table goes to `results/` beside the file, as Markdown and CSV.
"""

from pathlib import Path

import named
from by_world import Row, measure

from primordia.runs.records import Records

NOTE = (
    "Of each world: the tick at which an organism has first lived long, and all births until then."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table."""
    measure(file, "discovery", worlds_of, NOTE)


def worlds_of(run: Records) -> list[Row]:
    """Return a row for each world; its values are infinite if no life was long."""
    rows, age = [], run.config.saturation_ticks
    for seed, lives in zip(run.world_seeds, run.lives.by_world(), strict=True):
        born = lives.born[lives.lifespan >= age]
        tick = int(born.min()) + age if len(born) else float("inf")
        births = int((lives.born <= tick).sum()) if len(born) else float("inf")
        rows.append({"seed": int(seed), "tick": tick, "births": births})
    return rows


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
