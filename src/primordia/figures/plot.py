"""Figures of a run: what its records show, as PNG and SVG."""

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.figures import ages, foraging, population, spacetime, style, survival
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives

FIGURES: dict[str, Callable[[Lives, Config, int], Figure]] = {
    "ages": lambda lives, config, world: ages.draw(lives.since_fork()),
    "survival": lambda lives, config, world: survival.draw(lives.since_fork()),
    "population": lambda lives, config, world: population.draw(lives.since_fork(), config.cells),
    "space-time": spacetime.draw,
}


def plot(run: Archive, out: Path | None = None, world: int = 0) -> list[Path]:
    """Draw every figure of a run, up to its newest checkpoint -> the files made.

    Args:
        run: opened for reading.
        out: folder for the figures; by default `figures` in the run.
        world: whose lines of descent are drawn; all other figures show all worlds.

    Raises:
        InputError: this is no run, nothing has lived in it yet, or it has no such world.
        Trouble: a figure cannot be written.
    """
    config, found = run.config, run.lives
    if not 0 <= world < config.seeds:
        raise InputError(
            f"{run.path} has no world {world}; they count from 0 to {config.seeds - 1}"
        )
    folder = out if out is not None else run.path / "figures"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Trouble(f"{folder} cannot be made: {error.strerror or error}") from None
    with style.look():
        drawn = {name: draw(found, config, world) for name, draw in FIGURES.items()}
        if config.metabolism is not None:
            drawn["foraging"] = foraging.draw(run)
        return [
            path for name, figure in drawn.items() for path in style.save(figure, folder / name)
        ]
