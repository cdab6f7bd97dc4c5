"""The figure of traits: the bodies of the newborn over births, beside those of neutral shadows."""

from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history.traits import course
from primordia.runs.records import Records

COLUMNS = 3
"""Largest number of panels in a row."""
KEY = {"organisms": style.BLUE, "neutral shadows": style.ORANGE}


def draw(run: Records, world: int) -> Figure | None:
    """Draw each trait over births; None if bodies are not inherited."""
    traits, found = run.config.traits, course(run)
    if traits is None or found is None:
        return None
    count = len(traits.names)
    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    width = style.COLUMN if columns == 1 else style.PAGE
    figure = Figure(figsize=(width, 2.4 * rows))
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, name, own, shadows in zip(
        panels, traits.names, found.own, found.shadows, strict=False
    ):
        style.curves(axes, found.middle, shadows, style.ORANGE)
        style.curves(axes, found.middle, own)
        style.title(axes, name, KEY)
        style.linear(axes.xaxis)
        style.logarithmic(axes.yaxis)
        axes.set(xlabel="organisms born so far", ylabel="factor", xlim=(0, None))
    for axes in panels[count:]:
        axes.set_axis_off()
    return figure
