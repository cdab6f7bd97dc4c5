"""The bar of progress: drawn late, on a terminal, until something is printed."""

import io
import sys

import pytest

from primordia import progress
from primordia.cli import streams, waiting


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def on_screen(monkeypatch: pytest.MonkeyPatch, patience: float) -> tuple[str, str]:
    """Return what is drawn while work goes on, and what is drawn after the first output."""
    terminal = Terminal()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "__stderr__", terminal)
    monkeypatch.setattr(waiting, "PATIENCE", patience)
    out = streams.Printable(io.BytesIO(), "utf-8")
    with waiting.bar() as shown:
        progress.tell("counting stars", 0.25)
        shown.refresh()
        before = terminal.getvalue()
        out.write("a result")
        ended = len(terminal.getvalue())
        progress.tell("counting sand", 0.5)
        shown.refresh()
    return before, terminal.getvalue()[ended:]


def test_a_bar_tells_what_is_done_until_there_is_output(monkeypatch: pytest.MonkeyPatch) -> None:
    before, after = on_screen(monkeypatch, patience=-1)
    assert "counting stars" in before
    assert "counting sand" not in after


def test_quick_work_shows_no_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    before, after = on_screen(monkeypatch, patience=1e6)
    assert "counting" not in before + after
