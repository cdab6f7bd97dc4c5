"""A film of a world, from the records of a run."""

from collections.abc import Iterator
from itertools import chain, repeat
from pathlib import Path

import numpy as np
from PIL import Image

from primordia import files
from primordia.film import beside
from primordia.film.beside import Beside
from primordia.film.colours import colours
from primordia.film.frame import Frames, cell_colours
from primordia.film.moments import RATE, By, moments
from primordia.film.shape import shape
from primordia.history import series
from primordia.organism import video
from primordia.organism.reliving import panel, replay
from primordia.progress import tell
from primordia.runs import bundle
from primordia.runs.lives import Lives
from primordia.runs.records import Records, on_its_device

STILL = 2 * RATE
"""Number of pictures that show the end."""


@on_its_device
def film(
    run: Records,
    out: Path | None = None,
    world: int = 0,
    by: By = "births",
    ticks: tuple[int | None, int | None] = (None, None),
    organism: int | None = None,
) -> Path:
    """Film a world, and return the path of the file.

    Beside the world is the life of the oldest organism so far, or of a chosen one, if the habitat draws
    pictures. The life is shown at a speed of its own, not at the world's speed.

    Args:
        run: the world's run.
        out: an .mp4 or .gif file; by default a file in the run's folder `videos`.
        world: the world's number.
        by: what passes between two pictures; see `moments`.
        ticks: the first and the last tick to show; by default all ticks.
        organism: birth number of the organism whose life is shown; by default the oldest organism so far.

    Raises:
        InputError: there is no such world or organism, or nothing to show.
        Trouble: the film cannot be written, or a life does not repeat as recorded.
    """
    if out is None:
        bundle.refuse_changes(run.path)
    path = out or run.path / "videos" / f"world{world}.mp4"
    video.check_name(path)
    run.lives.check_world(world)
    lives = run.lives.of_world(world)
    shown = moments(lives, run.config.begins, by, ticks)
    lived = _beside(run, lives, shown, organism)
    pictures = _pictures(run, lives, shown, lived)
    first = next(pictures)
    if out is None:
        files.own_folder(path.parent)
    sample = video.sample_of(first, cell_colours(), *panel.colours(run.law, run.habitat))
    video.write(path, chain([first], pictures), RATE, sample)
    return path


def _beside(
    run: Records, lives: Lives, shown: np.ndarray, organism: int | None
) -> Iterator[Beside]:
    if organism is not None:
        return beside.chosen(run, organism, int(lives.world[0]), len(shown))
    if replay.lacking(run.habitat):
        return repeat(Beside(None, ""), len(shown))
    return beside.oldest(run, lives, shown)


def _pictures(
    run: Records, lives: Lives, shown: np.ndarray, lived: Iterator[Beside]
) -> Iterator[Image.Image]:
    config = run.config
    form = shape(config.placement, config.cells, config.islands)
    world = f", world {lives.world[0]}" if config.seeds > 1 else ""
    frames = Frames(f"{config.task}{world}", replay.lacking(run.habitat) != [])
    births = births_until(run, lives, shown)
    alive = series.population(lives, shown)
    of_cells = colours(lives, form.cells, shown, config.saturation_ticks)
    for number, (seen, life) in enumerate(zip(of_cells, lived, strict=True)):
        counts = f"tick {shown[number]:,}   births {births[number]:,}   alive {alive[number]:,}"
        share = (number + 1) / len(shown)
        tell("drawing", share)
        picture = frames.draw(form.draw(seen), counts, share, *life)
        yield picture
    for _ in range(STILL):
        yield picture


def births_until(run: Records, lives: Lives, ticks: np.ndarray) -> np.ndarray:
    """Return the number of births in one world until the end of each tick, int64 (F,).

    Births before a fork are counted, as in `info`. The records of a fork leave out those that died
    before it, so the count is the birth number of the next to be born.
    """
    born = run.count("world.worlds.births")[lives.world[0]]
    numbers = np.append(lives.id, np.int64(born))
    return numbers[series.count_until(lives.born, ticks)]
