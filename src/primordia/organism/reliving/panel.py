"""The panel below pictures of a life: its brain's fast weights and outputs, and the changes of its world.

`inside` says which worlds have it.
"""

from collections.abc import Sequence

import jax
import numpy as np
from PIL import Image, ImageColor, ImageDraw

from primordia.compiled import shared
from primordia.habitats.archipelago import each_in
from primordia.habitats.changing import changes_at, is_changing
from primordia.habitats.contract import AnyHabitat
from primordia.habitats.framed import PAPER, font
from primordia.law.law import Law
from primordia.organism.inside import (
    CHANGED,
    acting,
    is_shown,
    look_on,
    news_of,
    squashed,
    tints,
)
from primordia.organism.reliving.instant import Stretch
from primordia.organism.reliving.relived import RelivedLife

EDGE, GAP, HEAD, TALL, FOOT = 14, 16, 24, 96, 22
"""pixels: margins, gaps between drawings, and heights of the words, of the drawings and of the marks"""
HEIGHT, NARROWEST = HEAD + TALL + FOOT, 360
"""pixels, the height and the least width of a panel"""
FRAME = 8
"""pixels, the width of the frame that shows that the world has changed"""
SHADES = 24
"""number of colours of numbers in a GIF"""
MOST = 1024
"""largest number of columns of a past"""
SMALL, INK = 13, "#333333"
AHEAD, PLAIN, BLANK = "#d3c1e6", "#b3aea4", "#efece5"
"""colours of a change to come, of an output that does not act, and of ages to come"""


def colours(law: Law, habitat: AnyHabitat) -> list[np.ndarray]:
    """Return strips of the colours of panels, uint8 (1, K, 3) each; none if no island has panels."""
    if not any(is_shown(law, each) for each in each_in(habitat)):
        return []
    own = [ImageColor.getrgb(each) for each in (CHANGED, AHEAD, PLAIN, BLANK, INK)]
    return [tints(np.linspace(-1, 1, SHADES))[None], np.array([own], np.uint8)]


class Past:
    """Numbers of one part of a life, row by row, and its changes."""

    def __init__(self, part: range, length: int) -> None:
        """Prepare the past of a part, drawn on a scale of `length` ticks."""
        self.part, self.length, self._rows = part, length, np.zeros((0, 0), np.float32)
        columns = min(length, MOST)
        self._ages = part.start + np.arange(columns) * length // columns
        self.changes: np.ndarray | None = None

    def take(self, first: int, values: np.ndarray) -> None:
        """Take the values of n ages from the first on, (n, R)."""
        if not self._rows.size:
            self._rows = np.zeros((values.shape[1], len(self._ages)), np.float32)
        here = (self._ages >= first) & (self._ages < first + len(values))
        self._rows[:, here] = values[self._ages[here] - first].T

    def drawn(self, width: int, age: int) -> Image.Image:
        """Return a picture of the values up to an age, (width x TALL)."""
        rows = Image.fromarray(self._rows).resize((width, TALL), Image.Resampling.BOX)
        picture = Image.fromarray(tints(np.asarray(rows)))
        left = self.place(width, age + 1)
        ImageDraw.Draw(picture).rectangle((left, 0, width, TALL), BLANK)
        return picture

    def place(self, width: int, age: int) -> int:
        """Return the pixel of an age."""
        return (age - self.part.start) * width // self.length


