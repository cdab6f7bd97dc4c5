"""Measure in every world of experiments what is inherited, and whether a good line persists.

    python experiments/assays.py experiments/atari/pong-forager.toml

The experiments must have been run (`primordia experiment`). The numbers are those of `primordia assay
heredity` and `primordia assay threshold`. The table goes to `results/` beside the file, as Markdown and
CSV, world by world.
"""

from pathlib import Path
from typing import Any

import named
from games import write_rows

import primordia
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table

COLUMNS = {
    "p": "p",
    "v": "v",
    "s": "s",
    "held": "s (1 - p (1 - v))",
    "slope": "slope of mutants",
    "selection": "selection",
    "transmission": "transmission",
}


def report(file: Path) -> None:
    """Measure the arms of an experiment and write the table."""
    rows, lines = [], []
    for folder in named.arms(file):
        own = rows_of(folder)
        rows += own
        spreads = (
            spread_text(float("nan") if each[name] is None else each[name] for each in own)
            for name in COLUMNS
        )
        lines.append([folder.name, len(own), *spreads])
    note = (
        "Medians over worlds (quartiles), among children of the later half of the births. P: share of"
        " children that mutate. V: share of good parents' mutants that live as long as the parent, over"
        " that of copies. S: ticks for each death of good parents' copies, over those of all. Slope: of"
        " a mutant's log lifespan on its parent's. Selection, transmission: terms of the Price equation."
    )
    head = ["", "worlds", *COLUMNS.values()]
    stem = file.parent / "results" / f"{file.stem}-assays"
    write_rows(stem, rows, f"{table(head, lines)}\n\n{note}")


def rows_of(folder: Path) -> list[dict[str, Any]]:
    """Return a row for each world of an arm."""
    run = primordia.load(folder)
    seeds = run.opened().world_seeds.tolist()
    return [
        {
            "arm": folder.name,
            "seed": seed,
            "p": rounded(limit.mutated),
            "v": rounded(limit.as_good),
            "s": rounded(limit.advantage),
            "held": rounded(limit.held),
            "slope": rounded(inherited.mutants.slope),
            "selection": rounded(inherited.selection),
            "transmission": rounded(inherited.transmission),
        }
        for seed, limit, inherited in zip(seeds, run.threshold(), run.heredity(), strict=True)
    ]


def rounded(value: float | None) -> float | None:
    """Return four significant digits of a number that is known."""
    return None if value is None else float(f"{value:.4g}")


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
