"""The figure of investment: the energy that parents give to their children, over births."""

import numpy as np
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history.investment import investment
from primordia.runs.records import Records


def draw(run: Records, world: int) -> Figure | None:
    """Draw the mean endowment of children; None unless replication is an act and children were born."""
    if run.config.act is None or not np.isfinite((found := investment(run)).endowment).any():
        return None
    figure = Figure(figsize=(style.COLUMN, 2.4))
    axes = figure.subplots()
    style.curves(axes, found.middle, found.endowment)
    style.title(axes, "Energy given to a child", style.worlds_key(len(found.endowment)))
    style.linear(axes.xaxis)
    axes.set(xlabel="organisms born so far", ylabel="endowment")
    axes.set(xlim=(0, found.middle[0] + found.middle[-1]), ylim=(0, None))
    return figure
