"""The figure of the error threshold in each world."""

from matplotlib.figure import Figure

from primordia.figures import style
from primordia.figures.assays.strips import strips
from primordia.history.threshold import Threshold


def draw(found: list[Threshold]) -> Figure:
    """Draw p, v and s of each world, and the error threshold."""
    figure = Figure(figsize=(style.PAGE, 2.6))
    shares, factors = figure.subplots(1, 2)
    key = {"worlds": style.SKY, "median": style.BLUE}
    strips(
        shares,
        {
            "p: children\nthat mutate": [each.mutated for each in found],
            "v: mutants\nas good": [each.as_good for each in found],
        },
    )
    shares.set_ylim(-0.02, 1.02)
    style.title(shares, "Shares", key)
    strips(
        factors,
        {
            "s: advantage of\ngood lines": [each.advantage for each in found],
            "s (1 - p (1 - v))": [each.held for each in found],
        },
    )
    style.logarithmic(factors.yaxis)
    factors.axhline(1, color=style.VERMILION, zorder=0)
    style.title(factors, "Does a good line persist?", {**key, "threshold": style.VERMILION})
    return figure
