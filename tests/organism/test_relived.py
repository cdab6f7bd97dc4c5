"""Lives that are lived again: where they begin and end, and what is recorded of their death."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.law.metabolism import ONE
from primordia.law.world import BirthCause, Cause
from primordia.organism.reliving import relived
from primordia.organism.reliving.course import Course
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.lives import ALIVE, Lives


def life_of(row: int, stored: Any = None, **run: Any) -> RelivedLife:
    """Return organism 5 of world 1, which is alive (row 0), or organism 6, which has starved (row 1)."""
    record = Lives(
        world=np.array([1, 1]),
        id=np.array([5, 6]),
        parent=np.array([-1, 5]),
        cell=np.array([2, 3]),
        birth_cause=np.array([BirthCause.FOUNDER, BirthCause.COPY]),
        born=np.array([40, 45]),
        seen=np.array([40, 45]),
        inherited=np.array([False, False]),
        ended=np.array([90, 72]),
        cause=np.array([ALIVE, Cause.STARVED]),
    ).take(np.array([row]))
    none: Any = None
    return RelivedLife(SimpleNamespace(**run), none, none, none, none, record, stored)


@pytest.mark.parametrize(
    ("row", "birth", "ends", "cause"), [(0, 40, 90, None), (1, 45, 72, Cause.STARVED)]
)
def test_a_life_begins_at_its_birth_or_at_the_stored_tick_of_its_world(
    row: int, birth: int, ends: int, cause: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(relived, "world_ticks", lambda arrays: arrays["ticks"])
    born = life_of(row)
    assert (born.begins, born.ends, born.cause) == (birth, ends, cause)
    later = life_of(row, {"ticks": np.array([9, 60, 70])})
    assert (later.begins, later.ends, later.cause) == (60, ends, cause)
    assert (Course(born).tick, Course(later).tick) == (birth, 60)


def test_the_row_of_a_death_is_that_of_the_organism_in_its_world() -> None:
    """Other worlds also have an organism 6. The row is in the second segment."""

    def row(world: int, number: int, energy: float) -> dict[str, Any]:
        own = {"world": world, "id": number, "tick": 72, "cause": "starved", "energy": energy}
        return {**own, "food": 2 * energy, "score": int(9 * energy)}

    asked: list[Any] = []

    def segments(table: str, columns: tuple[str, ...]) -> Any:
        asked.append((table, columns))
        yield pa.Table.from_pylist([row(0, 6, 1.0), row(1, 5, 2.0)])
        yield pa.Table.from_pylist([row(2, 6, 3.0), row(1, 6, 4.5), row(1, 7, 6.0)])

    life = life_of(1, segments=segments, schema=SimpleNamespace(tallies=("score",)))
    assert life.death == row(1, 6, 4.5)
    assert life.at_death == (4.5 * ONE, 9 * ONE)
    names = ("world", "id", "tick", "cause", "energy", "food", "score")
    assert asked == [("deaths", names)]
