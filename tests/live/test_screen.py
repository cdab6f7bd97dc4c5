"""The screen of a world: its parts fill it, and it shows the organism that is chosen."""

from typing import Any

import numpy as np
import pytest

from primordia.engine.engine import Engine
from primordia.law.metabolism import ONE
from primordia.live.companion import _perceived
from primordia.live.view import View
from primordia.runs.loop import Status
from tests.live.drawn import text
from tests.live.posed import Pressed, look_alive, terminal
from tests.worlds import MEADOW, config


def meadow(**settings: Any) -> Engine:
    """Return a meadow whose organisms are posed as if they had lived."""
    made = Engine(config(MEADOW, hazard=0.02, **settings))
    look_alive(made)
    return made


@pytest.fixture(scope="module")
def torus() -> Engine:
    return meadow(cells=1024, placement={"topology": "torus8"})


def screen(made: Engine, keys: str, width: int, height: int) -> list[str]:
    """Return the rows of the screen after some keys."""
    console = terminal(width, height)
    view, status = View(console, keyboard=Pressed()), Status(made, 1.0, made.limits({}))
    view._descent.follow(status, 1)
    for key in keys:
        view._obey(key, status)
    return [row[:width] for row in text(view._rows(status))]  # as a frame cuts them


@pytest.mark.parametrize("cells", [1024, 2])
def test_screens_are_filled_and_not_overfilled(torus: Engine, cells: int) -> None:
    made = torus if cells == 1024 else meadow(cells=cells)
    for width, height in ((120, 40), (80, 24), (60, 15)):
        for keys in ("", "o", "w", "wo", "?"):
            rows = screen(made, keys, width, height)
            assert len(rows) == height - 1
            assert rows[-1].startswith("space"), "the keys are the last row"
            assert "tick" in "".join(rows)
            blank = sum(not row.strip() for row in rows)
            assert blank <= height // 2 or cells == 2


def test_a_torus_of_1024_cells_is_whole_and_large(torus: Engine) -> None:
    def blocks(width: int, height: int) -> tuple[int, int]:
        rows = [row.split(" ")[0] for row in screen(torus, "", width, height)]
        drawn = [row for row in rows if row.startswith("▀")]
        return len(drawn[0]), len(drawn)

    assert blocks(120, 40) == (64, 32)
    assert blocks(80, 24) == (32, 16)
    assert "shown: 20 x 32 of 32 x 32 cells" in "\n".join(screen(torus, "", 60, 15))


@pytest.mark.slow
def test_what_it_does_next_is_what_it_then_does() -> None:
    """The food of this habitat is the action, of which the motor draws a part."""
    watch = {**MEADOW, "habitat": {"name": "tests.toys:Watch"}, "brain": {"kind": "feed-forward"}}
    motor = {"kind": "gaussian", "sd": 30.0}
    made = Engine(config(watch, motor=motor, genesis="fill", replication=0.0))

    def eaten_until(tick: int) -> np.ndarray:
        made.advance(made.limits({"ticks": tick}))
        return np.array(made.state.world.organisms.eaten) / ONE

    before = eaten_until(1)
    next_ = [_perceived(made, cell, world=0)[2].action[0] for cell in range(16)]
    np.testing.assert_allclose(eaten_until(2) - before, next_, atol=1 / ONE)
