"""The user's own code in a run: a copy of it, and whether it may be executed.

RUN/code holds the files; their checksums are in the run's description. A run may come from a
stranger, and so may its code. It is executed only after the user has trusted exactly these files, once on
a machine. Code that a user has begun a run with is trusted.
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path

from platformdirs import user_state_path

from primordia import files, own_code
from primordia.config import Config
from primordia.errors import InputError
from primordia.own_code import Sources

FOLDER = "code"


def copy(config: Config, run: Path) -> dict[str, str]:
    """Copy the user's own code into a new run, and trust it -> SHA-256 of each file, by its name.

    Raises:
        Trouble: a file cannot be written.
    """
    code = _sources(config.own_modules.values(), [Path.cwd()])
    for name, file in code.items():
        path = run / FOLDER / name
        files.make_folder(path.parent)
        files.write(path, partial(_fill, text=file.read_bytes()))
    checksums = own_code.checksums(code)
    _trust(checksums)
    return checksums


def _fill(path: Path, text: bytes) -> None:
    path.write_bytes(text)


def in_use(run: Path, config: Config, parts: Sequence[str]) -> Sources:
    """Return the files of the user's own code that these parts of a run would execute here.

    Files on `sys.path` and in the current folder come before the run's copy.
    """
    modules = config.own_modules
    wanted = [modules[part] for part in parts if part in modules]
    return _sources(wanted, [Path.cwd(), run / FOLDER])


def admit(run: Path, code: Sources) -> None:
    """Let the code of a run be imported.

    Raises:
        InputError: the user has not trusted it yet.
    """
    if not own_code.is_loaded(code) and not _is_trusted(own_code.checksums(code)):
        names = ", ".join(map(str, code.values()))
        raise InputError(
            f"{run} executes code that is not of an installed package: {names}. Read it; then add"
            " --trust once, or call primordia.load(run, trust=True)"
        )
    own_code.admit(code)


def trust(code: Sources) -> None:
    """Trust this code from now on, on this machine."""
    _trust(own_code.checksums(code))


def changes(code: Sources, recorded: dict[str, str]) -> list[str]:
    """Return a line for each file that is not as it was when the run began."""
    now = own_code.checksums(code)
    differ = sorted(name for name in {*now, *recorded} if now.get(name) != recorded.get(name))
    return [_change(name, code, recorded) for name in differ]


def _change(name: str, code: Sources, recorded: dict[str, str]) -> str:
    if name not in recorded:
        return f"{code[name]} is new"
    return f"{code[name]} has changed" if name in code else f"{name} is no longer used"


def _sources(modules: Iterable[str], folders: Sequence[Path]) -> Sources:
    code: Sources = {}
    for module in modules:
        code |= own_code.sources(module, folders)
    return code


def _record() -> Path:
    return user_state_path("primordia", appauthor=False) / "trusted"


def _is_trusted(checksums: dict[str, str]) -> bool:
    with suppress(OSError):
        return own_code.fingerprint(checksums) in _record().read_text(encoding="utf-8").split()
    return False


def _trust(checksums: dict[str, str]) -> None:
    if not checksums or _is_trusted(checksums):
        return
    with suppress(OSError):  # without a folder to write to, the user is asked again
        _record().parent.mkdir(parents=True, exist_ok=True)
        with _record().open("a", encoding="utf-8") as file:
            file.write(own_code.fingerprint(checksums) + "\n")
