"""The effect of keys on the view, and the numbers that it shows."""

import re
from collections import defaultdict
from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import pytest

from primordia.engine.state import Limits
from primordia.live import view as views
from primordia.live.words import pages
from primordia.random.wide import wide
from primordia.runs.loop import Status
from tests.live.drawn import text
from tests.live.posed import Clock, Pressed, counted, status, view


def value_of(shown: Any, of: Status, name: str) -> str | None:
    """Return the value that is shown with a name; None if the name is not shown."""
    rows = "\n".join(text(shown._rows(of)))
    found = re.search(rf"\b{name} +(\S+( of \S+)?)", rows)
    return found[1] if found else None


def test_w_shows_one_world_after_another_and_then_all() -> None:
    for worlds, cycle in ((1, [None] * 3), (3, [0, 1, 2, None, 0])):
        shown, of = view(), status(worlds)
        for alone in cycle:
            shown._obey("w", of)
            assert shown._alone == alone


def test_the_numbers_are_those_of_the_world_that_is_shown_and_the_speed_is_that_of_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In 2 s the worlds lived 10, 40 and 0 organism-ticks. Takeovers are known in two worlds only."""
    monkeypatch.setattr(views, "time", clock := Clock())
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
            assert value_of(shown, later, name) == value, (name, presses)


def test_the_time_left_is_that_until_the_limits_of_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """In 2 s each world lives 200 ticks. The last of the three lacks 702 ticks at a limit of 1,000."""
    monkeypatch.setattr(views, "time", clock := Clock())
    none = [2**64 - 1] * 3
    limits = Limits(wide([1000] * 3), wide(none), jnp.bool_(False))
    for given, left in ((limits, "7"), (None, None)):
        shown = view()
        for clock.now, tick in ((10.0, 100), (12.0, 300)):
            of = Status(status(tick=tick).engine, clock.now, given)
            found = value_of(shown, of, "time left")
        assert found == left


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
    assert shown._speed.ticks_per_s() is None, "no speed is measured across a pause"


def test_n_moves_among_the_organisms_of_the_world_that_is_shown() -> None:
    shown, of, asked = view(), status(), list[Any]()
    shown._obey("n", of)
    assert shown._companion is None, "no organism is shown yet"
    shown._obey("o", of)

    def find(engine: Any, alone: int | None, step: int) -> None:
        asked.append((alone, step))

    shown._companion = SimpleNamespace(find=find)
    for key in "nwn":
        shown._obey(key, of)
    assert asked == [(None, 1), (0, 1)]
    shown._obey("o", of)
    assert shown._companion is None


def test_the_pages_of_words_are_shown_one_after_another() -> None:
    """One row is the heading, one has the keys, and one is for the cursor."""
    shown, of = view(60, 12, keyboard=Pressed()), status()
    for _ in range(2):
        for page in pages(60, 12 - 3):
            shown._obey("?", of)
            assert text(shown._rows(of))[1 : 1 + len(page)] == text(page)
        shown._obey("?", of)
        assert "died of" in "\n".join(text(shown._rows(of))), "the world is shown again"


def test_the_heading_has_the_pace_and_the_time_and_the_bar_has_the_calm() -> None:
    shown, of = view(), status(1, calm=[7])
    of.engine.state.world.organisms.alive[:] = True
    shown._pace.limit = 30.0
    heading, *below = text(shown._rows(of))
    assert heading.startswith("meadow  seed 0, 4 cells")
    assert heading.endswith(" at most 30 ticks/s, 1 min 15 s")
    assert "calm: 7 of 99 ticks" in "\n".join(below)


def test_keys_are_named_where_they_mean_something() -> None:
    shown = view(keyboard=Pressed())
    one, many = status(1), status(3)
    assert [key in text(shown._rows(of))[-1] for of in (one, many) for key in ("world", "next")] == [
        False, False, True, False,
    ]  # fmt: skip
    shown._companion = SimpleNamespace(rows=lambda *_: [])
    assert "n next" in text(shown._rows(many))[-1]
    assert "quit" not in "".join(text(view()._rows(many)))


def test_the_last_frame_has_neither_keys_nor_words() -> None:
    shown, of = view(keyboard=Pressed()), status()
    drawn: list[Any] = []
    shown._draw = lambda _: drawn.append(shown._rows(of))
    shown._status = of
    shown._obey("?", of)
    shown.__exit__()
    (rows,) = map(text, drawn)
    assert "quit" not in "\n".join(rows)
    assert "died of" in "\n".join(rows)
