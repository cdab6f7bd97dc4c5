"""How large may a mutation be? Lives of mutants of the longest-lived organism of every world.

    python experiments/mutants.py experiments/atari/*.toml

For experiments that have been run (`experiments/run.py`), in tasks where nothing is drawn at random, so
that a genome has one lifespan. Of the reference's worlds, the organism that lived longest is given
mutants of several scales, every weight with noise; each lives once. The table goes to `results/` beside
the file, as Markdown and CSV.
"""

from pathlib import Path
from typing import Any

import files
import numpy as np
from games import longest_lived, write_rows

from primordia.organism.evaluation import players_of
from primordia.organism.games import play
from primordia.organism.organism import Organism
from results import table

MUTANTS = 24
SCALES = (0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1)
"""standard deviations of the noise, of the founders' scale"""
TICKS = 20_000
SAME = 2
"""ticks by which lives may differ and count as equal"""
SHARES = ("as long", "longer", "longer by a tenth", "shorter by a third")


def report(file: Path) -> None:
    """Let mutants live, and write what came out."""
    reference = files.runs(file)[0]
    rows = [row for organism in longest_lived(reference) for row in mutants_of(organism)]
    write_rows(file.parent / "results" / f"{file.stem}-mutants", rows, summary(rows))


def mutants_of(organism: Organism) -> list[dict[str, Any]]:
    """A row for each scale."""
    own = (organism.id, organism.world)
    itself, noise = players_of(organism.run, [own]), np.random.default_rng(0)
    lifespan = play(itself, 1, TICKS).ticks[0, 0]
    same, rows = itself.take(np.zeros(MUTANTS, int)), []
    for scale in SCALES:
        steps = scale * same.law.founder_scale * noise.standard_normal(same.genomes.shape)
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
    """Of mutants that live so long, where their parent does: each of SHARES."""
    equal = abs(ticks - own) <= SAME
    each = (equal, ~equal & (ticks > own), ticks > 1.1 * own, ticks < own * 2 / 3)
    return [round(float(which.mean()), 3) for which in each]


def summary(rows: list[dict[str, Any]]) -> str:
    """Medians over worlds."""
    columns = (*SHARES, "median", "longest")
    lines = []
    for scale in SCALES:
        mine = [row for row in rows if row["scale"] == scale]
        lines.append([scale, *(f"{np.median([row[c] for row in mine]):,.4g}" for c in columns)])
    parents = sorted({(row["world"], int(row["lifespan"])) for row in rows})
    note = (
        f"Medians over {len(parents)} worlds of {MUTANTS} mutants each of the organism that lived longest"
        f" ({', '.join(f'{ticks:,}' for _, ticks in parents)} ticks; mutants were cut at {TICKS:,})."
        " Scales are of the founders' scale."
    )
    return f"{table(['scale', *columns], lines)}\n\n{note}"


if __name__ == "__main__":
    files.each(report, __doc__)
