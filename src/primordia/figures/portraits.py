"""The figure of portraits: the bodies of an organism's ancestors, the oldest first."""

from itertools import islice

import jax
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.habitats.contract import Ability
from primordia.history import series
from primordia.organism.reliving.relived import RelivedLife
from primordia.phylogeny.descent import Ancestors
from primordia.runs.records import Records

COUNT, COLUMNS = 8, 4
"""Largest numbers of portraits, and of those in a row."""
TRAITS = 3
"""Largest number of traits that are written above a portrait."""


def draw(run: Records, found: Ancestors) -> Figure | None:
    """Draw some of the ancestors, evenly spaced, in the first ticks of their lives.

    Return None if bodies are not inherited, if none of them lived a tick, or if the habitat draws no
    pictures.

    Raises:
        InputError: a life cannot be lived again or drawn; the message says why.
    """
    lived = np.flatnonzero(found.line.lifespan > 0)
    if found.traits is None or not len(lived) or run.habitat.lacks(Ability.PICTURE):
        return None
    places = lived[series.places(len(lived), COUNT)]
    columns = min(len(places), COLUMNS)
    rows = -(-len(places) // columns)
    figure = Figure(figsize=(style.PAGE, (1.35 + 0.1 * min(len(found.traits), TRAITS)) * rows))
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in panels:
        axes.set_axis_off()
    for axes, place in zip(panels, places, strict=False):
        _portrait(axes, run, found, int(place))
    return figure


def _portrait(axes: Axes, run: Records, found: Ancestors, place: int) -> None:
    number = int(found.line.id[place])
    life = RelivedLife.of(run, number, found.world)
    (stretch,) = islice(life.stretches(watched=True), 1)
    body = jax.tree.map(lambda leaf: leaf[0], stretch.bodies)
    axes.imshow(np.asarray(life.habitat.picture(body, stretch.action[0]).convert("RGB")))
    assert found.traits is not None
    traits = [f"{name} x {each[place]:.3g}" for name, each in found.traits.items()][:TRAITS]
    title = f"organism {number:,}, tick {int(found.line.born[place]):,}"
    axes.set_title("\n".join([title, *traits]), fontsize=6, loc="left")
