"""Hold the arms of experiments against their neutral shadows.

    python experiments/shadows.py experiments/cartpole/heredity.toml

The experiments must have been run (`primordia experiment`). In each world some organisms, evenly spaced
over its births, live once more. So do their shadows: the same pedigree with founders and mutations drawn
again (`primordia shadow`). The table goes to `results/` beside the file, as Markdown and CSV.
"""

from pathlib import Path
from typing import Any

import named
import numpy as np
from games import write_rows

import primordia
from primordia.assays.shadow import Shadow
from primordia.comparison.tables import number_text
from primordia.experiments.results import table

ORGANISMS = 20
"""organisms of a world"""
HEAD = (
    *("", "worlds", "births", "organisms", "mean life", "mean life of shadows", "reach the cut"),
    *("shadows that reach it", "worlds longer", "worlds shorter", "p", "times as long"),
)


def report(file: Path) -> None:
    """Let the arms of an experiment and their shadows live, and write the table."""
    lines, rows, found = [], [], None
    for folder in named.arms(file):
        found = primordia.load(folder).shadow(ORGANISMS)
        lines.append(line(found))
        rows += worlds_of(found, primordia.load(folder).opened().world_seeds)
        print(f"{folder.name}: done", flush=True)
    assert found is not None
    note = (
        "Organisms are evenly spaced over the births of their world but the last. Lives were cut at"
        f" {found.cut:,} ticks. Worlds longer: those in which originals live longer than their shadows."
        " P: sign test over worlds. Times as long: mean life of originals over that of shadows, in the"
        " median world (95 % interval over worlds)."
    )
    stem = file.parent / "results" / f"{file.stem}-shadow"
    write_rows(stem, rows, f"{table(list(HEAD), lines)}\n\n{note}")


def line(found: Shadow) -> list[Any]:
    """Return the row of an arm."""
    values, ratio = found.to_dict(), f"{found.ratio:.2f}"
    lines = values["original"], values["shadow"]
    if found.ratio_interval is not None:
        low, high = found.ratio_interval
        ratio += f" ({low:.2f} to {high:.2f})"
    return [
        found.name,
        *(f"{values[name]:,}" for name in ("worlds", "births", "organisms")),
        *(number_text(each["mean"]) for each in lines),
        *(f"{each['reached_cut']:,}" for each in lines),
        *found.longer,
        f"{found.p:.2g}",
        ratio,
    ]


def worlds_of(found: Shadow, seeds: np.ndarray) -> list[dict[str, Any]]:
    """Return a row for each world: the mean life of both lines."""
    return [
        {
            "arm": found.name,
            "seed": int(seed),
            "mean_life": round(one, 2),
            "of_shadows": round(other, 2),
        }
        for seed, one, other in zip(seeds[np.unique(found.world)], *found.means, strict=True)
    ]


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
