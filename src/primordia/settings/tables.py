"""Settings of tasks and files as nested tables that are not yet validated."""

import difflib
import tomllib
from copy import deepcopy
from functools import cache
from importlib import resources
from os.path import isfile  # False, and no error, for a name that is too long
from pathlib import Path
from typing import Any

from primordia import files
from primordia.errors import InputError
from primordia.own_code import is_dotted
from primordia.settings import doors
from primordia.settings.values import check_values

NONE = "none"
"""The text for None in TOML and flags."""

PARTS = {"habitat": "name", "brain": "kind", "mutation": "kind"}
"""Tables of replaceable parts, and the setting of each that names the part."""
DEFAULTS = {"brain": "recurrent", "mutation": "gaussian"}
"""Default parts of tables that name no part: those of the paper."""


CODE = ("env", "food")
"""Settings of a part, beside its name, that may be `module:name`."""


def tasks() -> dict[str, dict[str, Any]]:
    """Return the settings of the tasks that come with the package, by name of the task."""
    return deepcopy(_shipped())


@cache
def _shipped() -> dict[str, dict[str, Any]]:
    """Read the files of tasks, once in a process."""
    values_by_task = {}
    for file in sorted(resources.files("primordia.tasks").iterdir(), key=lambda f: f.name):
        if file.name.endswith(".toml"):
            values = tomllib.loads(file.read_text(encoding="utf-8"))
            values_by_task[values["task"]] = values
    return values_by_task


def values_of(task: str) -> dict[str, Any]:
    """Return the settings of a built-in task, a TOML file, or an environment such as gym:CartPole-v1.

    Raises:
        InputError: there is no such task, file or environment, or the file cannot be read.
    """
    return merged(*layers_of(task))


