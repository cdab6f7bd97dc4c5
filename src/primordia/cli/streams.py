"""The standard streams of a command: in UTF-8, and without control characters of a run's names."""

import io
import os
import sys
from contextlib import suppress

import click

from primordia.printable import printable


class Printable(io.TextIOWrapper):
    """A stream of text on which control characters are spelled out."""

    def write(self, text: str) -> int:
        """Write a text -> its length."""
        super().write(printable(text))
        return len(text)


def prepare() -> None:
    """Replace the standard streams of this process by ones that take any text."""
    if isinstance(sys.__stdout__, io.TextIOWrapper):  # the live view writes escape sequences to it
        sys.__stdout__.reconfigure(encoding="utf-8", errors="backslashreplace")
    sys.stdout, sys.stderr = _stream(1), _stream(2)


def _stream(number: int) -> Printable:
    file = open(number, "wb", closefd=False)  # noqa: SIM115
    lines = number == 2 or file.isatty()
    return Printable(file, "utf-8", "backslashreplace", line_buffering=lines)


def flush() -> None:
    """Flush the streams; what cannot be written is dropped, since Python would try again at its end."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def report(message: object) -> None:
    """Print a message as one line on stderr."""
    line = " ".join(map(str.strip, str(message).splitlines()))
    with suppress(OSError):  # the stream may be closed, and then there is no other place to say so
        click.echo(f"primordia: {printable(line)}", err=True)
