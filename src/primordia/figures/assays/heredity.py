"""The figure of the inheritance of lifespan in each world."""

from matplotlib.figure import Figure

from primordia.assays.heredity import Inherited
from primordia.figures import style
from primordia.figures.assays.strips import strips


def draw(found: list[Inherited]) -> Figure:
    """Draw Price's terms, and slopes of children's log life on their parents': a dot for each world."""
    figure = Figure(figsize=(style.PAGE, 2.6))
    slopes, shares, terms = figure.subplots(1, 3, width_ratios=(1, 1.1, 0.9))
    key = {"worlds": style.SKY, "median": style.BLUE}
    strips(
        slopes,
        {
            "copies": [each.copies.slope for each in found],
            "mutants": [each.mutants.slope for each in found],
            "both": [each.both.slope for each in found],
        },
    )
    slopes.axhline(1, color=style.FAINT, zorder=0)
    slopes.axhline(0, color=style.FAINT, zorder=0)
    style.title(slopes, "Slope of children's log life on parents' log life", key)
    strips(
        shares,
        {
            "as long": [each.mutants.as_long for each in found],
            "a tenth\nlonger": [each.mutants.longer for each in found],
            "a third\nshorter": [each.mutants.shorter for each in found],
        },
    )
    shares.set_ylim(-0.02, 1.02)
    style.title(shares, "Share of mutants", key)
    strips(
        terms,
        {
            "selection": [each.selection for each in found],
            "transmission": [each.transmission for each in found],
        },
    )
    terms.axhline(0, color=style.FAINT, zorder=0)
    style.title(terms, "Change of mean log life", key)
    return figure
