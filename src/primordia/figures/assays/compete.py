"""The figure of two competing genomes."""

from matplotlib.figure import Figure

from primordia.assays.compete import Competition
from primordia.figures import style


def draw(found: list[Competition]) -> Figure:
    """Draw the share of the living that descend from the first genome, in each world over time."""
    figure = Figure(figsize=(style.COLUMN, 2.6 * len(found)))
    for axes, each in zip(figure.subplots(len(found), squeeze=False).flat, found, strict=True):
        style.curves(axes, each.tick, each.share)
        axes.axhline(0.5, color=style.FAINT, zorder=0)
        style.linear(axes.xaxis)
        axes.set(xlabel="time (ticks)", ylim=(-0.02, 1.02), xlim=(0, each.tick[-1]))
        axes.set_ylabel("share of the living")
        style.title(axes, f"Descendants of {each.one}", style.worlds_key(len(each.share)))
    return figure
