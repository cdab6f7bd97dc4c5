"""Paths and numbers as arguments and values of options."""

import math
import os
from pathlib import Path
from typing import Any

import click

TICKS = click.IntRange(1, 2**31 - 1)
"""A number of ticks."""
COUNT = click.IntRange(1, 2**16)
"""A number of games, worlds, mutants or other copies of an organism."""


class Finite(click.FloatRange):
    """A number in a range, but neither NaN, which no bound refuses, nor infinity."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number. A wrong value is a usage error."""
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{value!r} is not a finite number", param, ctx)
        return number


class PathType(click.Path):
    """A path; an empty text is a usage error, since Python reads it as the current folder."""

    def __init__(self, **kinds: bool) -> None:
        """Take `file_okay` or `dir_okay` as False if the path cannot be a file or a folder."""
        super().__init__(path_type=Path, **kinds)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the path."""
        if value == "":
            self.fail("the path is empty; `.` is the current folder", param, ctx)
        return super().convert(value, param, ctx)


class OutputPath(PathType):
    """The path of a file or folder to write; a run's own records are never replaced."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the path."""
        from primordia.runs.directory import OWN, VERSIONS

        path = super().convert(value, param, ctx)
        whole = Path(os.path.realpath(path.parent), path.name)
        for run in whole.parents:
            if (run / VERSIONS).is_file() and whole.relative_to(run).parts[0] in OWN:
                self.fail(f"{path} is part of the run {run}; name another path", param, ctx)
        return path
