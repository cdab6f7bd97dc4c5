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

    def begin(self, *words: object) -> subprocess.Popen[bytes]:
        """Start a command whose controlling terminal this is, so that it gets keys and Ctrl-C."""
        variables = environment() | SETTINGS
        variables.pop("NO_COLOR", None)
        shell = ["sh", "-c", 'exec <"$0" >"$0" 2>&1 "$@"', os.ttyname(self.theirs)]
        return subprocess.Popen(
            [*shell, *COMMAND, *map(str, words)], env=variables, start_new_session=True
        )

    def read_until(self, *parts: str, pattern: str = "") -> str:
        """Return what is written, until all parts are in it, and a pattern in it without colours.

        With a pattern, return its first group.
        """
        read, found = "", None
        while not all(part in read for part in parts) or found is None:
            assert select.select([self.ours], [], [], 60.0)[0], f"no more after {read[-500:]!r}"
            read += os.read(self.ours, 65536).decode(errors="replace")
            found = re.search(pattern, re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", read), re.DOTALL)
        return found[1] if pattern else read

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
