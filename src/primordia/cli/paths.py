"""Paths as arguments and values of options."""

from pathlib import Path
from typing import Any

import click


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
