"""The content of a live page: the run is read again at each new checkpoint."""

import json
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from primordia.errors import InputError, Trouble
from primordia.report.content import of_run
from primordia.report.page import embedded, page
from primordia.runs import directory
from primordia.runs.records import Records
from primordia.tracking.reader import Version, newest_version

EVERY = 0.5
"""Seconds between two readings of the run's directory."""


class Watched:
    """The content of a page, as of the newest checkpoints of the runs."""

    def __init__(self, open_: Callable[[], Records]) -> None:
        """Read the runs.

        Args:
            open_: a function that opens the runs for reading.

        Raises:
            InputError: there is no run, or nothing has lived in it yet.
            Trouble: the run is damaged.
        """
        self._open, self._changed = open_, threading.Condition()
        run = open_()
        self._paths = run.paths
        self._versions = self._now()
        self._content: dict[str, Any] = of_run(run, filmed=False)
        self._count, self._going = 0, self._goes_on()

    def look(self) -> None:
        """Read the runs if they have new checkpoints; keep the old content if they cannot be read.

        A run that is being written removes old checkpoints, perhaps while they are read.
        """
        now, going = self._now(), self._goes_on()
        content = None
        if now != self._versions:
            with suppress(InputError, Trouble, OSError):
                content = of_run(self._open(), filmed=False)
        with self._changed:
            if content is not None:
                self._content, self._versions, self._count = content, now, self._count + 1
            self._going = going
            self._changed.notify_all()

    def follow(self, ended: threading.Event) -> None:
        """Read the runs at intervals until the event is set."""
        while not ended.wait(EVERY):
            self.look()

    def news(self, told: str | None, patience: float) -> str:
        """Return the state as JSON when it differs from the last reported one, or after some
        seconds.

        `count` increases with each new content; `going` says whether a process writes the run.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._state() != told, patience)
            return self._state()

    def page(self) -> bytes:
        """Return the page, as HTML in UTF-8."""
        return page(self._content, live=True).encode()

    def data(self) -> bytes:
        """Return the content, as JSON."""
        return embedded(self._content).encode()

    def _state(self) -> str:
        return json.dumps({"count": self._count, "going": self._going})

    def _now(self) -> list[Version]:
        try:
            return [newest_version(path) for path in self._paths]
        except OSError:
            return []

    def _goes_on(self) -> bool:
        return any(map(directory.is_written, self._paths))
