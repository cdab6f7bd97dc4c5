"""Rows about the inside of an organism: outputs, what its brain shows, and changes of its world."""

import jax
import numpy as np
from PIL import Image
from rich.segment import Segment
from rich.style import Style

from primordia.compiled import shared
from primordia.engine.engine import Engine
from primordia.habitats.changing import is_changing
from primordia.habitats.contract import AnyHabitat
from primordia.live.paint import FAINT, Row, levels, photograph
from primordia.live.panel import STRONG
from primordia.organism.inside import (
    CHANGED,
    acting,
    is_shown,
    look,
    news_of,
    squashed,
    tints,
)
from primordia.printable import counted

LABEL = 11
"""columns of a name, with the gap after it"""
LARGEST, HIGHEST = 4, 12
"""points of the side of a number at most, and of the height of all numbers; a row has two points"""
NEW = Style(color="white", bgcolor=CHANGED)


def rows(
    engine: Engine,
    habitat: AnyHabitat,
    cell: int,
    senses: np.ndarray,
    memory: np.ndarray,
    ago: int | None,
    width: int,
) -> list[Row]:
    """Return rows about the next thought of the organism in a cell; none if pictures show nothing.

    Args:
        engine: the run.
        habitat: the habitat in which the organism lives.
        cell: the organism's cell, on the axis of all worlds.
        senses: (S,).
        memory: (M,).
        ago: ticks since its world changed; None if nothing is new.
        width: columns of the rows.
    """
    law = engine.law
    if not is_shown(law, habitat):
        return []
    blocks = engine.state.world.organisms.genome
    genome = {name: np.asarray(block)[cell : cell + 1] for name, block in blocks.items()}
    _, inside = shared(look, law.alone)(genome, memory[None], senses[None])
    output, shown = jax.tree.map(lambda each: np.asarray(each)[0], inside)
    found = [[_name("outputs"), *_bars(output, acting(law.action, output))]]
    for name, values in shown.items():
        found += _map(name, values, width)
    if is_changing(habitat):
        found.append([_name("changes"), _news(ago, news_of(habitat))])
    return found


def _news(ago: int | None, ticks: int) -> Segment:
    """Return how long ago the world changed, or that it did not within the last `ticks`."""
    if ago is None:
        return Segment(f"none in the last {ticks:,} ticks")
    return Segment("now" if ago == 0 else f"{counted(ago, 'tick')} ago", NEW)


def _name(name: str, width: int = LABEL) -> Segment:
    return Segment(f"{name:<{width}}", FAINT)


def _bars(output: np.ndarray, strong: np.ndarray) -> Row:
    """Return a bar for each output; those that act are bright."""
    bars = zip(levels(squashed(output)), strong, strict=True)
    return [Segment(bar, STRONG if bright else FAINT) for bar, bright in bars]


def _map(name: str, values: np.ndarray, width: int) -> list[Row]:
    """Return a map of numbers from -1 to 1, (rows, columns), beside its name."""
    label = max(LABEL, len(name) + 1)
    high, wide = values.shape
    zoom = min(LARGEST, HIGHEST / high, max(width - label, 1) / wide)
    zoom = int(zoom) if zoom >= 1 else zoom
    size = max(int(wide * zoom), 1), max(int(high * zoom), 1)
    picture = Image.fromarray(tints(values)).resize(size, Image.Resampling.BOX)
    drawn = photograph(np.asarray(picture))
    return [[_name("" if at else name, label), *row] for at, row in enumerate(drawn)]
