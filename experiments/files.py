"""Files of experiments: those named on the command line, and where their runs are."""

import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from primordia.settings.tables import merged


def each(do: Callable[[Path], None], usage: str | None) -> None:
    """Do it with all files named, one after the other."""
    if len(sys.argv) < 2:
        sys.exit(usage)
    for name in sys.argv[1:]:
        do(Path(name))


def folder(file: Path) -> Path:
    """Where the runs of an experiment are, one an arm."""
    return Path("runs", "experiments", file.parent.name, file.stem)


def runs(file: Path) -> list[Path]:
    """Of each arm, the reference first."""
    return [folder(file) / name for name in arms(file)]


def arms(file: Path) -> dict[str, dict[str, Any]]:
    """Settings of each arm by its name, the task among them; a fork's, on top of those it comes from."""
    values = tomllib.loads(file.read_text(encoding="utf-8"))
    own, fork = values.pop("arms"), values.pop("fork", None)
    values.pop("question", None)
    if fork is not None:
        other, _, name = fork["of"].partition("/")
        values = merged(arms(file.with_name(f"{other}.toml"))[name], values)
    return {arm.pop("name"): merged(values, arm) for arm in own}
