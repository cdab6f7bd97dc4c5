"""Lines of descent in the live view: they are given up where following them would take too long."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.history.lines import NO_PARENT, Turnover
from primordia.live import descent
from primordia.live.descent import Descent


def follow(followed: Descent, births: range, wall_s: float = 0.0) -> None:
    """Take a chunk with founders of these numbers."""
    born = np.array(births, np.int64)
    none = np.zeros(0, np.int64)
    happened = Turnover(born, np.full(len(born), NO_PARENT), born, none, none)
    state = SimpleNamespace(world=SimpleNamespace(organisms=None))
    engine = SimpleNamespace(law=SimpleNamespace(cells=64), state=state, events=[happened])
    status: Any = SimpleNamespace(engine=engine, wall_s=wall_s)
    followed.follow(status, 1)


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Descent, "EVENTS", 10)
    monkeypatch.setattr(descent, "turnovers", lambda events, cells, shown: events)


def test_lines_are_given_up_after_too_many_births() -> None:
    followed = Descent()
    follow(followed, range(6))
    follow(followed, range(6, 10))
    assert set(followed.lines[0].line_of) == set(range(10))
    follow(followed, range(10, 11))
    assert followed.lines == {}
    assert followed.takeovers([0]) is None


def test_with_time_there_may_be_more_births() -> None:
    followed = Descent()
    follow(followed, range(20), wall_s=1.0)
    follow(followed, range(20, 30), wall_s=2.0)
    assert set(followed.lines[0].line_of) == set(range(30))
    follow(followed, range(30, 31), wall_s=2.0)
    assert followed.takeovers([0]) is None


def test_lines_of_large_worlds_are_not_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Descent, "CELLS", 63)
    followed = Descent()
    follow(followed, range(3))
    assert followed.takeovers([0]) is None
