"""The standard streams of a command: UTF-8, without control characters."""

import io
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import click

from primordia.printable import printable

LONGEST = 2000
"""Largest length of a message, in characters."""


class Printable(io.TextIOWrapper):
    """A stream of text on which control characters are spelled out."""

    title = "standard output"
    """name of the stream in errors"""
    before: Callable[[], object] | None = None
    """called once before the next output of any such stream; it removes what else is on the screen"""

    def write(self, text: str) -> int:
        """Write a text. Return its length."""
        if (before := Printable.before) is not None:
            Printable.before = None
            before()
        with self._named():
            super().write(printable(text))
        return len(text)

    def flush(self) -> None:
        """Write what is left."""
        with self._named():
            super().flush()

    @contextmanager
    def _named(self) -> Iterator[None]:
        """Name the stream in the error if it cannot be written, such as to a file on a full disk."""
        try:
            yield
        except OSError as error:
            raise OSError(error.errno, error.strerror, self.title) from None


@contextmanager
def before_output(call: Callable[[], object]) -> Iterator[None]:
    """Call a function once before the first output of the `with` block."""
    Printable.before = call
    try:
        yield
    finally:
        Printable.before = None


def prepare() -> None:
    """Replace the standard streams of this process by streams that accept any text."""
    if isinstance(
        sys.__stdout__, io.TextIOWrapper
    ):  # the live view writes escape sequences to this stream
        sys.__stdout__.reconfigure(encoding="utf-8", errors="backslashreplace")
    sys.stdout, sys.stderr = _stream(1), _stream(2)


def _stream(number: int) -> Printable:
    file = open(number, "wb", closefd=False)  # noqa: SIM115
    lines = number == 2 or file.isatty()
    stream = Printable(file, "utf-8", "backslashreplace", line_buffering=lines)
    stream.title = {1: "standard output", 2: "standard error"}[number]
    return stream


def flush() -> None:
    """Flush the streams; drop text that cannot be written, or Python would try again at exit."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def report(message: object) -> None:
    """Print a message as one line on stderr."""
    line = " ".join(map(str.strip, str(message).splitlines()))
    if len(line) > LONGEST:  # a stranger's file may hold a name of a megabyte
        line = f"{line[:LONGEST]}..."
    with suppress(OSError):  # stderr may be closed, and there is no other place for the message
        click.echo(f"primordia: {printable(line)}", err=True)