class Panels:
    """Draws the panels of one life, which it follows stretch by stretch."""

    def __init__(self, life: RelivedLife, parts: Sequence[range], length: int) -> None:
        """Prepare panels for parts of a life (see `replay.parts_of`), on a scale of `length` ticks."""
        self._life = life
        self._pasts: list[Past] = []
        if not is_shown(life.law, life.habitat):
            return
        self._pasts, self._memory = [Past(part, length) for part in parts], life.memory
        self._output, self._shown = np.zeros((0, 0)), dict[str, np.ndarray]()

    def follow(self, stretch: Stretch) -> None:
        """Think again in the next stretch of the life."""
        if not self._pasts:
            return
        life, n = self._life, len(stretch.tick)
        senses = np.zeros((1 << (n - 1).bit_length(), stretch.senses.shape[1]), np.float32)
        senses[:n] = stretch.senses  # few lengths are compiled
        self._memory, inside = shared(look_on, life.law.alone)(life.genome, self._memory, senses, n)
        self._output, self._shown = jax.tree.map(lambda each: np.asarray(each)[:n], tuple(inside))
        shown = [each.reshape(n, -1) for each in self._shown.values()]
        values = np.concatenate(shown or [squashed(self._output)], axis=1)
        for past in self._pasts:
            past.take(int(stretch.tick[0] - life.record.born[0]), values)

    def under(self, picture: Image.Image, part: int, stretch: Stretch, i: int) -> Image.Image:
        """Return the picture of a tick of the stretch that was followed last, with the panel below it."""
        if not self._pasts:
            return picture
        past, age = self._pasts[part], int(stretch.tick[i] - self._life.record.born[0])
        changes = self._changes(past, stretch, i)
        wide, high = picture.size
        whole = Image.new("RGB", (max(wide, NARROWEST), high + HEIGHT), PAPER)
        left = (whole.width - wide) // 2
        whole.paste(picture, (left, 0))
        new = ((changes <= age) & (changes > age - news_of(self._life.habitat))).any()
        if new and stretch.tick[i] < self._life.ends:  # the last picture stays
            edges = (left, 0, left + wide - 1, high - 1)
            ImageDraw.Draw(whole).rectangle(edges, outline=CHANGED, width=FRAME)
        self._draw(whole, picture.height + HEAD, past, age, i)
        self._mark(ImageDraw.Draw(whole), past, changes, age)
        return whole

    def _changes(self, past: Past, stretch: Stretch, i: int) -> np.ndarray:
        """Return the ages at which the world changes in a part, and shortly before it."""
        if past.changes is None:
            first = max(1, past.part.start - news_of(self._life.habitat))
            ages = np.arange(first, past.part.stop)
            body = jax.tree.map(lambda leaf: leaf[i], stretch.bodies)
            past.changes = ages[changes_at(self._life.habitat, body, ages)]
        return past.changes

    def _draw(self, whole: Image.Image, top: int, past: Past, age: int, i: int) -> None:
        """Draw the past, what the brain shows now, and its outputs, from left to right."""
        pen = ImageDraw.Draw(whole)
        shown = {name: each[i] for name, each in self._shown.items()}
        (left, width), *middle, last = _columns(whole.width, len(shown))
        begin, end = past.part.start, past.part.start + past.length - 1
        _words(pen, left, top, f"{', '.join(shown) or 'outputs'} from age {begin:,} to {end:,}")
        whole.paste(past.drawn(width, age), (left, top))
        for (left, width), (name, values) in zip(middle, shown.items(), strict=True):
            _words(pen, left, top, name)
            picture = Image.fromarray(tints(values))
            whole.paste(picture.resize((width, TALL), Image.Resampling.BOX), (left, top))
        _words(pen, last[0], top, "outputs")
        output = self._output[i]
        _bars(pen, (last[0], top, last[1]), output, acting(self._life.law.action, output))

    def _mark(self, pen: ImageDraw.ImageDraw, past: Past, changes: np.ndarray, age: int) -> None:
        """Mark the ages of changes below the past, and say what the mark means."""
        if not is_changing(self._life.habitat):
            return
        wide, high = pen.im.size
        left, width = _columns(wide, len(self._shown))[0]
        for change in changes[changes >= past.part.start].tolist():
            x = left + past.place(width, change)
            _triangle(pen, x, high - FOOT, CHANGED if change <= age else AHEAD)
        words, end = "change", wide - EDGE
        pen.text((end, high - FOOT + 13), words, INK, font(SMALL), anchor="rs")
        _triangle(pen, end - int(font(SMALL).getlength(words)) - 11, high - FOOT, CHANGED)


def _columns(width: int, maps: int) -> list[tuple[int, int]]:
    """Return left edge and width of the past, of the maps and of the outputs, in pixels."""
    outputs, each = width // 8, width // 6 // max(maps, 1)
    past = width - 2 * EDGE - outputs - maps * each - (maps + 1) * GAP
    widths = [past, *[each] * maps, outputs]
    return [(EDGE + sum(widths[:at]) + at * GAP, own) for at, own in enumerate(widths)]


def _words(pen: ImageDraw.ImageDraw, left: int, top: int, words: str) -> None:
    pen.text((left, top - 6), words, INK, font(SMALL), anchor="ls")


def _triangle(pen: ImageDraw.ImageDraw, x: int, top: int, colour: str) -> None:
    pen.polygon([(x, top + 3), (x - 5, top + 13), (x + 5, top + 13)], colour)


def _bars(
    pen: ImageDraw.ImageDraw, box: tuple[int, int, int], output: np.ndarray, dark: np.ndarray
) -> None:
    """Draw a bar for each output, from the middle of a box (left, top, width); some are dark."""
    left, top, width = box
    middle = left + width / 2
    for number, value in enumerate(squashed(output)):
        above, below = (top + TALL * at / len(output) for at in (number, number + 1))
        gap = min(6, (below - above) / 5)
        first, last = sorted((middle, middle + width / 2 * float(value)))
        pen.rectangle((first, above + gap, last, below - gap), INK if dark[number] else PLAIN)
    pen.line((middle, top, middle, top + TALL), PLAIN)
