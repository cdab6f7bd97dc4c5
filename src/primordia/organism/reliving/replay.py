"""Videos of lives that are lived again."""

from collections.abc import Callable, Iterator, Sequence
from itertools import chain, repeat, zip_longest
from math import ceil, isqrt
from pathlib import Path

import jax
import numpy as np
from PIL import Image, ImageDraw

from primordia import files
from primordia.errors import InputError
from primordia.habitats.archipelago import each_in
from primordia.habitats.contract import Ability, AnyHabitat
from primordia.habitats.framed import PAPER, font
from primordia.law.metabolism import ONE
from primordia.organism import video
from primordia.organism.reliving import panel
from primordia.organism.reliving.instant import Stretch
from primordia.organism.reliving.panel import Panels
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import bundle
from primordia.runs.records import Records, on_its_device

PART = 30.0
"""Seconds shown at each end of a long life; a life of at most twice this time is shown whole."""
STILL = 1.0
"""Seconds for which a card, and the last picture, are shown."""
SIZE, INK = 16, "#333333"
GAP = 16
"""pixels between lives that are shown side by side"""


Named = tuple[Records, int, int]
"""an organism: its run, its birth number and its world"""


@on_its_device
def replay(
    run: Records,
    organism: int,
    world: int = 0,
    out: Path | None = None,
    ages: tuple[int | None, int | None] = (None, None),
    part: float | None = None,
    beside: Sequence[int | Named] = (),
) -> Path:
    """Make a video of a life, or of several side by side. Return the path of the file.

    Lives side by side begin together: first those of this world in the order of their births, then
    those of other runs. A life that has ended keeps its last picture.

    Args:
        run: the organism's run.
        organism: birth number.
        world: the organism's world.
        out: an .mp4 or .gif file; by default under the run's `videos`.
        ages: first and last age shown, in ticks. By default the whole life is shown, or the first and
            last 30 seconds of a life longer than a minute.
        part: seconds shown at each end of a long life; by default 30.
        beside: other organisms whose lives are shown too: birth numbers in the same world, or a run,
            a birth number and a world.

    Raises:
        InputError: no such organism was born, the habitat draws no pictures, no age is left to show, or
            the ticks of two lives last for different times.
        Trouble: the video cannot be written, or the life does not repeat as recorded.
    """
    if out is None:
        bundle.refuse_changes(run.path)
    numbers = sorted({organism, *(each for each in beside if isinstance(each, int))})
    others = [each for each in beside if not isinstance(each, int)]
    name = f"world{world}-organism{'-'.join(map(str, numbers))}"
    name += "".join(f"-{one.path.name}-world{at}-organism{id}" for one, id, at in others)
    path = out or run.path / "videos" / f"{name}.mp4"
    video.check_name(path)
    lives = [RelivedLife.of(*each) for each in [*((run, id, world) for id in numbers), *others]]
    shown = [(life, parts_of(life, ages, part)) for life in lives]
    if out is None:
        files.own_folder(path.parent)
    film(path, *shown)
    return path


def film(path: Path, *shown: tuple[RelivedLife, list[range]]) -> None:
    """Make a video, .mp4 or .gif, of parts of lives, side by side; see `parts_of`.

    Raises:
        InputError: a GIF cannot show a picture as long as the ticks of the habitat ask, or the ticks of
            two lives last for different times.
        Trouble: the video cannot be written, or a life does not repeat as recorded.
    """
    rate, several = (
        _common_rate([life for life, _ in shown]),
        len({life.run.path for life, _ in shown}) > 1,
    )
    step = ceil(rate / video.FASTEST[path.suffix])
    longest = max(len(part) for _, parts in shown for part in parts)
    films = [
        _pictures(life, parts, Panels(life, parts, longest), step, rate / step, several)
        for life, parts in shown
    ]
    pictures = _side_by_side(films)
    first, of_panels = next(pictures), (panel.colours(each.law, each.habitat) for each, _ in shown)
    strips = next(filter(None, of_panels), [])  # those of all lives are equal
    sample = video.sample_of(first, *strips) if strips else None
    video.write(path, chain([first], pictures), rate / step, sample)


def lacking(habitat: AnyHabitat) -> list[str]:
    """Return the methods and properties that a habitat lacks for videos of its lives.

    Of islands, they are those of the island that lacks fewest: its lives can be shown if there are none.
    """
    each_lacks = (
        [*each.lacks(Ability.PICTURE), *([] if each.rate else ["rate"])]
        for each in each_in(habitat)
    )
    return min(each_lacks, key=len)


def picture_rate(life: RelivedLife) -> float:
    """Return the ticks in a second of a life; raise InputError if the habitat draws no pictures."""
    if lacks := " and no ".join(f"`{name}`" for name in lacking(life.habitat)):
        raise InputError(f"{_place(life)}: the habitat draws no pictures, since it has no {lacks}")
    assert life.habitat.rate
    return life.habitat.rate


def _common_rate(lives: list[RelivedLife]) -> float:
    """Return the ticks in a second of all lives; raise InputError if they differ."""
    rate = picture_rate(lives[0])
    for life in lives:
        if (own := picture_rate(life)) != rate:
            raise InputError(
                f"{_place(life)}: a second has {own:g} ticks, and {rate:g} in {_place(lives[0])}, so"
                " their lives cannot be shown side by side"
            )
    return rate


def _place(life: RelivedLife) -> str:
    """Return the run of a life, and its island if there are islands."""
    return f"{life.run.path}" + (f", island {life.island}" if life.island else "")


