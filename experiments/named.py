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
    """Return the folder of the runs of each arm that has been run, the reference first."""
    folders = campaign.recorded(Path("runs", file.stem)).arms.values()
    return [folder for folder in folders if folder.is_dir()]
