"""The command line as a user meets it: in another process, or faster, in this process."""

import io
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any
from unittest.mock import patch

import click
import pytest

from primordia import config
from primordia.cli.commands import commands, execute
from primordia.cli.flags import take_limits
from primordia.cli.streams import Printable
from primordia.config import Config

HERE = Path(__file__).parent.parent
TREE = os.pathsep.join([str(HERE / "src"), str(HERE)])
"""The import path of this tree's package and of the tests."""
COMMAND = [sys.executable, "-m", "primordia"]
AFRESH = {"JAX_ENABLE_COMPILATION_CACHE": "false"}
"""The variable of a process that compiles everything itself. JAX keeps code by what it computes, not by
the number of threads that it was compiled for."""
SECONDS = 120
"""A command that takes longer waits for something that never comes."""


def environment() -> dict[str, str]:
    """Return variables under which a process finds this tree's package and the habitats of the tests."""
    return {**os.environ, "PYTHONPATH": TREE}


def hostile(folder: Path) -> None:
    """Fill a folder with files named as modules that a command imports."""
    names = "numpy", "click", "jax", "tomllib", "platformdirs", "libtpu", "sitecustomize", "mmap"
    for name in names:
        (folder / f"{name}.py").write_text("raise SystemExit('from the current folder')\n")


def begin(*words: object, session: bool = False) -> subprocess.Popen[str]:
    """Start a command in another process, if asked in a session of its own, and return while it runs."""
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(
        [*COMMAND, *map(str, words)], env=environment(), start_new_session=session, **pipes
    )


def here(*words: object) -> subprocess.CompletedProcess[str]:
    """Run a command in this process."""
    argv = ["primordia", *map(str, words)]
    out, err = (Printable(io.BytesIO(), "utf-8", "backslashreplace") for _ in range(2))
    with patch.object(sys, "argv", argv), redirect_stdout(out), redirect_stderr(err):
        status = execute()
    for stream in (out, err):
        stream.seek(0)
    return subprocess.CompletedProcess(argv, status, out.read(), err.read())


def flags(settings: dict[str, Any]) -> list[str]:
    """Return settings, some of them in tables, as the words of a command."""
    words = []
    for name, value in settings.items():
        table = value if isinstance(value, dict) else {"": value}
        for key, each in table.items():
            words += ["--" + ".".join(filter(None, (name, key))), str(each)]
    return words


def well_formed(*words: str) -> Config | None:
    """Read the words of a command as it does, and execute nothing.

    Returns:
        the settings of a run, unless its file is one that another command is still to write.
    """
    group: Any = commands
    while isinstance(group.commands[words[0]], click.Group):
        group, words = group.commands[words[0]], words[1:]
    name, *rest = words
    context = group.commands[name].make_context(name, rest)
    task = context.params.get("task")
    if name != "run" or (task.endswith(".toml") and not Path(task).exists()):
        return None
    return config.load(task, {**context.obj, "stop": take_limits(context.params)})


class Failing(io.RawIOBase):
    """A stream that fails from its n-th byte on, as a pipe that is closed or a disk that is full."""

    def __init__(self, error: int, after: int) -> None:
        """`error`: a number of errno."""
        self.error, self.left = error, after

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        self.left -= len(data)
        if self.left < 0:
            raise OSError(self.error, os.strerror(self.error))
        return len(data)


def complains(done: subprocess.CompletedProcess[str], status: int, *parts: str) -> None:
    """Assert that a command failed with this status and one clear line on stderr, with these parts."""
    assert done.returncode == status, done.stderr + done.stdout
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert done.stderr.startswith("primordia: ")
    for part in parts:
        assert part in done.stderr, done.stderr


@contextmanager
def watched() -> Iterator[None]:
    """Fail if the block does not end."""

    def give_up(*_: object) -> None:
        pytest.fail("the command waits for ever")  # commands report OSError, such as TimeoutError

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(SECONDS)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
