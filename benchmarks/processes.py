"""A way of playing in processes of its own, which play for some seconds on request."""

import json
import os
import select
import subprocess
import sys
from pathlib import Path
from typing import Any

from primordia import cores

PATIENCE = 300.0
"""seconds until a process that does not answer counts as failed"""


class Contender:
    """A way of playing, in one process or in several that play at the same time."""

    def __init__(
        self, way: str, game: str, cells: int, worlds: int = 1, one_core_each: bool = False
    ) -> None:
        """Start one process; or a process for each core, which uses that one alone."""
        count = cores.count() if one_core_each else 1
        variables = {**os.environ, **({cores.VARIABLE: "1"} if one_core_each else {})}
        words = [way, game, str(cells), str(worlds)]
        command = [sys.executable, str(Path(__file__).with_name("contender.py")), *words]
        self._way = f"{way} {game} {cells}"
        how: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        how["env"] = variables
        self._processes: list[Any] = [subprocess.Popen(command, **how) for _ in range(count)]

    def __enter__(self) -> "Contender":
        return self

    def __exit__(self, *_: object) -> None:
        """End the processes by the end of their input; kill a process that does not react."""
        for process in self._processes:
            process.stdin.close()
        for process in self._processes:
            try:
                process.wait(timeout=10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            process.stdout.close()

    def ask(self, what: str, seconds: float) -> list[dict]:
        """Send a request for some seconds of play to all processes and return their answers."""
        for process in self._processes:
            process.stdin.write(f"{what} {seconds}\n")
            process.stdin.flush()
        return self.answers()

    def answers(self) -> list[dict]:
        """Return the next answer of each process."""
        lines = []
        for process in self._processes:
            ready, _, _ = select.select([process.stdout], [], [], PATIENCE)
            line = process.stdout.readline() if ready else ""
            if not line:
                raise RuntimeError(f"no answer from contender.py {self._way}")
            lines.append(json.loads(line))
        return lines
