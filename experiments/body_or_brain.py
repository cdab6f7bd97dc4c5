"""Which became good first, the body or the brain? Lines of descent whose brains and bodies live apart.

    python experiments/body_or_brain.py experiments/bodies/pole-length.toml

The experiment must have been run (`primordia experiment`). In each world in which bodies evolve, the
ancestors of the champion (the longest-lived of the later half of all births) live again, GAMES games of
at most TICKS ticks (`primordia assay line`). So do their brains, each in the champion's body, and their
bodies, each with the champion's brain. A table and a figure go to `results/` beside the file.
"""

from pathlib import Path

import named
import pandas as pd
from by_world import Row, dots, illustrate, measure
from matplotlib.figure import Figure

from primordia.assays.line import line
from primordia.comparison.pairs import sign_test
from primordia.experiments.results import table
from primordia.figures import style
from primordia.history.islands import oldest
from primordia.runs.records import Records

GAMES, TICKS = 3, 5_000
LIVES = {
    "first genome": style.SOFT,
    "first brain, last body": style.GREEN,
    "last brain, first body": style.VERMILION,
    "last genome": style.BLUE,
}
"""What lives, and its colour."""
BRAIN, BODY = "brain good from", "body good from"
NOTE = (
    "Ticks that the first and the last genome of the champion's line live, with their own parts and with"
    f" exchanged ones, in games of at most {TICKS:,} ticks. Good from: the birth number from which on all"
    " brains of the line live at least nine tenths as long as the last genome, in its body; and all"
    " bodies, with its brain."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment in which bodies evolve, and write the table and the figure."""
    illustrate(measure(file, "body-or-brain", rows_of, NOTE), drawn, signs)


def rows_of(run: Records) -> list[Row]:
    """Return a row for each world; none if bodies do not evolve."""
    if not run.config.mutation["blocks"]["body"]["scale"]:
        return []
    found = []
    for world in range(run.config.seeds):
        champion = int(run.lives.id[oldest(run, world)])
        own = line(run, champion, world, games=GAMES, ticks=TICKS)
        lived = pd.DataFrame([step.to_dict() for step in own.steps])
        spans = [*lived.loc[0, ["reborn", "brain", "body"]], lived["reborn"].iloc[-1]]
        row: Row = {"seed": int(run.world_seeds[world])}
        row |= {name: round(float(span), 1) for name, span in zip(LIVES, spans, strict=True)}
        good = {part: step.organism for part, step in own.good_parts.items()}
        found.append({**row, BRAIN: good["brain"], BODY: good["body"]})
    return found


def signs(rows: pd.DataFrame) -> str:
    """Return a table: in how many worlds of each arm the body, or the brain, was good first."""
    lines: list[list] = []
    for arm, worlds in rows.groupby("arm", sort=False):
        body, brain = (int(each.sum()) for each in _order(worlds))
        at_once = len(worlds) - body - brain
        lines.append([arm, len(worlds), body, brain, at_once, f"{sign_test(body, brain):.2g}"])
    head = ["arm", "worlds", "body first", "brain first", "by one birth", "p (sign test)"]
    return table(head, lines)


def _order(worlds: pd.DataFrame) -> tuple[pd.Series, pd.Series]:
    """Return in which worlds the body was good first, and in which the brain."""
    return worlds[BODY] < worlds[BRAIN], worlds[BODY] > worlds[BRAIN]


def drawn(rows: pd.DataFrame) -> Figure:
    """Draw how long first and last genomes live, with their own parts and with exchanged ones."""
    arms = list(dict.fromkeys(rows["arm"]))
    figure = Figure(figsize=(style.PAGE, 2.8))
    axes = figure.subplots()
    columns = [[rows.loc[rows["arm"] == arm, name] for name in LIVES] for arm in arms]
    dots(axes, arms, columns, [*LIVES.values()])
    style.logarithmic(axes.yaxis)
    axes.set_ylabel("ticks lived")
    style.title(axes, "First and last genomes of the champions' lines", LIVES)
    return figure


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
