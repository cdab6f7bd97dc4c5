"""Pictures of bodies, with a margin above for the captions of a replay."""

from PIL import Image

PAPER = "#fbfaf7"
MARGIN = 56
"""pixels, for two lines of captions"""


def framed(picture: Image.Image) -> Image.Image:
    """Return the picture with a margin above it."""
    paper = Image.new("RGB", (picture.width, picture.height + MARGIN), PAPER)
    paper.paste(picture, (0, MARGIN))
    return paper
