"""One picture of a film: the world on the left, a life on the right, and words below them."""

import numpy as np
from PIL import Image, ImageDraw, ImageOps

from primordia.film.colours import DARKEST, PALETTE
from primordia.film.shape import PAPER, SIDE
from primordia.habitats.framed import font

WIDTH, HEIGHT, EDGE = 960, 576, 20
"""pixels of the whole picture, and of its margins"""
LIFE = WIDTH - SIDE - 3 * EDGE
"""pixels, the width of the picture of a life"""
INK, SOFT = "#e8e6e1", "#8d93a0"
TITLE, SMALL = 20, 14
STRIPS = 3
"""Number of levels of brightness of each colour in a GIF."""
BAR = 3
"""pixels, the height of the bar that shows how much of the film has passed"""


class Frames:
    """The pictures of a film with a title."""

    def __init__(self, title: str, alone: bool) -> None:
        """Take the title, and whether the world is shown without a life."""
        self._left = (WIDTH - SIDE) // 2 if alone else EDGE
        self._empty = Image.new("RGB", (WIDTH, HEIGHT), tuple(PAPER.tolist()))
        pen = ImageDraw.Draw(self._empty)
        pen.text((EDGE, EDGE - 4), title, INK, font(TITLE))

    def draw(
        self, world: np.ndarray, counts: str, share: float, life: Image.Image | None, about: str
    ) -> Image.Image:
        """Return a picture.

        Args:
            world: uint8 (SIDE, SIDE, 3).
            counts: words below the world.
            share: part of the film that has passed, 0 to 1.
            life: a picture of the life, or None.
            about: words below the life.
        """
        picture = self._empty.copy()
        top = EDGE + TITLE + 8
        picture.paste(Image.fromarray(world), (self._left, top))
        pen, below = ImageDraw.Draw(picture), top + SIDE + 14
        pen.text((EDGE, below), counts, SOFT, font(SMALL))
        if life is not None:
            fitting = ImageOps.contain(life, (LIFE, SIDE), Image.Resampling.BILINEAR)
            right = 2 * EDGE + SIDE
            picture.paste(fitting, (right, top + (SIDE - fitting.height) // 2))
            pen.text((WIDTH - EDGE, below), about, SOFT, font(SMALL), anchor="ra")
        pen.rectangle((0, HEIGHT - BAR, round(share * WIDTH), HEIGHT), fill=SOFT)
        return picture


def cell_colours() -> np.ndarray:
    """Return strips of the colours that cells can have, uint8 (STRIPS, HUES, 3)."""
    lights = np.linspace(DARKEST, 1, STRIPS)[:, None, None]
    return np.clip(PALETTE * lights, 0, 255).astype(np.uint8)
