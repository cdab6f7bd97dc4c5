"""The experiments that a script is called with: their files, and the arms that have been run."""

import sys
from collections.abc import Callable
from pathlib import Path

from primordia.experiments import campaign


def for_each_named(do: Callable[[Path], None], usage: str | None) -> None:
    """Call `do` with each file named on the command line; without a name, print `usage` and exit."""
    if len(sys.argv) < 2:
        sys.exit(usage)
    for name in sys.argv[1:]:
        do(Path(name))


def arms(file: Path) -> list[Path]:
    """Return the folder of each arm's runs, the reference first."""
    return list(campaign.recorded(Path("runs", file.stem)).arms.values())
