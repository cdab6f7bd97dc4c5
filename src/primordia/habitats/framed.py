"""Pictures of bodies, with room above for the words of a replay."""

from PIL import Image

PAPER = "#fbfaf7"
ROOM = 56
"""pixels, for two lines of words"""


def framed(picture: Image.Image) -> Image.Image:
    """The picture on paper, below the room."""
    paper = Image.new("RGB", (picture.width, picture.height + ROOM), PAPER)
    paper.paste(picture, (0, ROOM))
    return paper
