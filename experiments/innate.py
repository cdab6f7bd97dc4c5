"""Does what organisms learn become innate? They live again without learning, or with swapped choices.

    python experiments/innate.py experiments/learning/innate.toml

The experiment must have been run (`primordia experiment`). Its time is cut into WINDOWS; in each of them
ORGANISMS organisms that were born there live again, alone, in a game of at most TICKS ticks that does not
change, without hunger and accidents. The same organisms live in that game without plasticity, and with
plasticity in a game whose choices are in reverse order. If fast weights follow experience, they have
the opposite sign there. The neutral shadow of an organism has its
pedigree, and as many mutations, but no selection. A table and a figure go to `results/` beside the file.
"""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import named
import numpy as np
import pandas as pd
from by_world import Row, illustrate, measure
from matplotlib.figure import Figure
from plasticity import learning, memories

from primordia.assays.shadow import reborn
from primordia.figures import style
from primordia.habitats.contract import AnyHabitat
from primordia.history.series import spaced
from primordia.law.law import Law
from primordia.organism.playing.games import Players, lifespans
from primordia.runs.records import Records

WINDOWS, ORGANISMS, TICKS, FIRST = 6, 20, 2_000, 50
REVERSED = {"kind": "reverse-actions", "at": [1]}
LIVED, INNATE, OTHER = "ticks lived", "without plasticity", "choices reversed"
LEARNING, AGREEMENT, SHADOWS = "learning", "agreement", "shadows without plasticity"
COLUMNS = LIVED, INNATE, OTHER, LEARNING, AGREEMENT, SHADOWS
PANELS = {
    LIVED: "Ticks lived",
    OTHER: "Ticks lived, choices reversed",
    INNATE: "Ticks lived without plasticity",
    LEARNING: "Learning in a tick",
}

NOTE = (
    f"Ticks lived in games of at most {TICKS:,} ticks without changes, hunger and accidents: means of"
    f" {ORGANISMS} organisms born in a sixth of the time. Choices reversed: with plasticity; choices are"
    " counted from the last one after the first tick. Learning: changes of all fast weights in a tick of"
    " the first of these games. Agreement: cosine of the angle between an organism's mean fast weights in"
    f" the game and in that with choices reversed, in the first {FIRST} ticks in which it lives in both:"
    " -1 if fast weights follow experience alone, 1 if they do not. Shadows: neutral shadows."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table and the figure."""
    illustrate(measure(file, "innate", rows_of, NOTE), drawn)


def rows_of(run: Records) -> list[Row]:
    """Return a row for each window of time of each world."""
    groups = sampled(run)
    found = games_of(run, np.concatenate([rows for *_, rows in groups]))
    rows, end = [], 0
    for born, world, own in groups:
        first, end = end, end + len(own)
        means = {name: round(float(each[first:end].mean()), 2) for name, each in found.items()}
        unknown = dict.fromkeys(COLUMNS, "")
        rows.append({"born": born, "seed": int(run.world_seeds[world]), **unknown, **means})
    return rows


def sampled(run: Records) -> list[tuple[str, int, np.ndarray]]:
    """Return for each window and world some organisms born there: the window's name, the world, rows."""
    lives, edges = run.lives, np.linspace(0, run.ends.max(), WINDOWS + 1).astype(int)
    found = []
    for first, last in pairwise(edges):
        for world in range(run.config.seeds):
            born = (lives.world == world) & (first < lives.born) & (lives.born <= last)
            rows = spaced(np.flatnonzero(born), ORGANISMS)
            if len(rows):
                found.append((f"{first:,} to {last:,}", world, rows))
    return found


def games_of(run: Records, rows: np.ndarray) -> dict[str, np.ndarray]:
    """Return what organisms do in their games, float64 (K,) each; INNATE and so on if they learn."""
    real, shadows = (
        reborn(run, rows, redrawn)._replace(
            law=replace(run.law, metabolism=None), habitat=unchanging(run)
        )
        for redrawn in (False, True)
    )
    other = real._replace(habitat=unchanging(run, REVERSED))
    found = {LIVED: lifespans(real, TICKS), OTHER: lifespans(other, TICKS)}
    if (brain := run.law.brain.innate()) is not None and brain != run.law.brain:
        law = replace(real.law, brain=brain)
        found[INNATE], found[SHADOWS] = (
            lifespans(each._replace(law=law), TICKS) for each in (real, shadows)
        )
        found[LEARNING], found[AGREEMENT] = learning(real)[0], agreement(real, other)
    return found


def agreement(one: Players, other: Players) -> np.ndarray:
    """Return the cosine of the angle between fast weights in two games, float64 (K,)."""
    sums = np.zeros((2, 1, 1))
    for both in zip(memories(one, FIRST), memories(other, FIRST), strict=False):
        live = both[0][0] & both[1][0]
        fast = np.array([fast_weights(one.law, memory) for _, memory in both])
        sums = sums + np.where(live[:, None], fast, 0)
    lengths = np.linalg.norm(sums, axis=2).prod(axis=0)
    return sums.prod(axis=0).sum(axis=1) / np.maximum(lengths, 1e-9)


def fast_weights(law: Law, memory: np.ndarray) -> np.ndarray:
    """Return fast weights as shares of their bound, float64 (K, n)."""
    pictured = law.brain.pictured(jnp.asarray(memory), law.senses, law.outputs)
    return np.asarray(pictured["fast weights"], float).reshape(len(memory), -1)


def unchanging(run: Records, *first: dict[str, Any]) -> AnyHabitat:
    """Return the habitat of a run without changes within a life, but the `first` ones."""
    own = {**run.config.habitat, "change": list(first) or None}
    return run.config.model_copy(update={"habitat": own}).build_habitat()


def drawn(rows: pd.DataFrame) -> Figure:
    """Return the figure: medians and quartiles over worlds, in each window of time."""
    figure = Figure(figsize=(style.PAGE, 4.4))
    panels = figure.subplots(2, 2, sharex=True).flat
    edges = rows["born"].str.replace(",", "").str.split(" to ", expand=True).astype(float)
    rows = rows.assign(time=edges.mean(axis=1))
    for axes, (name, title) in zip(panels, PANELS.items(), strict=True):
        for (arm, own), colour in zip(rows.groupby("arm", sort=False), style.PALETTE, strict=False):
            quartiles = own.groupby("time")[name].quantile([0.25, 0.5, 0.75]).unstack()
            axes.plot(quartiles[0.5], color=colour, marker="o", markersize=3, label=arm)
            axes.fill_between(
                quartiles.index, quartiles[0.25], quartiles[0.75], color=colour, alpha=0.15, lw=0
            )
        axes.set_title(title)
        axes.set_ylim(0)
        style.linear(axes.xaxis)
    for axes in figure.axes[2:]:
        axes.set_xlabel("time of birth (ticks): median and quartiles of worlds")
    handles = figure.axes[0].get_legend_handles_labels()[0]
    figure.legend(handles=handles, loc="outside lower left", frameon=False, ncols=4)
    return figure


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
