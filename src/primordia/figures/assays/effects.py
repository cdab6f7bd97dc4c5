"""The figure of the effects of mutations."""

import numpy as np
from matplotlib.figure import Figure

from primordia.assays.effects import Effect
from primordia.figures import style

SHARES = {
    "as_long": ("as long", style.BLUE),
    "tenth_longer": ("a tenth longer", style.GREEN),
    "third_shorter": ("a third shorter", style.VERMILION),
}


def draw(found: list[Effect]) -> Figure:
    """Draw, for each mutation, the shares of mutants that live as long as the parent, longer or shorter.

    Lines and bands are means and quartiles over organisms.
    """
    mutations = list(dict.fromkeys(each.mutation for each in found))
    figure = Figure(figsize=(max(style.COLUMN, 0.55 * len(mutations) + 1), 2.8))
    axes, places = figure.subplots(), np.arange(len(mutations))
    for field, (_, colour) in SHARES.items():
        values = [
            [getattr(each, field) for each in found if each.mutation == mutation]
            for mutation in mutations
        ]
        q1, q3 = np.percentile(values, (25, 75), axis=1)
        axes.vlines(places, q1, q3, color=colour, alpha=0.3, linewidth=4)
        means = np.mean(values, axis=1)
        axes.plot(places, means, "o", color=colour, markersize=3)
        for kind in ("scale", "differs"):  # the sizes of one kind of mutation are joined by a line
            some = np.array([mutation.startswith(kind) for mutation in mutations])
            axes.plot(places[some], means[some], color=colour)
    axes.set_xticks(places, [mutation.replace(" ", "\n") for mutation in mutations])
    axes.set(ylim=(-0.02, 1.02), ylabel="share of mutants")
    key = dict(SHARES.values())
    style.title(axes, "Lives of mutants compared with parents, means and quartiles", key)
    return figure
