"""Are natives of islands in a row adapted to their home? Reciprocal transplants, and clines of weights.

    python experiments/adaptation.py experiments/archipelago/gravity.toml

The experiment must have been run (`primordia experiment`), and its islands are in the order of a physical
parameter. In each world EACH late-born natives of each island live again, alone, on every island, GAMES
games of at most TICKS ticks, without accidents; so do EACH founders. The far end of an island is the
first or the last island, whichever is farther.

A cline is a change of weights along the islands. Its strength in a block of weights is the share of the
variance among the natives that a straight line over the islands' numbers explains. Neutral shadows have
the natives' pedigree and as many mutations, but no selection. A table and a figure go to `results/`
beside the file.
"""

from pathlib import Path

import named
import numpy as np
import pandas as pd
from by_world import Row, dots, illustrate, measure
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.assays.transplant import Transplant, transplant
from primordia.comparison.pairs import sign_test
from primordia.experiments.results import table
from primordia.figures import style
from primordia.history import pedigree
from primordia.history.series import spaced
from primordia.history.traits import factors_of
from primordia.runs.records import Records

EACH, GAMES, TICKS = 20, 3, 5_000
LATE = 0.5
HOME, FAR, RATIO = "home", "far end", "home / far end"
FOREIGN, LOCAL, ADAPTED = "foreigners", "local / foreign", "adapted islands"
CLINE, SHADOW = "cline of", "shadow of"
NOTE = (
    f"Home, far end: ticks that {EACH} late-born natives of each island live there, means over islands"
    f" of at most {TICKS:,} ticks. Foreigners: ticks that natives of all other islands live on an island."
    " Local / foreign and home / far end are ratios of these means. Adapted islands: those on which"
    " natives live longer than foreigners. Cline of a block of weights: share of"
    " the variance among natives that a straight line along the islands explains; shadows are neutral."
    " Traits on the first and the last island: geometric means of factors."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table and the figure."""
    illustrate(measure(file, "adaptation", rows_of, NOTE), drawn, signs)


def rows_of(run: Records) -> list[Row]:
    """Return a row for each world."""
    rows = []
    for each in transplant(run, EACH, LATE, GAMES, TICKS):
        rows.append(
            {"seed": int(run.world_seeds[each.world]), **_lives(each), **_clines(run, each.world)}
        )
    return rows


def _lives(each: Transplant) -> Row:
    last, natives = len(each.islands) - 1, each.lived[:-1]
    far = [last if k <= last / 2 else 0 for k in range(last + 1)]
    home = np.diag(natives)
    others = natives.copy()
    np.fill_diagonal(others, np.nan)
    foreign, away = np.nanmean(others), natives[np.arange(last + 1), far].mean()
    found = {
        HOME: home.mean(),
        FAR: away,
        RATIO: home.mean() / away,
        FOREIGN: foreign,
        LOCAL: home.mean() / foreign,
        ADAPTED: (each.local_foreign > 1).sum(),
        "founders": each.lived[-1].mean(),
    }
    return {name: round(float(value), 3) for name, value in found.items()}


def _clines(run: Records, world: int) -> Row:
    """Return the strength of the cline in each block and in its shadow, and traits at both ends."""
    lives, islands = run.lives, run.config.islands
    late = np.flatnonzero(lives.late(LATE) & (lives.world == world))
    home = islands.of_cells(lives.cell[late])
    rows = np.concatenate([spaced(late[home == k], EACH) for k in range(islands.count)])
    place = islands.of_cells(lives.cell[rows]).astype(float)
    found: Row = {}
    for name, redrawn in ((CLINE, False), (SHADOW, True)):
        genomes = pedigree.genomes(run, rows, redrawn).astype(np.float64)
        blocks = run.layout.split(genomes)
        for block, weights in blocks.items():
            found[f"{name} {block}"] = round(_explained(place, weights.reshape(len(rows), -1)), 4)
    if (traits := run.config.traits) is not None:
        factors = factors_of(run, traits, rows)
        for number, trait in enumerate(traits.names):
            for end, island in (("first", 0), ("last", islands.count - 1)):
                mean = np.exp(np.log(factors[place == island, number]).mean())
                found[f"{trait}, {end} island"] = round(float(mean), 3)
    return found


def _explained(place: np.ndarray, weights: np.ndarray) -> float:
    """Return the share of the variance of weights (n, w) that a line over places (n,) explains."""
    x, y = place - place.mean(), weights - weights.mean(axis=0)
    total = np.square(y).sum()
    return float(np.square(x @ y).sum() / np.square(x).sum() / total) if total > 0 else 0.0


def signs(rows: pd.DataFrame) -> str:
    """Return a table: in how many worlds of each arm the cline of a block is stronger than its shadow."""
    lines: list[list] = []
    blocks = [name.removeprefix(f"{CLINE} ") for name in rows if name.startswith(CLINE)]
    for arm, worlds in rows.groupby("arm", sort=False):
        for block in blocks:
            more = int((worlds[f"{CLINE} {block}"] > worlds[f"{SHADOW} {block}"]).sum())
            p = sign_test(more, len(worlds) - more)
            lines.append([arm, block, len(worlds), more, f"{p:.2g}"])
    head = ["arm", "block", "worlds", "cline stronger than its shadow", "p (sign test)"]
    return table(head, lines)


def drawn(rows: pd.DataFrame) -> Figure:
    """Draw natives' life at home, at the far end and of foreigners, and the clines in each arm."""
    arms = list(dict.fromkeys(rows["arm"]))
    figure = Figure(figsize=(style.PAGE, 5.2))
    upper, lower = figure.subfigures(2, 1)
    lives = upper.subplots()
    colours = {HOME: style.BLUE, FOREIGN: style.ORANGE, FAR: style.VERMILION}
    columns = [[rows.loc[rows["arm"] == arm, name] for name in colours] for arm in arms]
    dots(lives, arms, columns, list(colours.values()))
    style.logarithmic(lives.yaxis)
    lives.set_ylabel("ticks lived")
    style.title(lives, "Natives born again", colours)
    panels = lower.subplots(1, len(arms), sharey=True, squeeze=False)[0]
    for axes, (arm, worlds) in zip(panels, rows.groupby("arm", sort=False), strict=True):
        _clines(axes, worlds)
        style.title(axes, f"Clines, {arm}", {"natives": style.BLUE, "shadows": style.SOFT})
    panels[0].set(ylim=(0, None), ylabel="variance along the islands")
    return figure


def _clines(axes: Axes, worlds: pd.DataFrame) -> None:
    blocks = [name.removeprefix(f"{CLINE} ") for name in worlds if name.startswith(CLINE)]
    columns = [[worlds[f"{kind} {block}"] for kind in (CLINE, SHADOW)] for block in blocks]
    dots(axes, blocks, columns, [style.BLUE, style.SOFT])


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
