"""The bar of progress of commands that take longer than two seconds, on a terminal."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from primordia import progress
from primordia.cli import streams

PATIENCE = 2.0
"""Seconds for which a command shows no bar."""


class Patient(Progress):
    """A bar that is not drawn at first, so commands that are quick show none."""

    def get_renderables(self) -> Iterator[RenderableType]:
        """Yield the bar, or nothing before its time."""
        if any((task.elapsed or 0) > PATIENCE for task in self.tasks):
            yield from super().get_renderables()


@contextmanager
def bar() -> Iterator[Progress]:
    """Show on stderr what the command does, and how far it is, until it prints something."""
    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    # The stream is not the one that spells out escapes. The bar leaves the streams of Python alone.
    console = Console(file=sys.__stderr__)
    shown = Patient(
        *columns, console=console, transient=True, redirect_stdout=False, redirect_stderr=False
    )
    task = shown.add_task("reading", total=None)

    def display(work: str, share: float) -> None:
        shown.update(task, description=work, total=1.0, completed=share)

    with shown, progress.shown(display), streams.before_output(shown.stop):
        yield shown
