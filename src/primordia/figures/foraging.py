"""Do they gather more? What organisms find to eat as time goes on, and what would keep them alive."""

import numpy as np
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history.foraging import foraging
from primordia.runs.archive import Archive

BREAK_EVEN = style.ORANGE


def draw(run: Archive, world: int) -> Figure | None:
    """Draw the food an organism gathers, a second where the habitat knows of seconds, and the break-even.

    Returns:
        None for a run without a metabolism.
    """
    if run.config.metabolism is None:
        return None
    figure = Figure(figsize=(style.COLUMN, 2.4))
    axes, found = figure.subplots(), foraging(run)
    rate = run.habitat.rate
    food, enough = (each * (rate or 1) for each in (found.food, found.break_even))
    worlds = len(food)
    if len(found.middle):
        style.curves(axes, found.middle, food)
    else:
        axes.set_yticks([])
        style.say(axes, "no samples yet")
    key = style.of_worlds(worlds)
    if np.isfinite(enough).any():
        style.curves(axes, found.middle, np.where(np.isfinite(enough), enough, np.nan), BREAK_EVEN)
        key |= {"break-even": BREAK_EVEN}
    style.title(axes, f"Food an organism gathers in a {'second' if rate else 'tick'}", key)
    style.counted(axes.xaxis)
    axes.set(
        xlabel="time (ticks)",
        xlim=(found.first_tick, None),
        ylim=(min(0, axes.get_ylim()[0]), None),
    )
    return figure