def parts_of(
    life: RelivedLife,
    ages: tuple[int | None, int | None] = (None, None),
    seconds: float | None = None,
) -> list[range]:
    """Return the ages to show, in ticks; `seconds` (or PART) is the time for each end of a long life.

    Raises:
        InputError: no age is left to show, or the habitat draws no pictures.
    """
    seconds = PART if seconds is None else seconds
    rate, born = picture_rate(life), int(life.record.born[0])
    first, last = life.begins + 1 - born, life.ends - born
    if first > last:
        name = f"organism {life.record.id[0]}"
        raise InputError(f"{name} has not lived a tick yet, so nothing can be shown")
    if ages == (None, None) and last - first > 2 * seconds * rate:
        part = max(int(seconds * rate), 1)
        return [range(first, first + part), range(last - part + 1, last + 1)]
    begin, end = ages
    shown = range(max(first, begin or 0), min(last, last if end is None else end) + 1)
    if not len(shown):
        raise InputError(
            f"organism {life.record.id[0]} can be seen from age {first} to {last}, not from"
            f" {first if begin is None else begin} to {last if end is None else end}"
        )
    return [shown]


def _pictures(
    life: RelivedLife,
    parts: list[range],
    panels: Panels,
    step: int,
    rate: float,
    with_run: bool,
) -> Iterator[Image.Image]:
    """Yield a picture of every `step`-th tick of the parts; the last one is repeated.

    A card between two parts tells the time that is left out. Pictures may have the name of the run.
    """
    of = life.run.path.name if with_run else ""
    still, part, picture = max(1, round(STILL * rate)), 0, None
    for part_now, stretch, i in moments(life, parts, step, panels.follow):
        if part_now > part and picture is not None:
            left_out = parts[part_now].start - parts[part].stop
            yield from repeat(_card(picture.size, f"{left_out:,} ticks later"), still)
        drawn = picture_of(life, stretch, i, of)
        part, picture = part_now, panels.under(drawn, part_now, stretch, i)
        yield picture
    assert picture is not None
    yield from repeat(picture, still)


def _side_by_side(films: list[Iterator[Image.Image]]) -> Iterator[Image.Image]:
    """Yield pictures that join films in rows; an ended film keeps its last picture."""
    columns = isqrt(len(films) - 1) + 1
    rows = ceil(len(films) / columns)
    held = [next(film) for film in films]
    width, height = (max(picture.size[axis] for picture in held) for axis in (0, 1))
    for pictures in chain([held], zip_longest(*films)):
        held = [old if new is None else new for old, new in zip(held, pictures, strict=True)]
        size = (columns * (width + GAP) - GAP, rows * (height + GAP) - GAP)
        whole = Image.new("RGB", size, PAPER)
        for number, picture in enumerate(held):
            row, column = divmod(number, columns)
            whole.paste(picture, (column * (width + GAP), row * (height + GAP)))
        yield whole


def moments(
    life: RelivedLife, parts: list[range], step: int, follow: Callable[[Stretch], None]
) -> Iterator[tuple[int, Stretch, int]]:
    """Yield, for each tick shown, the number of its part, its stretch, and its index in the stretch.

    `follow` is called with each stretch of the life before its ticks.
    """
    for stretch in life.stretches(watched=True):
        follow(stretch)
        ages = stretch.tick - life.record.born[0]
        for number, part in enumerate(parts):
            shown = (ages >= part.start) & (ages < part.stop)
            shown &= ((ages - part.start) % step == 0) | (stretch.tick == life.ends)
            for i in np.flatnonzero(shown):
                yield number, stretch, int(i)


def picture_of(life: RelivedLife, stretch: Stretch, i: int, run: str = "") -> Image.Image:
    """Return the picture of one tick of a stretch, with captions; they may begin with a run's name."""
    tick = int(stretch.tick[i])
    body = jax.tree.map(lambda leaf: leaf[i], stretch.bodies)
    picture = life.habitat.picture(body, stretch.action[i])
    if not isinstance(picture, Image.Image):
        raise InputError(
            f"the habitat's `picture` returns {type(picture).__name__}; return a PIL.Image.Image"
        )
    words = [
        *([run] if run else []),
        f"organism {life.record.id[0]}",
        *([f"on {life.island}"] if life.island else []),
        f"age {tick - life.record.born[0]:,}",
    ]
    if life.law.metabolism is not None:
        words.append(f"energy {stretch.energy[i] / ONE:,.1f}")
    if tick == life.ends and life.cause is not None:
        words.append(f"dies ({life.cause.label})")
    below = life.habitat.caption(body, stretch.action[i])
    return _captioned(picture, "   ".join(words), f"tick {tick:,}", below)


def _captioned(picture: Image.Image, left: str, right: str, below: str) -> Image.Image:
    """Write words into a picture: in its upper corners, and below those on the left.

    The words on the right go into the second line if only this has room for them.
    """
    pen, letters = ImageDraw.Draw(picture), font(SIZE)
    room = [
        pen.textlength(f"{each}  {right}", letters) <= picture.width - 28 for each in (left, below)
    ]
    pen.text((14, 12), left, INK, letters)
    pen.text((14, 32), below, INK, letters)
    pen.text(
        (picture.width - 14, 32 if room == [False, True] else 12), right, INK, letters, anchor="ra"
    )
    return picture


def _card(size: tuple[int, int], words: str) -> Image.Image:
    """Draw words on an empty picture."""
    card = Image.new("RGB", size, PAPER)
    middle = (size[0] / 2, size[1] / 2)
    ImageDraw.Draw(card).text(middle, words, INK, font(2 * SIZE), anchor="mm")
    return card
