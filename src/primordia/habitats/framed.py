"""Pictures of bodies, with a margin above for the captions of a replay."""

from functools import cache

from PIL import Image, ImageFont

PAPER = "#fbfaf7"
MARGIN = 56
"""pixels, for two lines of captions"""


def framed(picture: Image.Image) -> Image.Image:
    """Return the picture with a margin above it."""
    paper = Image.new("RGB", (picture.width, picture.height + MARGIN), PAPER)
    paper.paste(picture, (0, MARGIN))
    return paper


@cache
def font(size: int) -> ImageFont.ImageFont | ImageFont.FreeTypeFont:
    """Return the font of a size in pixels."""
    return ImageFont.load_default(size)
