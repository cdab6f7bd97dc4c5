"""Opening of places that a user names: a run, an arm's folder of runs, or several runs as one arm."""

import re
from collections.abc import Sequence
from glob import glob, has_magic
from pathlib import Path

from primordia import files
from primordia.errors import InputError
from primordia.runs import bundle, checkpoint, directory
from primordia.runs.archive import Archive
from primordia.runs.arm import arm
from primordia.runs.records import Records

EXPERIMENT = "experiment.toml"
"""The file that marks the folder of an experiment; its arms are folders beside this file."""


def opened(places: Sequence[str | Path], name: str | None = None) -> Records:
    """Open a run by its directory, or several runs as one arm.

    Args:
        places: directories of runs, bundles, folders that hold runs, and patterns, such as `runs/h*`.
        name: the arm's name.

    Raises:
        InputError: there is no run, or the runs do not belong to one arm.
    """
    paths = [path for place in places for path in run_paths(Path(place))]
    if [Path(place) for place in places] == paths and len(paths) == 1 and name is None:
        return archive(paths[0])
    runs = sorted(map(archive, paths), key=lambda run: run.config.seed)
    return arm(Path(name if name is not None else str(places[0])), runs)


def only(places: Sequence[str | Path]) -> Archive:
    """Open the single run at some places; raise InputError if there are several, or none."""
    paths = [path for place in places for path in run_paths(Path(place))]
    if len(paths) > 1:
        raise InputError(
            f"{places[0]} is an arm of {len(paths)} runs, but a single run is needed here, such as"
            f" {paths[0]}"
        )
    return archive(paths[0])


def archive(path: Path) -> Archive:
    """Open a run by its directory or its bundle."""
    return Archive(bundle.opened(path) if path.is_file() else path)


def run_paths(place: Path) -> list[Path]:
    """Return the directories and bundles of the runs at a place, in order of names.

    Raises:
        InputError: there is no run.
    """
    files.check_name(place)
    if (place / EXPERIMENT).is_file():
        arms = ", ".join(str(path) for path in arm_paths(place)) or "none has begun yet"
        raise InputError(f"{place} is an experiment; name one of its arms: {arms}")
    if not place.exists() and has_magic(str(place)):
        found = [path for each in sorted(glob(str(place))) for path in run_paths(Path(each))]
        if not found:
            raise InputError(f"there is no run {place}")
        return found
    inner = sorted(place.iterdir()) if place.is_dir() and not _is_run(place) else []
    begun = [path for path in inner if _is_run(path) and checkpoint.exists(path)]
    if not begun and any(map(_is_run, inner)):
        raise InputError(f"{place} has no checkpoint of any of its runs yet")
    return begun or [place]


def arm_paths(experiment: Path) -> list[Path]:
    """Return the folders of an experiment that hold runs, in order of names."""
    folders = (path for path in sorted(experiment.iterdir()) if path.is_dir())
    return [path for path in folders if any(map(_is_run, path.iterdir()))]


def split_name(place: str) -> tuple[str | None, str]:
    """Return the name and the place of a text `name=place`; the name is None if the text has none."""
    named = re.fullmatch(r"([^=/*?\[\]]+)=(.+)", place, re.DOTALL)
    if named is None or Path(place).exists():
        return None, place
    return named[1], named[2]


def _is_run(path: Path) -> bool:
    return (path / directory.VERSIONS).is_file()
