"""Standard streams: names, errors when they cannot be written, messages, and the bar of progress."""

import errno
import io
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from primordia import progress
from primordia.cli import waiting
from primordia.cli.streams import LONGEST, Printable, flush, prepare, report
from tests.commands import Failing

ENOUGH = 10**9
"""More bytes than a test writes."""


@pytest.fixture
def file() -> Iterator[Failing]:
    """Return a file that can be written, unless a test lets it fail."""
    yield (file := Failing(0, ENOUGH))
    file.left = ENOUGH  # Python writes the rest when it closes the stream


def say(file: Failing, text: str) -> None:
    stream = Printable(io.BufferedWriter(file, 16), "utf-8", write_through=True)
    stream.write(text)
    stream.flush()


@pytest.mark.parametrize(("text", "error"), [("short", errno.ENOSPC), ("long" * 100, errno.EPIPE)])
def test_a_stream_that_cannot_be_written_is_named(file: Failing, text: str, error: int) -> None:
    file.error, file.left = error, 0
    with pytest.raises(OSError, match=os.strerror(error)) as caught:
        say(file, text)
    assert (caught.value.errno, caught.value.filename) == (error, "standard output")


def test_a_stream_counts_the_characters_that_it_was_given(file: Failing) -> None:
    stream = Printable(io.BufferedWriter(file, 16), "utf-8")
    assert [stream.write(text) for text in ("", "one", "\x1b[2J")] == [0, 3, 4]


@pytest.mark.parametrize("stuck", [("stdout",), ("stdout", "stderr")])
def test_text_that_cannot_be_written_at_the_end_is_dropped(
    stuck: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Otherwise Python would try again at exit, and fail. The other stream is unchanged."""

    def fail() -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    names = ("stdout", "stderr")
    opened = [open(tmp_path / name, "wb", buffering=0) for name in names]  # noqa: SIM115
    for name, each in zip(names, opened, strict=True):
        flushed = fail if name in stuck else each.flush
        monkeypatch.setattr(sys, name, SimpleNamespace(flush=flushed, fileno=each.fileno))
    flush()
    for each in opened:
        os.write(each.fileno(), b"more")
        each.close()
    written = {name for name in names if (tmp_path / name).read_bytes()}
    assert written == {*names} - {*stuck}


@pytest.mark.parametrize("more", [0, 1])
def test_a_message_is_one_line_and_a_longer_one_is_cut(
    more: int, capsys: pytest.CaptureFixture[str]
) -> None:
    report("x" * (LONGEST + more))
    assert capsys.readouterr().err == f"primordia: {'x' * LONGEST}{'...' * more}\n"
    report("one  \n  two\r\nthree")
    assert capsys.readouterr().err == "primordia: one two three\n"


def test_standard_streams_have_names_and_errors_are_shown_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ("stdout", "stderr", "__stdout__"):
        monkeypatch.setattr(sys, name, None)
    prepare()
    streams: Any = sys.stdout, sys.stderr
    assert [(each.fileno(), each.title, each.line_buffering) for each in streams] == [
        (1, "standard output", os.isatty(1)), (2, "standard error", True),
    ]  # fmt: skip


@pytest.mark.parametrize(("patience", "drawn"), [(-1, True), (1e6, False)])
def test_a_bar_tells_what_long_work_does_until_there_is_output(
    patience: float, drawn: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminal := io.StringIO(), "isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "__stderr__", terminal)
    monkeypatch.setattr(waiting, "PATIENCE", patience)
    out = Printable(io.BytesIO(), "utf-8")
    with waiting.bar() as shown:
        progress.tell("counting stars", 0.25)
        shown.refresh()
        assert ("counting stars" in terminal.getvalue()) == drawn
        out.write("a result")
        ended = len(terminal.getvalue())
        progress.tell("counting sand", 0.5)
        shown.refresh()
    assert "counting" not in terminal.getvalue()[ended:]
