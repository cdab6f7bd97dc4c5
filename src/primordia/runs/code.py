"""The user's own code in a run: the run holds a copy, which is executed only if the user trusts it.

RUN/code holds the files; their checksums are in the run's description. A run may come from a
stranger, and so may its code. The code is executed only after the user has trusted exactly these
files, once on each machine. Code with which the user has begun a run is trusted.

A run may also name classes and functions of installed packages. Even an installed function can do
harm if a stranger chooses it. So they are trusted by name, except those of `own_code.LIBRARIES`.
"""

import hashlib
import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple

from platformdirs import user_state_path

from primordia import files, own_code
from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.own_code import Source, Sources
from primordia.runs.description import Description
from primordia.settings.tables import PARTS

FOLDER = "code"
_trusted: set[str] = set()
"""Marks of the code that this process trusts, for the case that they cannot be stored."""


class Code(NamedTuple):
    """The code that a run executes, beside Primordia's own and that of its libraries."""

    files: Sources
    """files outside installed packages"""
    installed: frozenset[str] = frozenset()
    """parts of installed packages, as `module:name` or as a module"""

    @property
    def marks(self) -> set[str]:
        """The checksum of each file with its name, and of the name of each installed part."""
        files = (
            b"file\0%s\0%s" % (name.encode(), source.text) for name, source in self.files.items()
        )
        installed = (b"installed\0%s" % name.encode() for name in self.installed)
        return {hashlib.sha256(each).hexdigest() for each in (*files, *installed)}

    @property
    def names(self) -> str:
        """The files and the installed parts, for a message."""
        return ", ".join([*(str(source.file) for source in self.files.values()), *self.installed])


def copy(config: Config, run: Path) -> dict[str, str]:
    """Copy the user's own code into a new run, and trust it. Return each file's SHA-256 by name.

    Raises:
        InputError: the code looks for files beside it; the copy would have none.
        Trouble: a file cannot be written.
    """
    code = found(config)
    for name, source in code.files.items():
        root = source.file.parents[name.count("/")]
        of_run = root.name == FOLDER and (root.parent / "config.toml").exists()  # such as a fork's
        if source.knows_its_place and not of_run:
            raise InputError(
                f"{source.file} asks for its own place (`__file__`), but a run executes a copy of it"
                " without the files beside it; install it as a package (pip install .), or let a"
                " setting of the habitat name the file that it reads"
            )
        path = run / FOLDER / name
        files.make_folder(path.parent)
        files.write_bytes(path, source.text)
    trust(code)
    return {name: code.files[name].sha256 for name in sorted(code.files)}


def found(config: Config) -> Code:
    """Return the code that the settings name and that is installed, on `sys.path` or in the current
    folder."""
    sources: Sources = {}
    for module in config.own_modules:
        sources |= own_code.found(module)
    return Code(sources, _installed(config, PARTS))


def _installed(config: Config, parts: Iterable[str]) -> frozenset[str]:
    """Return the parts of installed packages, other than libraries, that settings name."""
    named = [each for part in parts for each in config.code_of(part)]
    modules = {each: each.partition(":")[0] for each in named}
    return frozenset(
        each
        for each, module in modules.items()
        if module not in own_code.LIBRARIES and own_code.is_installed(module)
    )


def of_run(
    run: Path, config: Config, about: Description, parts: Sequence[str], edited: bool
) -> Code:
    """Return the code that these parts of a run execute.

    Modules without a copy in the run are found on `sys.path` or in the current folder. With
    `edited`, all modules are looked up in these places first.

    Raises:
        Trouble: the copy differs from the description.
    """
    folder, sources = run / FOLDER, Sources()
    check_files(folder, set(about.code))
    for part in parts:
        for module in (each.partition(":")[0] for each in config.code_of(part)):
            ways = [partial(own_code.below, folder, module), partial(own_code.found, module)]
            sources |= next(filter(None, (way() for way in (ways[::-1] if edited else ways))), {})
    if not edited:  # code may import the other files in ways that reading does not show
        held = {name: Source(folder / name, (folder / name).read_bytes()) for name in about.code}
        sources = {**held, **sources} if sources else {}
    for name, source in sources.items():
        if source.file == folder / name and source.sha256 != about.code[name]:
            raise Trouble(f"{source.file} was changed or damaged: its checksum differs")
    return Code(sources, _installed(config, parts))


def check_files(folder: Path, described: set[str]) -> None:
    """Raise Trouble unless the folder of a run's code holds exactly the described files."""
    if folder.is_symlink():
        raise Trouble(f"{folder} is a symbolic link; put the run's own folder in its place")
    # Other folders are not read, since a forged run may hold very many.
    folders = {str(parent) for name in described for parent in Path(name).parents}
    waiting, held = [folder] if folder.is_dir() else [], set[str]()
    while waiting:
        with os.scandir(waiting.pop()) as entries:
            for each in entries:
                name = Path(each.path).relative_to(folder).as_posix()
                if each.is_dir(follow_symlinks=False) and name in folders:
                    waiting.append(Path(each.path))
                elif name in described and not each.is_file():  # a pipe could block for ever
                    raise Trouble(
                        f"{each.path} is not a regular file; put the run's own in its place"
                    )
                else:
                    held.add(name)
    if held != described:
        odd = min(held ^ described)
        raise Trouble(f"{folder / odd} is missing, or was added after the run began")


def admit(run: Path, code: Code) -> None:
    """Allow the code of a run to be executed.

    Raises:
        InputError: the user has not trusted the code yet, or the process has imported another
            module of the same name.
    """
    asked = Code({} if own_code.is_loaded(code.files) else code.files, code.installed)
    if not asked.marks <= _trusted | _stored():
        raise InputError(
            f"{run} executes code that Primordia does not know: {asked.names}. Read this code; then"
            " add --trust once, or call primordia.load(run, trust=True)"
        )
    try:
        own_code.admit(code.files)
    except LookupError as error:
        raise InputError(str(error)) from None


def changes(config: Config, recorded: dict[str, str]) -> list[str]:
    """Return a line for each file, on `sys.path` or in the current folder, that has changed.

    A module that exists only in the run has not changed.
    """
    return [
        f"{source.file} has changed" if name in recorded else f"{source.file} is new"
        for name, source in sorted(found(config).files.items())
        if recorded.get(name) != source.sha256
    ]


def trust(code: Code) -> None:
    """Trust this code from now on: in this process, and on this machine if its marks can be stored."""
    new = code.marks - _stored()
    _trusted.update(new)
    if new:
        with suppress(OSError, RuntimeError):  # the home folder may be unknown
            _store().parent.mkdir(parents=True, exist_ok=True)
            with _store().open("a", encoding="utf-8") as file:
                file.writelines(f"{each}\n" for each in sorted(new))


def _stored() -> set[str]:
    with suppress(OSError, RuntimeError, ValueError):
        return set(_store().read_text(encoding="utf-8").split())
    return set()


def _store() -> Path:
    """Return the file that holds the marks of trusted code."""
    return user_state_path("primordia", appauthor=False) / "trusted"
