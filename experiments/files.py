"""Files of experiments: the names on the command line, the arms in a file, and where their runs are."""

import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from primordia.settings.tables import merged


def for_each_named(do: Callable[[Path], None], usage: str | None) -> None:
    """Call `do` with each file named on the command line; without a name, print `usage` and exit."""
    if len(sys.argv) < 2:
        sys.exit(usage)
    for name in sys.argv[1:]:
        do(Path(name))


def folder(file: Path) -> Path:
    """Return the folder of an experiment's runs, one for each arm."""
    return Path("runs", "experiments", file.parent.name, file.stem)


def runs(file: Path) -> list[Path]:
    """Return the run of each arm, the reference first."""
    return [folder(file) / name for name in arms(file)]


def arms(file: Path) -> dict[str, dict[str, Any]]:
    """Return the settings of each arm by its name, the task among them.

    The settings of a fork are those of the arm that it comes from, with its own changes.
    """
    values = tomllib.loads(file.read_text(encoding="utf-8"))
    own, fork = values.pop("arms"), values.pop("fork", None)
    values.pop("question", None)
    if fork is not None:
        other, _, name = fork["of"].partition("/")
        values = merged(arms(file.with_name(f"{other}.toml"))[name], values)
    return {arm.pop("name"): merged(values, arm) for arm in own}
