"""Figures of a run's records, as PNG and SVG.

A figure is a function `draw(run, world) -> Figure | None`, which returns None if the run has nothing
to draw. Its name is one of KNOWN, or `module:function` for your own.
"""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeAlias

from matplotlib.figure import Figure

from primordia import files
from primordia.errors import InputError
from primordia.figures import style
from primordia.progress import steps
from primordia.runs import bundle
from primordia.runs.records import Records
from primordia.settings import parts

KNOWN = {
    "ages": "primordia.figures.ages:draw",
    "survival": "primordia.figures.survival:draw",
    "population": "primordia.figures.population:draw",
    "space-time": "primordia.figures.spacetime:draw",
    "foraging": "primordia.figures.foraging:draw",
    "threshold": "primordia.figures.threshold:draw",
    "investment": "primordia.figures.investment:draw",
    "traits": "primordia.figures.traits:draw",
    "islands": "primordia.figures.islands:draw",
}
Draw: TypeAlias = Callable[[Records, int], Figure | None]


def plot(
    run: Records, out: Path | None = None, world: int = 0, figures: Sequence[str] = ()
) -> list[Path]:
    """Draw figures of a run, up to its newest checkpoint. Return the files.

    Args:
        run: the run, opened for reading.
        out: folder for the figures; by default `figures` in the run's directory.
        world: the world whose lines of descent are drawn; figures of anything else show all worlds.
        figures: the figures to draw, names in KNOWN or `module:function`; by default all in KNOWN.

    Raises:
        InputError: this is not a run, nothing has lived in it yet, it has no such world, or there
            is no such figure.
        Trouble: a figure cannot be written.
    """
    run.lives.check_world(world)
    if out is None:
        bundle.refuse_changes(run.path)
    # The files of your own figure are named like its function.
    drawing = {name.rpartition(":")[2]: find(name) for name in figures or KNOWN}
    if out is None:
        files.own_folder(folder := run.path / "figures")
    else:
        files.make_folder(folder := out)
    with style.applied():
        drawn = {name: drawing[name](run, world) for name in steps(list(drawing), "drawing")}
        return [
            path
            for name, figure in drawn.items()
            if figure is not None
            for path in style.save(figure, folder / name)
        ]


def find(name: str) -> Draw:
    """Return the function that draws a figure.

    Raises:
        InputError: there is no such figure; the message says why.
    """
    try:
        return parts.load("figure", name, KNOWN)
    except LookupError as error:
        raise InputError(str(error)) from None
