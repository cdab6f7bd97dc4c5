"""What do mutations do to the longest-lived founders of tasks? Six fixed sizes, and calibrated ones.

    python experiments/effects.py Pong-survival Boxing-survival-fight

Nothing has to be run before. Of each task 512 founders live once. Mutants of the 16 longest-lived
live in the games of their parents (`primordia assay effects TASK`). The parents were chosen in another
game. When the committed tables were made, that game was one of the five
(`docs/explanation/heredity.md`). The tables go to `results/` of the folder `mutation` beside this file:
all organisms as CSV, a summary as Markdown.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
from games import write_rows

from primordia.assays.effects import SCALES, effects
from primordia.assays.subjects import of_task
from primordia.comparison.resample import interval, resamples
from primordia.experiments.results import table

RESULTS = Path(__file__).parent / "mutation" / "results"
DIFFERS = (0.0, 0.02, 0.05, 0.1)
TICKS = 5_000
SHARES = {
    "as_long": "as long",
    "longer": "longer",
    "tenth_longer": "a tenth longer",
    "third_shorter": "a third shorter",
}


def report(task: str) -> None:
    """Let mutants of a task's founders live and write the tables."""
    found = effects(of_task(task), SCALES, DIFFERS, ticks=TICKS)
    rows = pd.DataFrame([each.to_dict() for each in found])
    write_rows(RESULTS / task.lower(), rows.to_dict("records"), summary(task, rows))


def summary(task: str, rows: pd.DataFrame) -> str:
    """Return a table of mean shares over founders, with intervals over resampled founders."""
    mutations = list(dict.fromkeys(rows.mutation))
    shares = {
        name: np.array([rows[rows.mutation == each][name] for each in mutations]) for name in SHARES
    }
    lines = [
        [mutation, *(mean_text(shares[name][place]) for name in SHARES), ""]
        for place, mutation in enumerate(mutations)
    ]
    for place, mutation in enumerate(mutations):
        if mutation.startswith("differs"):
            lines[place][-1] = against_scales(shares, mutations, place)
    lived = rows[rows.mutation == mutations[0]].lifespan
    note = (
        f"{task}: {rows.mutants[0]} mutants of each of {len(lived)} founders, the longest-lived of 512"
        f" ({lived.min():,.0f} to {lived.max():,.0f} ticks; games were cut at {TICKS:,}). Mean shares"
        " over founders (95 % interval over resampled founders). Scales are of the standard deviation of"
        " founders' weights; differs is that of a calibrated mutation. The last column holds its share of"
        " a tenth longer against that of the scale, between those tried, at which as many live as long."
    )
    head = ["mutation", *SHARES.values(), "a tenth longer, against a scale"]
    return f"{table(head, lines)}\n\n{note}"


def against_scales(shares: dict[str, np.ndarray], mutations: list[str], place: int) -> str:
    """Return how many more mutants live a tenth longer than by a scale at which as many live as long."""
    scales = [k for k, mutation in enumerate(mutations) if mutation.startswith("scale")]

    def difference(rows: np.ndarray) -> np.ndarray:
        same, more = (shares[name][:, rows].mean(axis=-1) for name in ("as_long", "tenth_longer"))
        return np.array(
            [
                above[place]
                - np.interp(unchanged[place], *ordered(unchanged[scales], above[scales]))
                for unchanged, above in zip(same.T, more.T, strict=True)
            ]
        )

    count = shares["as_long"].shape[1]
    own = difference(np.arange(count)[None])[0]
    low, high = interval(np.concatenate([difference(rows) for rows in resamples(count)]))
    return f"{own:+.3f} ({low:+.3f} to {high:+.3f})"


def ordered(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return points in the order of x; of equal x, the largest y comes last and counts."""
    order = np.lexsort((y, x))
    return x[order], y[order]


def mean_text(shares: np.ndarray) -> str:
    """Return the mean, and its interval over resampled organisms."""
    means = np.concatenate([shares[rows].mean(axis=1) for rows in resamples(len(shares))])
    low, high = interval(means)
    return f"{shares.mean():.3f} ({low:.3f} to {high:.3f})"


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for name in sys.argv[1:]:
        report(name)
