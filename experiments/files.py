"""Files of experiments: those named on the command line, and where their runs are."""

import sys
import tomllib
from collections.abc import Callable
from pathlib import Path


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
    arms = tomllib.loads(file.read_text(encoding="utf-8"))["arms"]
    return [folder(file) / arm["name"] for arm in arms]
