"""The live view: pictures in terminals of any size, and plain lines in other places."""

import io
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.segment import Segment

from primordia.engine.engine import Engine
from primordia.live import view as live
from primordia.live.census import Census
from primordia.live.watching import Plain
from primordia.runs import loop
from tests.commands import here
from tests.live.posed import look_alive, terminal
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


def shown(made: Engine, width: int, height: int) -> tuple[str, list[str]]:
    """Return what is written to a terminal, and the lines of the last frame."""
    console, limits = terminal(width, height), made.limits({"ticks": 10**6})
    with live.View(console) as view:
        for _ in range(2):
            made._ticks = 20
            made.advance(limits)
            view(loop.Status(made, 1.0, limits))
    assert isinstance(console.file, io.StringIO)
    written = console.file.getvalue()
    frame = re.split(r"\x1b\[2K(?!\r?\x1b\[1A)", written)[-1]
    return written, re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", frame).splitlines()


def test_the_view_fits_any_terminal(running: tuple[str, Engine]) -> None:
    for width, height in ((200, 60), (3, 2)):
        _, frame = shown(running[1], width, height)
        assert 0 < len(frame) <= height
        assert max(map(len, frame)) <= width


def test_the_view_shows_time_population_and_lines(running: tuple[str, Engine]) -> None:
    name, made = running
    written, frame = shown(made, 80, 24)
    text = "\n".join(frame)
    assert "\x1b[38;2" in written
    assert written.endswith("\x1b[?25h"), "the cursor is back"
    census = Census.of(made.state.world)
    for what in (f"{census.births.sum():,}", "died of", "oldest", "organism-ticks/s", "calm"):
        assert what in text
    assert "saturated" not in text, "only when it is"
    assert ("shown: the first" in text) == (name in ("worlds", "big"))
    assert ("takeovers" in text) == (name == "herd"), "only if all are followed"
    assert f"colour: {'branch of the founder' if name == 'big' else 'line of descent'}" in text
    assert int(made.state.world.organisms.alive.sum()) == census.alive.sum()


def test_the_view_follows_the_living(running: tuple[str, Engine]) -> None:
    name, made = running
    view = live.View(terminal(80, 24))
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
    console = terminal(80, 10)
    console.print(live.frame([[Segment("a\x1b]0;title\x07b\x9b2Jc\n")]]))
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
