"""Settings as nested tables that nobody has checked yet: of tasks and files, one put over another."""

import difflib
import tomllib
from importlib import resources
from pathlib import Path
from typing import Any

from primordia.errors import InputError

NONE = "none"
"""How TOML and flags write None."""


PARTS = {"habitat": "name", "brain": "kind", "mutation": "kind"}
"""Tables of replaceable parts, and the setting of each that says which part it is."""


def tasks() -> dict[str, dict[str, Any]]:
    """The tasks that come with the package, by name."""
    found = {}
    for file in sorted(resources.files("primordia.tasks").iterdir(), key=lambda f: f.name):
        if file.name.endswith(".toml"):
            values = tomllib.loads(file.read_text())
            found[values["task"]] = values
    return found


def values_of(task: str) -> dict[str, Any]:
    """What a built-in task or a TOML file says.

    Raises:
        InputError: there is neither, or the file cannot be read.
    """
    known = tasks()
    if task in known:
        return known[task]
    if task.endswith(".toml") or Path(task).is_file():
        values = from_toml(Path(task))
        return merged(known.get(str(values.get("task")), {}), values)
    raise InputError(
        f"there is no task {task!r}{did_you_mean(task, list(known))}; `primordia tasks` lists them,"
        " or give a file FILE.toml"
    )


def from_toml(path: Path) -> dict[str, Any]:
    """The values in a TOML file; genomes, and the file a habitat is made from, are looked for beside it.

    Raises:
        InputError: it cannot be read, or is not TOML.
    """
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path} is not valid TOML: {error}") from None
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    if isinstance(files := values.get("ancestors"), list):
        values["ancestors"] = [str(path.parent / str(each)) for each in files]
    return found_in(path.parent, values)


def merged(base: dict[str, Any], change: dict[str, Any]) -> dict[str, Any]:
    """`base` with the values of `change` put in, table by table.

    A table that names another part than before keeps nothing of the old one's settings.
    """
    result = dict(base)
    for name, value in change.items():
        old, key = result.get(name), PARTS.get(name)
        if isinstance(value, dict) and isinstance(old, dict):
            exchanged = key in old and key in value and old[key] != value[key]
            value = value if exchanged else merged(old, value)
        result[name] = value
    return result


def found_in(folder: Path, values: dict[str, Any]) -> dict[str, Any]:
    """Values in which files that a habitat is made from, if they are in the folder, have full paths."""
    habitat = values.get("habitat")
    if not isinstance(habitat, dict):
        return values
    return {**values, "habitat": _full_paths(folder, habitat)}


def _full_paths(folder: Path, table: dict[str, Any]) -> dict[str, Any]:
    """Of each `file` in a table and in those within it."""
    found = {}
    for name, value in table.items():
        file = folder / str(value)
        full = str(file.resolve()) if name == "file" and file.is_file() else value
        found[name] = _full_paths(folder, value) if isinstance(value, dict) else full
    return found


def replaced(values: Any, old: Any, new: Any) -> Any:
    """Nested tables and lists with one value put for another."""
    if isinstance(values, dict):
        return {name: replaced(value, old, new) for name, value in values.items()}
    if isinstance(values, list | tuple):
        return [replaced(value, old, new) for value in values]
    return new if type(values) is type(old) and values == old else values


def did_you_mean(name: str, known: list[str]) -> str:
    """The nearest of the names that are known, as the end of a sentence; "" if none is near."""
    close = difflib.get_close_matches(name, known, 1) or [
        path for path in known if path.rpartition(".")[2] == name.rpartition(".")[2]
    ]
    return f"; did you mean {close[0]!r}?" if close else ""
