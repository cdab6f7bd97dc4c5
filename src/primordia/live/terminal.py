"""The user's terminal: keys without Enter; settings and cursor are restored however a command ends."""

import os
import re
import select
import sys
import termios
import time
import tty
from typing import Any

SEQUENCE = re.compile(r"\x1b(\[[0-9;?]*[@-~]|O.|.)?", re.DOTALL)
"""Pattern of the codes of keys such as arrows; these keys have no meaning here."""


def show_cursor() -> None:
    """Write the escape sequence that shows the cursor, without any lock."""
    os.write(1, b"\x1b[?25h\r\n")


class Keyboard:
    """The keys that are pressed, in a `with` block; no keys if the input is not a terminal.

    The terminal hands over each key at once and does not print it. Ctrl-C still sends SIGINT. A
    command in the background does not change the terminal, since the system would stop the command.
    """

    def __init__(self) -> None:
        self._before: list[Any] | None = None

    def __enter__(self) -> "Keyboard":
        try:
            self._file = sys.__stdin__.fileno() if sys.__stdin__ else -1
            self._before = termios.tcgetattr(self._file)
            if self._in_front():
                self._take()
        except (termios.error, ValueError):
            self._before = None
        return self

    def __exit__(self, *error: object) -> None:
        self.restore()

    @property
    def there(self) -> bool:
        """Whether keys can be read."""
        return self._before is not None

    def restore(self) -> None:
        """Give the terminal back as it was, without any lock; a terminal that is gone is no error."""
        if self._before is not None and self._in_front():
            try:
                termios.tcsetattr(self._file, termios.TCSANOW, self._before)
            except termios.error:
                self._before = None

    def pressed(self, seconds: float) -> str:
        """Return the keys pressed since the last call; `seconds` is the longest wait for a key.

        A signal does not end the wait.
        """
        if self._before is None or not self._in_front():
            if seconds:
                time.sleep(seconds)
            return ""
        try:
            self._take()
            if not select.select([self._file], [], [], seconds)[0] or not self._in_front():
                return ""
            keys = os.read(self._file, 1024)
        except (OSError, termios.error):
            keys = b""
        if not keys:  # the terminal is gone
            self._before = None
        return SEQUENCE.sub("", keys.decode(errors="ignore"))

    def _take(self) -> None:
        """Take the terminal, and take it again after Ctrl-Z and `fg`, since the shell changes its
        mode."""
        if termios.tcgetattr(self._file)[3] & termios.ICANON:
            tty.setcbreak(self._file, termios.TCSANOW)

    def _in_front(self) -> bool:
        try:
            return os.tcgetpgrp(self._file) == os.getpgrp()
        except OSError:
            return False
