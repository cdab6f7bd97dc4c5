"""Strip plots: the values of worlds or organisms as dots, with their median."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from primordia.figures import style

WIDTH = 0.5
"""Width of a strip of dots, as a share of the distance between strips."""


def strips(axes: Axes, values: Mapping[str, Sequence[float | None]]) -> None:
    """Draw a strip of the known values for each name, and a line at its median."""
    for place, each in enumerate(values.values()):
        known = np.array([value for value in each if value is not None], float)
        known = known[np.isfinite(known)]
        if not len(known):
            continue
        spread = np.linspace(-WIDTH / 2, WIDTH / 2, len(known)) if len(known) > 1 else np.zeros(1)
        axes.plot(
            place + spread, known, ".", color=style.SKY, markersize=4, markeredgewidth=0, alpha=0.8
        )
        ends = place - WIDTH / 2, place + WIDTH / 2
        axes.plot(ends, [np.median(known)] * 2, color=style.BLUE)
    axes.set_xticks(range(len(values)), list(values))
    axes.set_xlim(-0.6, len(values) - 0.4)
