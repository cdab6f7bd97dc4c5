"""Let kept genomes play games that chose none of them.

    python experiments/kept.py experiments/robots/genomes/halfcheetah-ratchet.safetensors

The genomes begin a world of their own, of a seed that no other world has. Each plays fresh games: seeing,
with frozen senses, and blindly. The table goes to `results/` beside the folder, as Markdown and CSV.
"""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import named
from games import WAYS, write_rows

import primordia
from primordia.brains import genomes
from primordia.comparison.tables import number_text
from primordia.experiments.results import table

SEED = 9_000
GAMES, TICKS = 20, 8_000
OUTCOMES = ("lifespan", "score")


def report(kept: Path) -> None:
    """Let the genomes of a file play, and write the table."""
    about = genomes.about(kept)
    count = len(about["seeds"].split())
    start = {"ancestors": (str(kept),), "genesis": "fill", "cells": count, "seed": SEED}
    with TemporaryDirectory() as folder:
        stop = {"until": "none", "ticks": 1}
        run = primordia.run(about["task"], Path(folder) / "run", {**start, "stop": stop})
        rows = [
            row
            for way, options in WAYS[str(run.opened().config.habitat["name"])].items()
            for row in played(run, way, about["seeds"].split(), options)
        ]
    lines = [[row["seed"], row["way"], *(spread(row, name) for name in OUTCOMES)] for row in rows]
    note = (
        f"Medians (quartiles) of {GAMES} fresh games of each kept genome, of a world by its seed. None of"
        f" these games chose a genome. Games were cut after {TICKS:,} ticks."
    )
    text = f"{table(['world', 'plays', *OUTCOMES], lines)}\n\n{note}"
    write_rows(kept.parent.parent / "results" / f"{kept.stem}-kept", rows, text)


def played(
    run: primordia.Run, way: str, seeds: list[str], options: dict[str, Any]
) -> list[dict[str, Any]]:
    """Let each genome play in one way, and return a row for each."""
    found = run.evaluate(
        (run.organism(number) for number in range(len(seeds))), games=GAMES, ticks=TICKS, **options
    )
    rows = []
    for seed, each in zip(seeds, found, strict=True):
        values, row = each.to_dict(), {"seed": seed, "way": way, "games": each.games}
        for name in OUTCOMES:
            quartiles = {f"{name}_{part}": values[name][part] for part in ("median", "q1", "q3")}
            row |= {part: round(value, 2) for part, value in quartiles.items()}
        rows.append(row)
    return rows


def spread(row: dict[str, Any], name: str) -> str:
    """Write the median and the quartiles over games."""
    median, q1, q3 = (number_text(row[f"{name}_{part}"]) for part in ("median", "q1", "q3"))
    return f"{median} ({q1} to {q3})"


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
