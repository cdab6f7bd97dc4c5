"""What keys do to the view, and which numbers it then shows."""

import io
import re
from collections import defaultdict
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from primordia.law.events import BIRTHS, DEATHS, Rows
from primordia.live import view as views
from primordia.live.pace import Pace
from primordia.live.terminal import Keyboard
from primordia.live.view import View
from primordia.live.words import pages
from primordia.runs.loop import Status
from tests.live.posed import counted, law, posed
from tests.live.test_paint import text
from tests.worlds import MEADOW, config

NOTHING = tuple(
    Rows(np.zeros((1, columns.width), np.uint32), np.int32(0)) for columns in (BIRTHS, DEATHS)
)


def status(worlds: int = 3, tick: int = 100, **more: Any) -> Status:
    """Return the status of worlds of four cells, of which the first 1, 2, ... are alive."""
    alive = [[int(cell <= world) for cell in range(4)] for world in range(worlds)]
    world = posed(alive, [[0] * 4] * worlds, [tick - at for at in range(worlds)], **more)
    engine: Any = SimpleNamespace(
        law=law(4, worlds), config=config(MEADOW, cells=4, seeds=worlds), longest=None,
        state=SimpleNamespace(world=world), events=SimpleNamespace(births=NOTHING[0], deaths=NOTHING[1]),
    )  # fmt: skip
    return Status(engine, 75.0)


def view(width: int = 100, height: int = 30, keyboard: Any = None, **more: Any) -> Any:
    options: Any = {"force_terminal": True, "color_system": "truecolor", **more}
    return View(
        Console(file=io.StringIO(), width=width, height=height, **options), keyboard=keyboard
    )


def told(shown: Any, of: Status, name: str) -> str | None:
    """Return the value that is shown with a name; None if the name is not shown."""
    rows = "\n".join(text(shown._rows(of)))
    found = re.search(rf"\b{name} +(\S+( of \S+)?)", rows)
    return found[1] if found else None


@pytest.mark.parametrize("worlds", [1, 2, 3])
def test_w_shows_one_world_after_another_and_then_all(worlds: int) -> None:
    shown, of, seen = view(), status(worlds), list[int | None]()
    for _ in range(worlds + 2):
        seen.append(shown._alone)
        shown._obey("w", of)
    cycle = [None, *range(worlds)] if worlds > 1 else [None]
    assert seen == (cycle * 4)[: worlds + 2]


