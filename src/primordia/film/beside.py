"""The life shown beside a world: that of the oldest organism so far, or of a chosen organism."""

from collections.abc import Iterator
from itertools import repeat
from math import ceil
from typing import NamedTuple

import numpy as np
from PIL import Image

from primordia.film.moments import RATE
from primordia.film.oldest import oldest_so_far, shown
from primordia.habitats.archipelago import at
from primordia.organism.reliving import replay
from primordia.organism.reliving.panel import Panels
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.lives import Lives
from primordia.runs.records import Records

LEAST = 4 * RATE
"""A life is shown in at least this many pictures before an older organism takes its place."""


class Beside(NamedTuple):
    """A picture of a life, and words about the organism."""

    life: Image.Image | None
    about: str


def oldest(run: Records, lives: Lives, ticks: np.ndarray) -> Iterator[Beside]:
    """Yield a picture for each moment: the life of the oldest organism so far, from birth on.

    The words name the tick at which it is first shown, since an older one may have to wait; see LEAST.
    There is no picture while the oldest lives on an island whose habitat draws none.

    Args:
        run: the run.
        lives: the lives of one world.
        ticks: the moments, int64 (F,).
    """
    now, since, rows = -1, 0, shown(oldest_so_far(lives, ticks), LEAST)
    for row, tick in zip(rows.tolist(), ticks.tolist(), strict=True):
        if row != now:
            now, since, count = row, tick, int((rows == row).sum())
            pictures: Iterator[Image.Image | None] = repeat(None)
            if not replay.lacking(at(run.habitat, int(lives.cell[row]))):
                pictures = pictures_of(run, int(lives.id[row]), int(lives.world[row]), count)
        yield Beside(next(pictures), f"the oldest by tick {since:,}: organism {lives.id[row]:,}")


def chosen(run: Records, organism: int, world: int, count: int) -> Iterator[Beside]:
    """Yield this number of pictures of one organism's life."""
    pictures = pictures_of(run, organism, world, count)
    for _ in range(count):
        yield Beside(next(pictures), f"organism {organism:,}")


def pictures_of(run: Records, organism: int, world: int, count: int) -> Iterator[Image.Image]:
    """Yield a life's pictures, RATE of them for each second lived; the last is repeated for ever.

    Args:
        run: the organism's run.
        organism: birth number.
        world: the organism's world.
        count: the number of pictures that are needed.

    Raises:
        InputError: the life cannot be lived again or has no tick yet, or its habitat draws no pictures.
        Trouble: the life does not repeat as recorded.
    """
    life = RelivedLife.of(run, organism, world)
    rate, whole = replay.picture_rate(life), replay.parts_of(life, (0, None))
    panels = Panels(life, whole, min(ceil(count * rate / RATE), len(whole[0])))
    yielded = 0
    for tick, (_, stretch, i) in enumerate(replay.moments(life, whole, 1, panels.follow)):
        # The first n ticks have ceil(n RATE / rate) pictures together.
        number = ceil((tick + 1) * RATE / rate) - yielded
        yielded += number
        if number or stretch.tick[i] == life.ends:
            picture = panels.under(replay.picture_of(life, stretch, i), 0, stretch, i)
        yield from repeat(picture, number)
    yield from repeat(picture)
