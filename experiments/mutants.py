"""How large may a mutation be? Lives of mutants of the champion of every world.

    python experiments/mutants.py experiments/atari/*.toml

The experiments must have been run (`primordia experiment`), in tasks that draw nothing at random, so that
a genome has one lifespan. The champion of each world of the reference gets mutants of several scales,
with noise on every weight. Each mutant lives once. The table goes to `results/` beside the file, as
Markdown and CSV.
"""

from pathlib import Path
from typing import Any

import named
import numpy as np
from founders import per_weight
from games import write_rows

import primordia
from primordia.experiments.results import table
from primordia.organism.evaluation import players_of
from primordia.organism.games import play
from primordia.organism.organism import Organism

MUTANTS = 24
SCALES = (0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1)
"""standard deviations of the noise, as shares of the founders' scale"""
TICKS = 20_000
SAME = 2
"""difference in ticks up to which two lives count as equal"""
SHARES = ("as long", "longer", "longer by a tenth", "shorter by a third")


def report(file: Path) -> None:
    """Let mutants live and write the table."""
    reference = primordia.load(named.arms(file)[0])
    rows = [row for organism in reference.champions() for row in mutants_of(organism)]
    write_rows(file.parent / "results" / f"{file.stem}-mutants", rows, summary(rows))


def mutants_of(organism: Organism) -> list[dict[str, Any]]:
    """Let mutants of an organism live and return a row for each scale."""
    own = (organism.id, organism.world)
    itself, noise = players_of(organism.run, [own]), np.random.default_rng(0)
    lifespan = play(itself, 1, TICKS).ticks[0, 0]
    same, rows = itself.take(np.zeros(MUTANTS, int)), []
    spread = per_weight(same.law, "founder_scale")
    for scale in SCALES:
        steps = scale * spread * noise.standard_normal(same.genomes.shape)
        genomes = (same.genomes + steps).astype(np.float32)
        ticks = play(same._replace(genomes=genomes), 1, TICKS).ticks[:, 0]
        row = {
            "world": organism.world,
            "organism": organism.id,
            "lifespan": lifespan,
            "scale": scale,
        }
        row |= dict(zip(SHARES, shares(ticks, lifespan), strict=True))
        rows.append({**row, "median": np.median(ticks), "longest": ticks.max()})
        print(*rows[-1].values(), flush=True)
    return rows


def shares(ticks: np.ndarray, own: int) -> list[float]:
    """Return each of SHARES for mutants that live `ticks` and a parent that lives `own` ticks."""
    equal = abs(ticks - own) <= SAME
    groups = (equal, ~equal & (ticks > own), ticks > 1.1 * own, ticks < own * 2 / 3)
    return [round(float(group.mean()), 3) for group in groups]


def summary(rows: list[dict[str, Any]]) -> str:
    """Return a table of medians over worlds."""
    columns = (*SHARES, "median", "longest")
    lines = []
    for scale in SCALES:
        of_scale = [row for row in rows if row["scale"] == scale]
        lines.append([scale, *(f"{np.median([row[c] for row in of_scale]):,.4g}" for c in columns)])
    parents = sorted({(row["world"], int(row["lifespan"])) for row in rows})
    note = (
        f"Medians over {len(parents)} worlds of {MUTANTS} mutants each of the organism that lived longest"
        f" ({', '.join(f'{ticks:,}' for _, ticks in parents)} ticks; mutants were cut at {TICKS:,})."
        " Scales are of the founders' scale."
    )
    return f"{table(['scale', *columns], lines)}\n\n{note}"


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
