"""The figure of ablations."""

import numpy as np
from matplotlib.figure import Figure

from primordia.assays.ablate import Ablation
from primordia.figures import style


def draw(found: list[Ablation]) -> Figure:
    """Draw the share of life that is left after each ablation: a dot for each organism, and a line
    at the median."""
    losses = list(dict.fromkeys(each.without for each in found))
    figure = Figure(figsize=(style.COLUMN, 0.9 + 0.16 * len(losses)))
    axes = figure.subplots()
    for place, loss in enumerate(losses):
        kept = [each.kept for each in found if each.without == loss]
        axes.plot(kept, [place] * len(kept), ".", color=style.SKY, markersize=4, alpha=0.8)
        axes.plot(np.median(kept), place, "|", color=style.BLUE, markersize=8)
    axes.axvline(1, color=style.FAINT, zorder=0)
    axes.set_yticks(range(len(losses)), losses)
    axes.set(ylim=(len(losses) - 0.5, -0.5), xlabel="share of the intact life")
    axes.set_xlim(0, None)
    key = {"organisms": style.SKY, "median": style.BLUE}
    style.title(axes, "Life without each part", key)
    return figure
