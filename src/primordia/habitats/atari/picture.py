"""Pictures of Atari games, with pixels twice as wide as high, as on a television."""

import numpy as np
from PIL import Image

from primordia.habitats.framed import framed

PIXEL = (4, 2)
"""width and height of a pixel of the console in a picture"""


def draw(screen: np.ndarray) -> Image.Image:
    """Return a picture (640 x 476 for most games) of a screen, uint8 (height, width, 3)."""
    height, width = screen.shape[:2]
    size = width * PIXEL[0], height * PIXEL[1]
    return framed(Image.fromarray(screen).resize(size, Image.Resampling.NEAREST))
