"""The figure of the common garden: recorded lives beside lives of the same genomes born again."""

import numpy as np
from matplotlib.figure import Figure

from primordia.assays.garden import Bed
from primordia.figures import style

COLOURS = {"oldest": style.BLUE, "late-born": style.ORANGE}


def draw(found: list[Bed]) -> Figure:
    """Draw recorded lives against lives of genomes born again, and the survival curve of each group."""
    figure = Figure(figsize=(style.PAGE, 2.8))
    pairs, again = figure.subplots(1, 2)
    for group, colour in COLOURS.items():
        for bed in (each for each in found if each.group == group):
            if bed.recorded is None:
                continue
            pairs.plot(
                np.maximum(bed.recorded, 1), np.maximum(bed.reborn, 1), ".", color=colour,
                markersize=3, markeredgewidth=0, alpha=0.5,
            )  # fmt: skip
    style.logarithmic(pairs.xaxis)
    style.logarithmic(pairs.yaxis)
    pairs.axline((1, 1), (10, 10), color=style.FAINT, zorder=0)
    pairs.set(xlabel="life as recorded (ticks)", ylabel="life when born again (ticks)")
    style.title(pairs, "Organisms", COLOURS)
    for group, colour in {**COLOURS, "founders": style.SOFT}.items():
        lives = np.sort(np.concatenate([each.reborn for each in found if each.group == group]))
        left = 1 - np.arange(len(lives)) / len(lives)
        again.step(np.maximum(lives, 1), left, where="pre", color=colour)
    style.logarithmic(again.xaxis)
    again.set(
        xlabel="life when born again (ticks)",
        ylabel="share that live at least as long",
        ylim=(0, 1.02),
    )
    style.title(again, "All organisms of each group", {**COLOURS, "founders": style.SOFT})
    return figure
