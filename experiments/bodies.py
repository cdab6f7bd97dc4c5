"""What bodies evolve? Traits of late-born organisms and of their neutral shadows.

    python experiments/bodies.py experiments/bodies/pole-length.toml

The experiment must have been run (`primordia experiment`). In each world EACH late-born organisms are
taken. Their traits are factors of the habitat's own body, geometric means. Neutral shadows have the same
pedigree and as many mutations, but no selection. Then the same organisms live again, GAMES games of at
most TICKS ticks without accidents, in their own bodies and in the body of founders. So do founders.
A table and a figure go to `results/` beside the file.
"""

from pathlib import Path

import named
import numpy as np
import pandas as pd
from by_world import Row, dots, illustrate, measure
from matplotlib.figure import Figure

from primordia.brains.layout import BODY
from primordia.comparison.pairs import sign_test
from primordia.experiments.results import table
from primordia.figures import style
from primordia.history import pedigree
from primordia.history.series import spaced
from primordia.organism.playing.games import lifespans_in_games
from primordia.organism.playing.players import founders_of, players_of
from primordia.runs.records import Records

EACH, GAMES, TICKS, LATE = 20, 3, 5_000, 0.5
SHADOW, OWN, USUAL, FOUNDERS = "shadow of", "own body", "founder's body", "founders"
NOTE = (
    f"Traits: geometric means over {EACH} late-born organisms of a world, as factors of the habitat's own"
    f" body. Shadows are neutral. Own body, founder's body: ticks that these organisms live with it, in"
    f" games of at most {TICKS:,} ticks. Founders: ticks that founders live."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table and the figure."""
    illustrate(measure(file, "traits", rows_of, NOTE), drawn, signs)


def rows_of(run: Records) -> list[Row]:
    """Return a row for each world."""
    found = []
    late = run.lives.late(LATE)
    for world in range(run.config.seeds):
        rows = spaced(np.flatnonzero(late & (run.lives.world == world)), EACH)
        row: Row = {"seed": int(run.world_seeds[world]), **_traits(run, rows)}
        row |= {name: round(float(ticks), 1) for name, ticks in _lives(run, rows).items()}
        found.append(row)
    return found


def _traits(run: Records, rows: np.ndarray) -> Row:
    """Return the mean of each trait of organisms, and of their neutral shadows."""
    traits, found = run.config.traits, {}
    assert traits is not None
    for before, redrawn in (("", False), (f"{SHADOW} ", True)):
        genes = run.layout.split(pedigree.genomes(run, rows, redrawn))[BODY]
        means = np.exp(np.log(traits.factors(genes).astype(float)).mean(axis=0))
        for name, mean in zip(traits.names, means.tolist(), strict=True):
            found[before + name] = round(mean, 4)
    return found


def _lives(run: Records, rows: np.ndarray) -> dict[str, float]:
    """Return how long organisms live in their own bodies and in the founder's, and founders, in ticks."""
    players = players_of(run, rows)
    usual = players.genomes.copy()
    usual[:, -run.layout.genes :] = 0
    world = run.lives.world[rows[:1]]
    others = founders_of(run, world, np.array([EACH]))[2]
    of = {OWN: players, USUAL: players._replace(genomes=usual), FOUNDERS: others}
    return {name: lifespans_in_games(each, GAMES, TICKS).mean() for name, each in of.items()}


def signs(rows: pd.DataFrame) -> str:
    """Return a table: in how many worlds of each arm a trait is larger than its shadow."""
    lines: list[list] = []
    names = [name.removeprefix(f"{SHADOW} ") for name in rows if name.startswith(SHADOW)]
    for arm, worlds in rows.groupby("arm", sort=False):
        for name in names:
            own, shadow = worlds[name], worlds[f"{SHADOW} {name}"]
            larger, smaller = int((own > shadow).sum()), int((own < shadow).sum())
            p = sign_test(larger, smaller)
            lines.append([arm, name, len(worlds), larger, smaller, f"{p:.2g}"])
    head = ["arm", "trait", "worlds", "larger than its shadow", "smaller", "p (sign test)"]
    return table(head, lines)


def drawn(rows: pd.DataFrame) -> Figure:
    """Draw traits and their shadows in each world, and how long organisms live in their bodies."""
    arms = list(dict.fromkeys(rows["arm"]))
    figure = Figure(figsize=(style.PAGE, 2.8))
    bodies, lives = figure.subplots(1, 2)
    both = {"late-born": style.BLUE, "neutral shadows": style.SOFT}
    names = [name.removeprefix(f"{SHADOW} ") for name in rows if name.startswith(SHADOW)]
    groups = [(arm, name) for arm in arms for name in names if _evolves(rows, arm, name)]
    if len(names) > 1:  # of several traits, those of the first arm
        groups = groups[: len(names)]
    columns = [
        [rows.loc[rows["arm"] == arm, each] for each in (name, f"{SHADOW} {name}")]
        for arm, name in groups
    ]
    dots(bodies, [name if names[1:] else arm for arm, name in groups], columns, [*both.values()])
    style.logarithmic(bodies.yaxis)
    bodies.set_ylabel("factor of the habitat's own body")
    style.title(bodies, f"Traits, {arms[0]}" if names[1:] else names[0], both)
    three = {OWN: style.BLUE, USUAL: style.ORANGE, FOUNDERS: style.SOFT}
    columns = [[rows.loc[rows["arm"] == arm, name] for name in three] for arm in arms]
    dots(lives, arms, columns, list(three.values()))
    style.logarithmic(lives.yaxis)
    lives.set_ylabel("ticks lived")
    style.title(lives, "Lives", three)
    return figure


def _evolves(rows: pd.DataFrame, arm: str, name: str) -> bool:
    return rows.loc[rows["arm"] == arm, name].nunique() > 1


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
