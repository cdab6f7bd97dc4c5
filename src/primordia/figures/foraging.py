"""The figure of foraging: the food that organisms gather over time, and the break-even."""

import numpy as np
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history.foraging import foraging
from primordia.runs.records import Records

BREAK_EVEN = style.ORANGE


def draw(run: Records, world: int) -> Figure | None:
    """Draw how much food an organism gathers per second, and the break-even; per tick if the
    habitat has no rate.

    Returns:
        None for a run without a metabolism.
    """
    if run.config.metabolism is None:
        return None
    figure = Figure(figsize=(style.COLUMN, 2.4))
    axes, measured = figure.subplots(), foraging(run)
    rate, middle = run.description.rate, measured.middle
    food, enough = (each * (rate or 1) for each in (measured.food, measured.break_even))
    if len(middle):
        style.curves(axes, middle, food)
    else:
        axes.set_yticks([])
        style.remark(axes, "no samples yet")
    key = style.worlds_key(len(food))
    if np.isfinite(enough).any():
        style.curves(axes, middle, np.where(np.isfinite(enough), enough, np.nan), BREAK_EVEN)
        key |= {"break-even": BREAK_EVEN}
    style.title(axes, f"Food an organism gathers in a {'second' if rate else 'tick'}", key)
    style.linear(axes.xaxis)
    axes.set(xlabel="time (ticks)", xlim=(measured.first_tick, None))
    axes.set_ylim(min(0, axes.get_ylim()[0]), None)
    return figure
