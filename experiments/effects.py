"""What do mutations do to the longest-lived founders of tasks? Six fixed sizes, and calibrated ones.

    python experiments/effects.py Pong-survival Boxing-survival-fight

Nothing has to be run before. Of each task 512 founders live once. Mutants of the 16 longest-lived
live in the games of their parents (`primordia assay effects TASK`). The tables go to `results/` of the
folder `mutation` beside this file: all organisms as CSV, a summary as Markdown.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from games import write_rows

from primordia.assays.effects import SCALES, Effect, effects
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
    rows = [each.to_dict() for each in found]
    write_rows(RESULTS / task.lower(), rows, summary(task, found))


def summary(task: str, found: list[Effect]) -> str:
    """Return a table of mean shares over founders, with intervals over resampled founders."""
    mutations = list(dict.fromkeys(each.mutation for each in found))
    of_each = {
        mutation: [each for each in found if each.mutation == mutation] for mutation in mutations
    }
    lines = [
        [mutation, *(mean_text([getattr(each, name) for each in own]) for name in SHARES)]
        for mutation, own in of_each.items()
    ]
    own = of_each[mutations[0]]
    lived = sorted(each.lifespan for each in own)
    note = (
        f"{task}: {len(own[0].mutants)} mutants of each of {len(own)} founders, the longest-lived of 512"
        f" ({lived[0]:,.0f} to {lived[-1]:,.0f} ticks; games were cut at {TICKS:,}). Mean shares over"
        " founders (95 % interval over resampled founders). Scales are of the standard deviation of"
        " founders' weights; differs is that of a calibrated mutation."
    )
    return f"{table(['mutation', *SHARES.values()], lines)}\n\n{note}"


def mean_text(shares: Sequence[float]) -> str:
    """Return the mean, and its interval over resampled organisms."""
    values = np.array(shares)
    means = np.concatenate([values[rows].mean(axis=1) for rows in resamples(len(values))])
    low, high = interval(means)
    return f"{values.mean():.3f} ({low:.3f} to {high:.3f})"


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for name in sys.argv[1:]:
        report(name)