def layers_of(task: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return settings as `values_of` does, and apart from them what a file changes in a built-in task."""
    known = _shipped()
    if task in known:
        return deepcopy(known[task]), {}
    if doors.is_door(task):
        return doors.task(task).table, {}
    if task.endswith(".toml") or isfile(task):
        values = from_toml(Path(task))
        name = str(values.get("task"))
        if name not in known and "habitat" not in values and (near := did_you_mean(name, [*known])):
            raise InputError(f"{task}: there is no task {name!r}{near}")
        return deepcopy(known.get(name, {})), values
    lists = (
        "; give a name that `primordia tasks` lists, a file FILE.toml, or an environment gym:NAME"
    )
    raise InputError(f"there is no task {task!r}{did_you_mean(task, list(known)) or lists}")


def from_toml(path: Path) -> dict[str, Any]:
    """Return the values of a TOML file.

    Paths of genomes and of a habitat's files are relative to the TOML file's folder.

    Raises:
        InputError: the file cannot be read, or is not TOML.
    """
    try:
        values = parsed_toml(files.read(path).decode("utf-8-sig"))
    except ValueError as error:
        raise InputError(f"{path} is not valid TOML: {error}") from None
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    try:
        check_values(values)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    return relative_to(path.parent, values)


def parsed_toml(text: str) -> dict[str, Any]:
    """Return the values of a TOML text; raise ValueError if the text is not TOML."""
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None


def merged(base: dict[str, Any], change: dict[str, Any]) -> dict[str, Any]:
    """Return `base` with the values of `change`, table by table.

    If a table of `change` names another part, this table replaces the whole table of `base`.
    """
    result = dict(base)
    for name, value in change.items():
        old = result.get(name)
        if isinstance(value, dict) and isinstance(old, dict):
            value = value if names_another(name, old, value) else merged(old, value)
        result[name] = value
    return result


def names_another(name: str, old: Any, new: Any) -> bool:
    """Return whether a new table of this name names another part than the old one does."""
    key = PARTS.get(name)
    if key is None or not isinstance(old, dict) or not isinstance(new, dict) or key not in new:
        return False
    return bool(old.get(key, DEFAULTS.get(name)) != new[key])


def code_of(table: dict[str, Any], key: str) -> list[str]:
    """Return the code that a part's table names: `module:name` for its class and its functions. The
    name after the colon may be missing or wrong."""
    named = [str(table.get(each, "")) for each in (key, *CODE)]
    of_islands = [code for inner in habitats_of_islands(table) for code in code_of(inner, key)]
    own = [each for each in named if ":" in each and is_dotted(each.partition(":")[0])]
    return list(dict.fromkeys([*own, *of_islands]))


def habitats_of_islands(table: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the tables of the habitats of islands, which a habitat's table may list."""
    islands = table.get("islands")
    if not isinstance(islands, list | tuple):
        return []
    inner = [each.get("habitat") for each in islands if isinstance(each, dict)]
    return [each for each in inner if isinstance(each, dict)]


def modules_of(table: dict[str, Any], key: str) -> list[str]:
    """Return the modules of the code that a part's table names; see `code_of`."""
    return [each.partition(":")[0] for each in code_of(table, key)]


def relative_to(folder: Path, values: dict[str, Any]) -> dict[str, Any]:
    """Return values from a file in a folder; paths of genomes and of a habitat's files begin there."""
    if isinstance(genomes := values.get("ancestors"), list):
        values = {**values, "ancestors": [str(folder / str(genome)) for genome in genomes]}
    return with_full_paths(folder, values)


def with_full_paths(folder: Path, values: dict[str, Any]) -> dict[str, Any]:
    """Return the values with a full path for each of the habitat's files that is in the folder."""
    habitat = values.get("habitat")
    if not isinstance(habitat, dict):
        return values
    return {**values, "habitat": _full_paths(folder, habitat)}


def _full_paths(folder: Path, table: dict[str, Any]) -> dict[str, Any]:
    """Return a table with full paths of files, also in inner tables."""
    changed = {}
    for name, value in table.items():
        file = folder / str(value)
        full = str(file.resolve()) if _names_file(name) and isfile(file) else value
        if isinstance(value, dict):
            full = _full_paths(folder, value)
        elif isinstance(value, list):
            full = [_full_paths(folder, e) if isinstance(e, dict) else e for e in value]
        changed[name] = full
    return changed


def files_in(table: dict[str, Any]) -> list[str]:
    """Return the values of a table that name files, also in inner tables."""
    lists = (value if isinstance(value, list | tuple) else [value] for value in table.values())
    tables = (each for several in lists for each in several if isinstance(each, dict))
    inner = [file for each in tables for file in files_in(each)]
    own = (value for name, value in table.items() if _names_file(name))
    return inner + [value for value in own if isinstance(value, str)]


def _names_file(setting: str) -> bool:
    """Return whether a setting of a habitat names a file: `file`, or a name such as `map_file`."""
    return setting == "file" or setting.endswith("_file")


def replaced(values: Any, old: Any, new: Any) -> Any:
    """Return nested tables and lists with each `old` replaced by `new`."""
    if isinstance(values, dict):
        return {name: replaced(value, old, new) for name, value in values.items()}
    if isinstance(values, list | tuple):
        return [replaced(value, old, new) for value in values]
    return new if type(values) is type(old) and values == old else values


def flat(values: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return nested tables as one table with dotted names."""
    one: dict[str, Any] = {}
    for name, value in values.items():
        inner = isinstance(value, dict)
        one |= flat(value, f"{prefix}{name}.") if inner else {prefix + name: value}
    return one


def did_you_mean(name: str, known: list[str]) -> str:
    """Return the nearest known name as the end of a sentence; "" if none is near.

    If no whole name is near, the last parts of dotted names are compared, then the beginnings of names.
    """
    of_last = {path.rpartition(".")[2]: path for path in reversed(known)}
    close = difflib.get_close_matches(name, known, 1) or [
        of_last[last] for last in difflib.get_close_matches(name.rpartition(".")[2], of_last, 1)
    ]
    if name and not close:
        close = [each for each in known if each.casefold().startswith(name.casefold())]
    return f"; did you mean {close[0]!r}?" if close else ""
