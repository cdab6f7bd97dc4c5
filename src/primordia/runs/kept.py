"""The files that the settings of a run's habitat name, such as a model of MuJoCo.

RUN/files holds a copy of each, with the files that it needs, such as includes, meshes and textures;
their checksums are in the run's description. All lives of the run use these copies. So a run can be
moved, sent and lived again without the original files.
"""

import os
from collections.abc import Iterable, Mapping
from os.path import isfile  # False, and no error, for a name that is too long
from pathlib import Path

from primordia import files
from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.habitats import contract as habitats
from primordia.habitats.contract import AnyHabitat
from primordia.runs import code
from primordia.runs.description import Description
from primordia.settings.tables import files_in

FOLDER = "files"


def copy(config: Config, habitat: AnyHabitat, run: Path) -> tuple[str, dict[str, str]]:
    """Copy the files that settings name into a new run, with the files that they need.

    Returns:
        the folder in which they were found, where all paths begin; the SHA-256 of each, by its path
        below that folder and below the run's.

    Raises:
        InputError: a file has a name that some systems do not allow, or names another file by its
            full path, so that the copies make another habitat.
        Trouble: a file cannot be read or written.
    """
    named = [each for each in files_in(config.habitat) if os.path.isabs(each) and isfile(each)]
    paths = [Path(path) for path in _needed(config, {each: each for each in named})]
    if not paths:
        return "", {}
    found_in = Path(os.path.commonpath([path.parent for path in paths]))
    names = sorted({path.relative_to(found_in).as_posix() for path in paths})
    for name in names:
        if not all(map(files.is_plain, name.split("/"))):
            raise InputError(f"{found_in / name}: a run cannot hold a file of this name; rename it")
        files.make_folder((run / FOLDER / name).parent)
        try:
            files.write_bytes(run / FOLDER / name, (found_in / name).read_bytes())
        except OSError as error:
            raise Trouble(f"{found_in / name} cannot be read: {error.strerror}") from None
    places = _places(run, str(found_in), names)
    if not _is_whole(config.keeping(places), habitat, {*places.values()}):
        raise InputError(
            f"{named[0]} needs a file that is named by its full path, so a run cannot hold both;"
            " give the path from the folder of the file that names it"
        )
    return str(found_in), {name: files.sha256(run / FOLDER / name) for name in names}


def _is_whole(config: Config, habitat: AnyHabitat, copies: set[str]) -> bool:
    """Return whether a habitat can be made of copies alone, and is the same."""
    try:
        return (
            _needed(config, config.kept) <= copies
            and config.build_habitat().versions == habitat.versions
        )
    except InputError:
        return False


def keeping(config: Config, run: Path, about: Description, edited: bool) -> Config:
    """Return the settings of a run with the run's copies of files in place of the originals.

    With `edited`, copies are used only for originals that are missing.
    """
    places = _places(run, about.files_from, about.files)
    return config.keeping(
        {original: path for original, path in places.items() if not (edited and isfile(original))}
    )


def check(config: Config, run: Path, about: Description) -> None:
    """Check the copies before a habitat is made of them.

    Raises:
        Trouble: a copy is missing or changed, or needs a file that the run does not hold.
    """
    code.check_files(run / FOLDER, set(about.files))
    for name, sha256 in about.files.items():
        if files.sha256(run / FOLDER / name) != sha256:
            raise Trouble(f"{run / FOLDER / name} was changed or damaged: its checksum differs")
    try:
        more = _needed(config, kept) - {*kept.values()} if (kept := config.kept) else set()
    except ValueError as error:
        raise Trouble(f"{run / FOLDER} cannot be read: {error}") from None
    if more:
        raise Trouble(f"{run / FOLDER} does not hold {min(more)}, which one of its files needs")


def changes(about: Description) -> list[str]:
    """Return a line for each original that has changed; an original that is missing has not."""
    originals = ((Path(about.files_from, name), sha) for name, sha in about.files.items())
    return [
        f"{path} has changed"
        for path, sha256 in originals
        if isfile(path) and files.sha256(path) != sha256
    ]


def _places(run: Path, found_in: str, names: Iterable[str]) -> dict[str, str]:
    """Return the path of the copy of each original."""
    folder = (run / FOLDER).absolute()
    return {str(Path(found_in, name)): str(folder / name) for name in names}


def _needed(config: Config, places: Mapping[str, str]) -> set[str]:
    """Return the files that settings name, at their places, and those that these need."""
    tables = [each.habitat for each in config.by_island]
    return {
        path
        for table in tables
        for named in files_in(table)
        if named in places
        for path in habitats.find(table["name"]).files_with(places[named])
    }
