"""The standard streams of a command: UTF-8, without control characters."""

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import click

from primordia.errors import Trouble
from primordia.printable import printable

LONGEST = 2000
"""Largest length of a message, in characters."""


class Printable(io.TextIOWrapper):
    """A stream of text on which control characters are spelled out."""

    def write(self, text: str) -> int:
        """Write a text. Return its length."""
        with self._named():
            super().write(printable(text))
        return len(text)

    def flush(self) -> None:
        """Write what is left.

        Raises:
            Trouble: it cannot be written, such as to a file on a full disk.
        """
        with self._named():
            super().flush()

    @contextmanager
    def _named(self) -> Iterator[None]:
        try:
            yield
        except BrokenPipeError:  # the reader has read enough
            raise
        except OSError as error:
            name = "standard error" if self.fileno() == 2 else "standard output"
            raise Trouble(f"{name} cannot be written: {error.strerror or error}") from None


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
    return Printable(file, "utf-8", "backslashreplace", line_buffering=lines)


def flush() -> None:
    """Flush the streams; drop text that cannot be written, or Python would try again at exit."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (OSError, Trouble):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def report(message: object) -> None:
    """Print a message as one line on stderr."""
    line = " ".join(map(str.strip, str(message).splitlines()))
    if len(line) > LONGEST:  # a stranger's file may hold a name of a megabyte
        line = f"{line[:LONGEST]}..."
    with suppress(
        OSError, Trouble
    ):  # stderr may be closed, and there is no other place for the message
        click.echo(f"primordia: {printable(line)}", err=True)