def test_the_numbers_are_those_of_the_world_that_is_shown_and_the_speed_is_that_of_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In 2 s the worlds lived 10, 40 and 0 organism-ticks. Takeovers are known of two worlds only."""
    clock: Any = SimpleNamespace(perf_counter=lambda: clock.now)
    monkeypatch.setattr(views, "time", clock)
    births, deaths = [11, 22, 33], [[each] + [0] * 6 for each in (1, 2, 4)]
    first = status(births=births, deaths=deaths, organism_ticks=[100, 200, 300])
    later = status(births=births, deaths=deaths, organism_ticks=[110, 240, 300])
    lines = {
        world: SimpleNamespace(takeovers=[5] * (3 + world), line_of=defaultdict(int))
        for world in (0, 1)
    }
    expected: dict[str, list[str | None]] = {
        "alive": ["6 of 12", "1 of 4", "2 of 4", "3 of 4"],
        "tick": ["100", "100", "99", "98"],
        "births": ["66", "11", "22", "33"],
        "deaths": ["7", "1", "2", "4"],
        "organism-ticks/s": ["25", "25", "25", "25"],
        "takeovers": [None, "3", "4", None],
    }
    for name, values in expected.items():
        for presses, value in enumerate(values):
            shown = view()
            for _ in range(presses):
                shown._obey("w", first)
            clock.now = 10.0
            shown._rows(first)
            clock.now = 12.0
            shown._descent.lines, shown._descent._throughout = lines, set(lines)
            assert told(shown, later, name) == value, (name, presses)


def test_keys_change_the_pace_from_the_speed_of_the_fastest_world() -> None:
    shown, of = view(), status()
    shown._speed.add(0.0, counted(3, tick=[0, 0, 0]))
    shown._speed.add(2.0, counted(3, tick=[100, 800, 300]))
    for key, limit in (("-", 300), ("-", 100), ("+", 300), ("=", 1000), ("x", 1000)):
        shown._obey(key, of)
        assert shown._pace.limit == limit
    shown._obey("s", of)
    assert shown._pace.paused
    assert shown._speed.ticks_per_s() == 400
    shown._obey(" ", of)
    assert not shown._pace.paused
    assert shown._speed.ticks_per_s() is None, "the time of a pause is not that of ticks"


def test_n_moves_among_the_organisms_of_the_world_that_is_shown() -> None:
    shown, of, asked = view(), status(), list[Any]()
    shown._obey("n", of)
    assert shown._companion is None, "nothing is shown that could be left"
    shown._obey("o", of)

    def find(engine: Any, alone: int | None, step: int) -> None:
        asked.append((alone, step))

    shown._companion = SimpleNamespace(find=find)
    for key in "nwn":
        shown._obey(key, of)
    assert asked == [(None, 1), (0, 1)]
    shown._obey("o", of)
    assert shown._companion is None


@pytest.mark.parametrize("size", [(100, 30), (60, 12)])
def test_the_pages_of_words_are_shown_one_after_another(size: tuple[int, int]) -> None:
    """A row is the heading and one has the keys; the cursor needs another."""
    shown, of = view(*size, keyboard=Keyboard()), status()
    room = size[0], size[1] - 3
    for _ in range(2):
        for page in pages(*room):
            shown._obey("?", of)
            assert text(shown._rows(of))[1 : 1 + len(page)] == text(page)
        shown._obey("?", of)
        assert "died of" in "\n".join(text(shown._rows(of))), "the world again"


def test_the_heading_has_the_pace_and_the_time_of_the_run() -> None:
    shown, of = view(), status()
    shown._pace.limit = 30.0
    (heading, *_) = text(shown._rows(of))
    assert heading.startswith("meadow  3 worlds, seeds 0 to 2, 4 cells each")
    assert heading.endswith(" at most 30 ticks/s, 1 min 15 s")


def test_the_bar_counts_up_to_the_ticks_that_the_law_demands() -> None:
    world = status(1, calm=[7])
    organisms = world.engine.state.world.organisms
    organisms.alive[:] = True
    assert "full and calm for 7 of 99 ticks" in "\n".join(text(view()._rows(world)))


def test_keys_are_named_where_they_mean_something() -> None:
    shown = view(keyboard=Keyboard())
    one, many = status(1), status(3)
    assert [key in text(shown._rows(of))[-1] for of in (one, many) for key in ("world", "next")] == [
        False, False, True, False,
    ]  # fmt: skip
    shown._companion = SimpleNamespace(rows=lambda *_: [])
    assert "n next" in text(shown._rows(many))[-1]
    assert "quit" not in "".join(text(view()._rows(many)))


def test_the_last_frame_has_neither_keys_nor_words() -> None:
    shown, of = view(keyboard=Keyboard()), status()
    drawn: list[Any] = []
    shown._draw = lambda _: drawn.append(shown._rows(of))
    shown._status = of
    shown._obey("?", of)
    shown.__exit__(None, None, None)
    (rows,) = map(text, drawn)
    assert "quit" not in "\n".join(rows)
    assert "died of" in "\n".join(rows)


@pytest.mark.parametrize(
    ("options", "letters"),
    [({}, False), ({"color_system": "256"}, False), ({"color_system": "standard"}, True),
     ({"color_system": None}, True), ({"no_color": True}, True)],
)  # fmt: skip
def test_letters_take_the_place_of_fewer_than_256_colours(
    options: dict[str, Any], letters: bool
) -> None:
    assert view(**options)._letters == letters


def test_a_pace_of_its_own_is_full_speed() -> None:
    assert (str(view()._pace), isinstance(view()._pace, Pace)) == ("", True)
