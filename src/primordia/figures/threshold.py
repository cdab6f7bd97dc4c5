"""The figure of the error threshold during a run."""

import numpy as np
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history.threshold import over_births
from primordia.runs.records import Records

WINDOWS, ENOUGH = 20, 200
"""Largest number of bins, and the births needed for each, since only a tenth of the parents are good."""


def draw(run: Records, world: int) -> Figure | None:
    """Draw p, v and s (1 - p (1 - v)) over births; None if there are too few births to measure v."""
    lives = run.lives.since_fork()
    worlds = lives.by_world()
    longest = max(map(len, worlds))
    windows = int(np.clip(longest // ENOUGH, 1, WINDOWS))
    edges = np.linspace(0, longest, windows + 1).astype(np.int64)
    acts = run.config.act is not None
    found = [over_births(number, each, edges, acts) for number, each in enumerate(worlds)]
    if windows < 2 or all(each.held is None for of_world in found for each in of_world):
        return None
    middle = (edges[:-1] + edges[1:]) / 2
    figure = Figure(figsize=(style.PAGE, 2.4))
    panels = {
        "mutated": "p: children that mutate",
        "as_good": "v: mutants as good",
        "held": "Does a good line persist?",
    }
    for axes, (name, title) in zip(figure.subplots(1, 3), panels.items(), strict=True):
        values = np.array([[getattr(each, name) for each in of_world] for of_world in found], float)
        style.curves(axes, middle, values)
        style.linear(axes.xaxis)
        axes.set(xlabel="organisms born so far", xlim=(0, longest))
        if name == "held":
            style.logarithmic(axes.yaxis)
            axes.axhline(1, color=style.VERMILION, zorder=0)
            axes.set_ylabel("s (1 - p (1 - v))")
        else:
            axes.set_ylim(-0.02, 1.02)
        threshold = {"threshold": style.VERMILION} if name == "held" else {}
        style.title(axes, title, {**style.worlds_key(len(worlds)), **threshold})
    return figure
