"""The screen: nothing is cut or folded, the organism that is shown, and words that are all explained."""

import io
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from rich.console import Console

from primordia.engine.engine import Engine
from primordia.history.threshold import Threshold
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.live.census import Census
from primordia.live.companion import Companion, _perceived
from primordia.live.ground import Medians
from primordia.live.paint import photograph, width_of
from primordia.live.panel import Outlook, numbers, saturation
from primordia.live.terminal import Keyboard
from primordia.live.view import View
from primordia.live.words import WORDS, pages
from primordia.runs.loop import Status
from tests.live.test_live import look_alive, text
from tests.worlds import MEADOW, config

SIZES = [(120, 40), (80, 24), (60, 15)]


def posed(**settings: Any) -> Engine:
    made = Engine(config(MEADOW, hazard=0.02, **settings))
    look_alive(made)
    return made


def terminal(width: int, height: int) -> Console:
    """Return a terminal with all colours."""
    colours: Any = {"force_terminal": True, "color_system": "truecolor"}
    return Console(file=io.StringIO(), width=width, height=height, **colours)


def screen(made: Engine, keys: str, width: int, height: int) -> list[str]:
    """Return the rows of the screen after some keys."""
    console = terminal(width, height)
    view, status = View(console, keyboard=Keyboard()), Status(made, 1.0, made.limits({}))
    view._descent.follow(status, 1)
    for key in keys:
        view._obey(key, status)
    return text(view._rows(status))


@pytest.mark.parametrize("settings", [
    {"cells": 1024, "placement": {"topology": "torus8"}},
    {"cells": 4, "placement": {"topology": "torus4"}},
    {"cells": 32}, {"cells": 2}, {"cells": 5000},
    {"cells": 64, "seeds": 3, "placement": {"topology": "torus8"}},
    {"cells": 1024, "seeds": 40, "placement": {"topology": "torus8"}},
    {"cells": 16, "seeds": 200},
], ids=str)  # fmt: skip
def test_screens_are_filled_and_not_overfilled(settings: dict[str, Any]) -> None:
    made = posed(**settings)
    for width, height in SIZES:
        for keys in ("", "o", "w", "wo", "?"):
            rows = screen(made, keys, width, height)
            assert len(rows) == height - 1
            assert max(map(len, rows)) <= width
            assert rows[-1].startswith("space"), "the keys are the last row"
            assert "tick" in "".join(rows)
            blank = sum(not row.strip() for row in rows)
            assert blank <= height // 2 or "seeds" in settings or settings["cells"] < 64


def test_a_torus_of_1024_cells_is_whole_and_large() -> None:
    made = posed(cells=1024, placement={"topology": "torus8"})

    def blocks(width: int, height: int) -> tuple[int, int]:
        rows = [row.split(" ")[0] for row in screen(made, "", width, height)]
        drawn = [row for row in rows if row.startswith("▀")]
        return len(drawn[0]), len(drawn)

    assert blocks(120, 40) == (64, 32)
    assert blocks(80, 24) == (32, 16)
    assert "shown: 20 x 32 of 32 x 32 cells" in "\n".join(screen(made, "", 60, 15))


def test_one_world_after_another_is_shown() -> None:
    made = posed(cells=16, seeds=2)
    alive = [int(Census.of(made.state.world, world).alive.sum()) for world in (None, 0, 1)]
    assert alive[0] == alive[1] + alive[2]
    for presses, (count, cells) in enumerate(
        zip([*alive, alive[0]], (32, 16, 16, 32), strict=True)
    ):
        rows = "\n".join(screen(made, "w" * presses, 80, 24))
        assert f"{count} of {cells}" in rows


def test_whether_good_lines_hold_is_told_of_the_worlds_that_are_shown() -> None:
    """The numbers of world 2 are unknown, so the medians of all worlds are halfway between the others."""
    made, view = posed(cells=16, seeds=3), View(terminal(120, 24))
    known = [Threshold(0, 0.2, 0.1, 2.0), Threshold(1, 0.6, 0.5, 3.0), Threshold(2, 0.4, None, 1.0)]
    ground: Any = SimpleNamespace(measured=lambda _: known)
    view._ground, status = ground, Status(made, 1.0)
    view._descent.follow(status, 1)
    names = ("children mutate", "mutants as good", "good lines hold")
    of_each = [("20%", "10%", "1.64"), ("60%", "50%", "2.10"), None]
    for values in (("40%", "30%", "1.87"), *of_each):
        told = " ".join("\n".join(text(view._rows(status))).split())
        for name, value in zip(names, values or names, strict=True):
            assert f"{name} {value}" in told if values else name not in told
        view._obey("w", status)


