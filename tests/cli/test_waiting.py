"""The bar of progress: drawn late, on a terminal, until something is printed."""

import io
import sys

import pytest

from primordia import progress
from primordia.cli import streams, waiting


@pytest.mark.parametrize(("patience", "drawn"), [(-1, True), (1e6, False)])
def test_a_bar_tells_what_long_work_does_until_there_is_output(
    patience: float, drawn: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminal := io.StringIO(), "isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "__stderr__", terminal)
    monkeypatch.setattr(waiting, "PATIENCE", patience)
    out = streams.Printable(io.BytesIO(), "utf-8")
    with waiting.bar() as shown:
        progress.tell("counting stars", 0.25)
        shown.refresh()
        assert ("counting stars" in terminal.getvalue()) == drawn
        out.write("a result")
        ended = len(terminal.getvalue())
        progress.tell("counting sand", 0.5)
        shown.refresh()
    assert "counting" not in terminal.getvalue()[ended:]
