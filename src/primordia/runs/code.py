"""The user's own code in a run: the run holds a copy, which is executed only if the user trusts it.

RUN/code holds the files; their checksums are in the run's description. A run may come from a
stranger, and so may its code. The code is executed only after the user has trusted exactly these
files, once on each machine. Code with which the user has begun a run is trusted.
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path

from platformdirs import user_state_path

from primordia import files, own_code
from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.own_code import Sources
from primordia.runs.description import Description

FOLDER = "code"
_trusted: set[str] = set()
"""Checksums of the files that this process trusts, for the case that they cannot be stored."""


def copy(config: Config, run: Path) -> dict[str, str]:
    """Copy the user's own code into a new run, and trust it. Return each file's SHA-256 by name.

    Raises:
        Trouble: a file cannot be written.
    """
    code = found(config.own_modules)
    for name, source in code.items():
        path = run / FOLDER / name
        files.make_folder(path.parent)
        files.write_bytes(path, source.text)
    trust(code)
    return {name: code[name].sha256 for name in sorted(code)}


def found(modules: Iterable[str]) -> Sources:
    """Return the files of modules that are on `sys.path` or in the current folder."""
    code: Sources = {}
    for module in modules:
        code |= own_code.found(module)
    return code


def of_run(
    run: Path, config: Config, about: Description, parts: Sequence[str], edited: bool
) -> Sources:
    """Return the files of the user's own code that these parts of a run execute.

    Modules without a copy in the run are found on `sys.path` or in the current folder. With
    `edited`, all modules are looked up in these places first.

    Raises:
        Trouble: the copy differs from the description.
    """
    folder, code = run / FOLDER, Sources()
    held = {each.relative_to(folder).as_posix() for each in folder.rglob("*") if not each.is_dir()}
    if held != set(about.code):
        odd = min(held ^ set(about.code))
        raise Trouble(f"{folder / odd} is missing, or was added after the run began")
    for part in parts:
        for module in config.modules_of(part):
            ways = [partial(own_code.below, folder, module), partial(own_code.found, module)]
            code |= next(filter(None, (way() for way in (ways[::-1] if edited else ways))), {})
    for name, source in code.items():
        if source.file == folder / name and source.sha256 != about.code[name]:
            raise Trouble(f"{source.file} was changed or damaged: its checksum differs")
    return code


def admit(run: Path, code: Sources) -> None:
    """Allow the code of a run to be imported.

    Raises:
        InputError: the user has not trusted the code yet, or the process has imported another
            module of the same name.
    """
    if not own_code.is_loaded(code) and not _is_trusted(code):
        names = ", ".join(str(source.file) for source in code.values())
        raise InputError(
            f"{run} executes code from outside installed packages: {names}. Read this code; then add"
            " --trust once, or call primordia.load(run, trust=True)"
        )
    try:
        own_code.admit(code)
    except LookupError as error:
        raise InputError(str(error)) from None


def changes(config: Config, recorded: dict[str, str]) -> list[str]:
    """Return a line for each file, on `sys.path` or in the current folder, that has changed.

    A module that exists only in the run has not changed.
    """
    return [
        f"{source.file} has changed" if name in recorded else f"{source.file} is new"
        for name, source in sorted(found(config.own_modules).items())
        if recorded.get(name) != source.sha256
    ]


def trust(code: Sources) -> None:
    """Trust these files from now on: in this process, and on this machine if their checksums can be
    stored."""
    new = {source.sha256 for source in code.values()} - _stored()
    _trusted.update(new)
    if new:
        with suppress(OSError, RuntimeError):  # the home folder may be unknown
            _store().parent.mkdir(parents=True, exist_ok=True)
            with _store().open("a", encoding="utf-8") as file:
                file.writelines(f"{each}\n" for each in sorted(new))


def _is_trusted(code: Sources) -> bool:
    return {source.sha256 for source in code.values()} <= _trusted | _stored()


def _stored() -> set[str]:
    with suppress(OSError, RuntimeError, ValueError):
        return set(_store().read_text(encoding="utf-8").split())
    return set()


def _store() -> Path:
    """Return the file that holds the checksums of trusted files."""
    return user_state_path("primordia", appauthor=False) / "trusted"
