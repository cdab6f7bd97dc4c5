"""The live view: pictures in terminals of any size, plain lines in other places, and Ctrl-C."""

import io
import json
import os
import re
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console, ConsoleDimensions
from rich.segment import Segment

from primordia.engine.engine import Engine
from primordia.live import view as live
from primordia.live.census import Census
from primordia.live.watching import Plain
from primordia.runs import loop
from tests.commands import here
from tests.live.drawn import text
from tests.live.posed import look_alive
from tests.live.terminals import opened
from tests.trouble import SMALL
from tests.worlds import HERD, MEADOW, config

# The view as a whole.

WORLDS: dict[str, dict[str, Any]] = {
    "worlds": {"cells": 20, "seeds": 60},
    "big": {"cells": 17_000, "genesis": "fill"},
    "herd": {},
}


def meadow(name: str) -> Engine:
    if name == "herd":
        return Engine(config(HERD))
    return Engine(config(MEADOW, hazard=0.02, metabolism=None, **WORLDS[name]))


@pytest.fixture(scope="module", params=WORLDS)
def running(request: pytest.FixtureRequest) -> tuple[str, Engine]:
    """Return a world of each shape; most are only posed as if they had lived, which saves compilation."""
    name, made = request.param, meadow(request.param)
    if name == "herd":
        made.advance(made.limits({}))
    else:
        look_alive(made)
    return name, made


def shown(made: Engine, chunks: int = 2, **options: Any) -> tuple[str, list[str]]:
    """Return what is written to a terminal, and the lines of the last frame."""
    options = {"force_terminal": True, "color_system": "truecolor", **options}
    console = Console(file=io.StringIO(), **options)
    limits = made.limits({"ticks": 10**6})
    with live.View(console) as view:
        for _ in range(chunks):
            made._ticks = 20
            made.advance(limits)
            view(loop.Status(made, 1.0, limits))
    assert isinstance(console.file, io.StringIO)
    written = console.file.getvalue()
    frame = re.split(r"\x1b\[2K(?!\r?\x1b\[1A)", written)[-1]
    return written, re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", frame).splitlines()


@pytest.mark.parametrize(("width", "height"), [(80, 24), (200, 60), (3, 2)])
def test_the_view_fits_any_terminal(running: tuple[str, Engine], width: int, height: int) -> None:
    _, frame = shown(running[1], width=width, height=height)
    assert 0 < len(frame) <= height
    assert max(map(len, frame)) <= width


def test_the_view_shows_time_population_and_lines(running: tuple[str, Engine]) -> None:
    name, made = running
    written, frame = shown(made, width=80, height=24)
    text = "\n".join(frame)
    assert "\x1b[38;2" in written
    assert written.endswith("\x1b[?25h"), "the cursor is back"
    census = Census.of(made.state.world)
    for what in (
        f"{census.births.sum():,}",
        "died of",
        "oldest",
        "organism-ticks/s",
        "calm",
    ):
        assert what in text
    assert "saturated" not in text, "only when it is"
    assert ("shown: the first" in text) == (name in ("worlds", "big"))
    assert ("takeovers" in text) == (name == "herd"), "only if all are followed"
    assert f"colour: {'branch of the founder' if name == 'big' else 'line of descent'}" in text
    assert int(made.state.world.organisms.alive.sum()) == census.alive.sum()


def test_the_view_follows_a_terminal_that_changes_its_size(running: tuple[str, Engine]) -> None:
    made = running[1]
    console = Console(file=io.StringIO(), force_terminal=True, width=80, height=10)
    with live.View(console) as view:
        for size in ((80, 10), (40, 30), (40, 60), (90, 12)):
            console.size = ConsoleDimensions(*size)
            made.advance(made.limits({}))
            view(loop.Status(made, 1.0))
            rows = text(view._rows(loop.Status(made, 1.0)))
            assert len(rows) < size[1]
            assert size[0] // 2 < max(map(len, rows))


def test_the_view_follows_the_living(running: tuple[str, Engine]) -> None:
    name, made = running
    view = live.View(Console(file=io.StringIO(), force_terminal=True, width=80, height=24))
    for _ in range(3):
        made._ticks = 30
        made.advance(made.limits({}))
        view(loop.Status(made, 1.0))
    followed = view._descent.lines
    assert len(followed) == {"worlds": 24, "big": 0, "herd": 3}[name], "at most one for each row"
    organisms, cells = made.state.world.organisms, made.law.cells
    for world, lines in followed.items():
        here = slice(world * cells, (world + 1) * cells)
        alive, number = np.asarray(organisms.alive)[here], np.asarray(organisms.number.lo)[here]
        assert set(lines.line_of) == set(number[alive].tolist())


def test_a_frame_spells_out_control_characters() -> None:
    console = Console(file=io.StringIO(), force_terminal=True, width=80, height=10)
    console.print(live.Frame([[Segment("a\x1b]0;title\x07b\x9b2Jc\n")]]))
    assert isinstance(console.file, io.StringIO)
    assert console.file.getvalue() == "a\\x1b]0;title\\x07b\\x9b2Jc\\n\n"


# Without a terminal.


def test_plain_lines_where_there_is_no_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Plain, "EVERY", 0.0)
    monkeypatch.setenv("FORCE_COLOR", "1")
    done = here("run", *SMALL[:-1], "--ticks", 2000, "--out", tmp_path / "run")
    assert (done.returncode, done.stderr) == (0, "")
    assert "\x1b" not in done.stdout
    assert re.search(r"^ +\d+\.\d s  tick \d+  alive \d+  births \d+  \S.*/s$", done.stdout, re.M)
    assert done.stdout.endswith(f"primordia replay {tmp_path / 'run'}\n")
    quiet = here("resume", tmp_path / "run", "--ticks", 3000, "--until", "none", "--quiet")
    assert (quiet.stdout, quiet.stderr) == ("", "")


# A terminal, a process, and the signal of Ctrl-C.


@pytest.mark.slow
def test_a_terminal_shows_the_strip_and_control_c_saves(tmp_path: Path) -> None:
    """Standard input is a file here, so no keys are named."""
    with opened() as terminal:
        run = tmp_path / "run"
        words = "run", *SMALL[:-1], "--until", "none", "--out", run
        process = terminal.begin(*words, keys=os.devnull)
        shown = terminal.read_until("\x1b[?25l", "█", "line of descent", "takeovers", "\x1b[38;2")
        assert "quit" not in shown
        process.send_signal(signal.SIGINT)
        terminal.read_until("\x1b[?25h", "Stopped and saved. Go on with: primordia resume")
        assert process.wait(timeout=60) == 130
    info = json.loads(here("info", run, "--json").stdout)
    assert info["births"] > 0