def test_the_oldest_organism_is_shown_and_then_the_next() -> None:
    made, companion = posed(cells=16), Companion()
    born = np.asarray(made.state.world.organisms.born.lo)
    alive = np.asarray(made.state.world.organisms.alive)
    order = [cell for cell in np.argsort(born, kind="stable").tolist() if alive[cell]]
    assert companion.find(made, None) == order[0]
    for cell in [*order[1:], order[0]]:
        assert companion.find(made, None, step=1) == cell
        assert companion.find(made, None) == cell, "it stays"
    die(made, order[0])
    assert companion.find(made, None) == order[1], "the oldest takes the place of the dead"
    die(made, *order)
    assert companion.find(made, None) is None
    assert "nothing is alive" in "\n".join(screen(made, "o", 80, 24))


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


def die(made: Engine, *cells: int) -> None:
    world = made.state.world
    alive = jnp.asarray(world.organisms.alive).at[jnp.array(cells)].set(False)
    organisms = world.organisms._replace(alive=alive)
    made.state = made.state._replace(world=world._replace(organisms=organisms))


def test_a_habitat_that_fails_to_draw_is_not_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    made, asked = posed(cells=16), []

    def picture(*_: Any) -> None:
        asked.append(1)
        raise RuntimeError

    made.habitat = SimpleNamespace(picture=picture, caption=made.habitat.caption)
    made.habitat.seen = lambda: made.state.bodies
    view, status = View(terminal(80, 24)), Status(made, 1.0)
    view._obey("o", status)
    for _ in range(3):
        assert "action" in "\n".join(text(view._rows(status)))
    assert len(asked) == 1


def test_a_picture_has_two_points_in_a_character() -> None:
    pixels = np.zeros((3, 2, 3), np.uint8)
    pixels[0, 0], pixels[1, 0] = (255, 0, 0), (0, 0, 255)
    rows = photograph(pixels)
    assert [width_of(row) for row in rows] == [2, 2]
    style = rows[0][0].style
    assert style is not None
    assert style.color is not None
    assert style.bgcolor is not None
    assert style.color.get_truecolor() == (255, 0, 0)
    assert style.bgcolor.get_truecolor() == (0, 0, 255)


def census(alive: int, calm: int, saturated: int) -> Census:
    one = np.ones(1, np.int64)
    return Census(one, alive * one, one, np.ones((1, 7), np.int64), one, one, calm * one,
                  saturated * one, 0.0, 0)  # fmt: skip


@pytest.mark.parametrize("width", [20, 30, 80])
def test_saturated_is_said_only_of_a_world_that_is(width: int) -> None:
    def said(each: Census) -> str:
        row = saturation(each, 8, 1000, width)
        assert width_of(row) <= width
        return "".join(segment.text for segment in row)

    assert "saturated" not in said(census(7, 0, -1))
    assert "saturated" not in said(census(8, 999, -1))
    assert "saturated" in said(census(7, 3, 1234))


@pytest.mark.parametrize(
    ("alive", "calm", "said", "filled"),
    [
        ([7], [500], "full and calm for 0 of 1,000 ticks", 0),
        ([8], [500], "full and calm for 500 of 1,000 ticks", 12),
        ([8], [2000], "full and calm for 1,000 of 1,000 ticks", 24),
        ([7, 8], [900, 250], "one world full and calm for 250 of 1,000 ticks", 6),
        ([7, 0], [900, 900], "no world full and calm for 1,000 ticks", 0),
    ],
)
def test_a_bar_of_24_columns_grows_only_with_the_calm_of_full_worlds(
    alive: list[int], calm: list[int], said: str, filled: int
) -> None:
    some = replace(
        census(0, 0, -1),
        tick=np.ones(len(alive), np.int64),
        alive=np.array(alive),
        calm=np.array(calm),
        saturated=np.full(len(alive), -1),
    )
    row = "".join(segment.text for segment in saturation(some, 8, 1000, 80))
    assert row == "━" * filled + "╌" * (24 - filled) + f"  {said}"


def test_every_word_is_explained_and_fits() -> None:
    named = numbers(census(7, 0, -1), 8, Outlook(1.0, 9.0), 1, Medians(0.5, 0.5, 1.0))
    assert {*named, *(cause.label for cause in Cause)} <= {*WORDS}
    for width, height in SIZES:
        found = pages(width, height)
        assert all(len(page) <= height for page in found)
        assert max(width_of(row) for page in found for row in page) <= width
        assert {*WORDS} <= {row[0].text.strip() for page in found for row in page}
