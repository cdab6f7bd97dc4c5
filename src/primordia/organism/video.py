"""MP4 and GIF files from pictures; the encoders are in PyAV's and Pillow's wheels."""

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from itertools import chain, product, starmap
from pathlib import Path

import numpy as np
from PIL import Image

from primordia import files
from primordia.errors import InputError

WEB = list(product(range(0, 256, 51), repeat=3))
"""Colours of the web: a cube of 6 x 6 x 6."""
FASTEST = {".mp4": 60, ".gif": 25}
"""Highest number of pictures in a second, by suffix; a GIF counts time in hundredths of a second."""


def check_name(path: Path) -> None:
    """Raise InputError unless the suffix is .mp4 or .gif, and the path is free or a regular file."""
    files.check_output(path)
    if path.suffix not in FASTEST:
        raise InputError(f"{path}: the file of a video must end with .mp4 or .gif")


def write(
    path: Path,
    pictures: Iterator[Image.Image],
    rate: float,
    sample: Image.Image | None = None,
) -> None:
    """Write pictures of one size to an .mp4 or .gif.

    Args:
        path: the file.
        pictures: one picture or more.
        rate: pictures in a second.
        sample: a picture with the colours of all pictures (a GIF has at most 256); by default the
            first picture.

    Raises:
        InputError: a GIF cannot show a picture as long as this rate asks.
        Trouble: the file cannot be written.
    """
    files.make_folder(path.parent)
    encode = partial(_gif, sample=sample) if path.suffix == ".gif" else _mp4
    try:
        files.write(path, lambda temporary: encode(temporary, pictures, rate))
    except OverflowError:  # a GIF has 16 bits for the time of equal pictures in a row
        longest = f"{path}: a GIF shows a picture for 655 s at most"
        raise InputError(f"{longest}; write an .mp4") from None


def sample_of(picture: Image.Image, *strips: np.ndarray) -> Image.Image:
    """Return a small copy of a picture above strips of colours, uint8 (rows, columns, 3) each."""
    small = picture.resize((picture.width // 4, picture.height // 4), Image.Resampling.BILINEAR)
    whole = Image.new("RGB", (small.width, (1 + len(strips)) * small.height))
    whole.paste(small)
    for number, strip in enumerate(strips, 1):
        wide = Image.fromarray(strip).resize(small.size, Image.Resampling.NEAREST)
        whole.paste(wide, (0, number * small.height))
    return whole


def _mp4(path: Path, pictures: Iterator[Image.Image], rate: float) -> None:
    """Write H.264 in yuv420p, which browsers and slides play."""
    import av  # a tenth of a second, which commands without a video need not wait

    first = next(pictures)
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=Fraction(rate).limit_denominator(1_000_000))
        stream.width, stream.height = (size - size % 2 for size in first.size)
        stream.pix_fmt = "yuv420p"
        stream.options = {"crf": "23", "preset": "veryfast"}
        for picture in chain([first], pictures):
            frame = av.VideoFrame.from_ndarray(np.asarray(picture), format="rgb24")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())


def _gif(
    path: Path, pictures: Iterator[Image.Image], rate: float, sample: Image.Image | None
) -> None:
    """Write a GIF of half the size, with the colours of the sample, or those of the first picture and
    the 216 of the web, since later pictures may have others.

    A GIF counts time in hundredths of a second, so pictures take turns in being shown one longer.
    """
    first = next(pictures)
    palette = (sample or first).quantize(
        colors=256 if sample else 256 - len(WEB),
        method=Image.Quantize.MEDIANCUT,
        dither=Image.Dither.NONE,
    )
    if not sample:
        palette.putpalette([*(palette.getpalette() or ()), *sum(WEB, ())])

    def small(number: int, picture: Image.Image) -> Image.Image:
        reduced = picture.reduce(2).quantize(palette=palette, dither=Image.Dither.NONE)
        begin, end = (round(100 * each / rate) for each in (number, number + 1))
        reduced.info["duration"] = 10 * (end - begin)  # in milliseconds
        return reduced

    all_small = starmap(small, enumerate(chain([first], pictures)))
    next(all_small).save(path, save_all=True, append_images=all_small, loop=0, optimize=True)
