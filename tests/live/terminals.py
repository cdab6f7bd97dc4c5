"""A pseudo-terminal of 80 x 24 in which commands run."""

import os
import pty
import re
import select
import subprocess
import termios
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tests.commands import COMMAND, environment

SETTINGS = {"TERM": "xterm-256color", "COLUMNS": "80", "LINES": "24", "COLORTERM": "truecolor"}


class Terminal:
    """Both ends of a pseudo-terminal."""

    def __init__(self, ours: int, theirs: int) -> None:
        self.ours, self.theirs = ours, theirs

    def begin(self, *words: object, keys: str | None = None) -> subprocess.Popen[bytes]:
        """Start a command whose controlling terminal this is, so that it gets keys and Ctrl-C.

        `keys` is a file that it reads in place of the terminal.
        """
        variables = environment() | SETTINGS
        variables.pop("NO_COLOR", None)
        take = 'exec <"$0" >"$0" 2>&1 "$@"' if keys is None else f'exec >"$0" 2>&1 "$@" <{keys}'
        shell = ["sh", "-c", take, os.ttyname(self.theirs)]
        return subprocess.Popen(
            [*shell, *COMMAND, *map(str, words)], env=variables, start_new_session=True
        )

    def read_until(self, *parts: str, seconds: float = 60.0) -> str:
        """Return what is written until all parts are in it."""
        read = ""
        while not all(part in read for part in parts):
            ready = select.select([self.ours], [], [], seconds)[0]
            assert ready, f"nothing more after {read[-500:]!r}"
            read += os.read(self.ours, 65536).decode(errors="replace")
        return read

    def read_match(self, pattern: str, seconds: float = 60.0) -> str:
        """Return the first group of a pattern, once it is in what is written without colours."""
        read = ""
        while not (
            found := re.search(pattern, re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", read), re.DOTALL)
        ):
            assert select.select([self.ours], [], [], seconds)[0], f"no match in {read[-500:]!r}"
            read += os.read(self.ours, 65536).decode(errors="replace")
        return found[1]

    def press(self, keys: bytes) -> None:
        """Press keys."""
        os.write(self.ours, keys)

    def modes(self) -> list[Any]:
        """Return the modes of the terminal, such as whether it prints the keys that are pressed."""
        return termios.tcgetattr(self.theirs)


@contextmanager
def opened() -> Iterator[Terminal]:
    """Open a terminal in a `with` block."""
    ours, theirs = pty.openpty()
    try:
        yield Terminal(ours, theirs)
    finally:
        os.close(ours)
        os.close(theirs)
