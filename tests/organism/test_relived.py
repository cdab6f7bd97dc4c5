"""Lives that are lived again: their begin, their end, and how their death is compared with the record."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.errors import InputError, Trouble
from primordia.law.metabolism import ONE, Rates
from primordia.law.world import BirthCause, Cause
from primordia.organism.reliving import relived
from primordia.organism.reliving.course import Course
from primordia.organism.reliving.instant import Stretch
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.lives import ALIVE, Lives
from primordia.settings.islands import Islands


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


def stretch(ticks: np.ndarray, death: int | None = None, cause: Cause = Cause.FATAL) -> Stretch:
    """Return ticks of a life, which may end. The energy is the tick, and the food twice the tick."""
    none: Any = None
    causes = np.where(ticks == death, int(cause), -1).astype(np.int32)
    energy, eaten = (ONE * ticks).astype(np.int32), (2 * ONE * ticks).astype(np.int32)
    return Stretch(ticks, none, none, none, energy, eaten, causes, none)


class Alone:
    """Lives an organism four ticks at a time; it may die at a tick. Notes the inputs of each call."""

    TICKS = 4

    def __init__(self, death: int | None) -> None:
        self.death, self.asked, self.closed = death, list[Any](), 0

    def live(
        self, now: int, ticks: np.ndarray, rates: Any, given: Any, count: int
    ) -> tuple[int, Stretch]:
        self.asked.append((now, ticks.tolist(), rates, given, count))
        return now + 1, stretch(ticks[:count], self.death)

    def close(self) -> None:
        self.closed += 1


@pytest.mark.parametrize(
    ("death", "lived"),
    [
        (None, [(41, 44), (45, 48), (49, 50)]),
        (50, [(41, 44), (45, 48), (49, 50)]),
        (49, [(41, 44), (45, 48), (49, 49)]),
        (48, [(41, 44), (45, 48)]),
        (45, [(41, 44), (45, 45)]),
        (41, [(41, 41)]),
    ],
)
def test_a_life_is_lived_to_its_recorded_end_or_to_an_earlier_death(
    death: int | None, lived: list[tuple[int, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each call has four ticks; ticks after the recorded end do not count."""
    alone = Alone(death)
    monkeypatch.setattr(RelivedLife, "_alone", lambda self, watched: alone)
    monkeypatch.setattr(RelivedLife, "_start", lambda self, alone: 0)
    monkeypatch.setattr(RelivedLife, "_climate", lambda self, ticks: f"climate of {ticks[0]}")
    monkeypatch.setattr(RelivedLife, "_with_accidents", lambda self, stretch, *given: stretch)
    monkeypatch.setattr(RelivedLife, "_given", lambda self, ticks: f"births of {ticks[0]}")
    monkeypatch.setattr(Rates, "of", lambda climate: climate)
    monkeypatch.setattr(relived, "_as_stored", lambda alone, instant: {"instant": instant})
    life = life_of(0)
    life.record.ended[0] = 50
    (begun, none), *after = life.instants()
    assert (begun, none) == ({"instant": 0}, None)
    assert [each["instant"] for each, _ in after] == list(range(1, len(lived) + 1))
    parts = [each for _, each in after if each is not None]
    assert [(int(each.tick[0]), int(each.tick[-1])) for each in parts] == lived
    assert all(len(each.tick) == len(each.cause) == len(each.energy) for each in parts)
    firsts = [41, 45, 49][: len(lived)]
    assert alone.asked == [
        (
            number,
            list(range(first, first + 4)),
            *(f"{each} of {first}" for each in ("climate", "births")),
            min(4, 51 - first),
        )
        for number, first in enumerate(firsts)
    ]
    assert alone.closed == 1


@pytest.mark.parametrize(
    ("born", "given", "begin"),
    [
        (41, None, None), (40, None, "origin"), (39, None, "origin"),
        (41, "kept", "kept"), (39, "kept", "kept"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("exact", [True, False])
def test_an_organism_older_than_a_fork_begins_with_the_state_of_the_fork(
    born: int, given: Any, begin: str | None, exact: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The fork is at tick 40. A life begins with a state only if the habitat can save bodies."""
    monkeypatch.setattr(relived, "rebuild", lambda run, *place: np.float32([*place]))
    lives = SimpleNamespace(
        row=lambda organism, world: {(5, 1): 0}[organism, world],
        take=lambda rows: SimpleNamespace(
            born=np.array([born]), id=np.array([5]), cell=np.array([3])
        ),
    )
    layout = SimpleNamespace(split=lambda genome: genome.tolist())
    run: Any = SimpleNamespace(
        path="RUN",
        lives=lives,
        config=SimpleNamespace(fork=SimpleNamespace(tick=40)),
        law=SimpleNamespace(heredity=SimpleNamespace(layout=layout)),
        habitat=SimpleNamespace(exact=exact),
        origin="origin",
    )
    if begin is None or exact:
        life = RelivedLife.of(run, 5, 1, given)
        assert (life.stored, life.genome) == (begin, [[5.0, 1.0]])
        return
    place = "the fork" if given is None else "the checkpoint"
    with pytest.raises(
        InputError, match=f"^RUN: organism 5 is older than {place}, and the habitat"
    ):
        RelivedLife.of(run, 5, 1, given)


def test_a_life_goes_on_with_the_stored_values_of_its_own_cell(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Organism 5 of world 1 has index 6 in the arrays."""
    monkeypatch.setattr(relived, "place_in", lambda arrays, *place: {(5, 1): 6}[place])
    names = "world.organisms.memory", "world.organisms.energy", "world.organisms.eaten", "bodies.y"
    arrays: Any = {
        name: 10 * number + np.arange(8, dtype=np.int32)[:, *([None] * (name in names[::3]))]
        for number, name in enumerate(names)
    }
    alone: Any = SimpleNamespace(restore=lambda stored: stored)
    islands = SimpleNamespace(islands=Islands(("",), (0, 4)))
    found = replace(life_of(0), config=islands)._restored(alone, arrays)
    energy, eaten = found.vitals
    assert (found.memory.tolist(), energy.tolist(), eaten.tolist()) == ([[6]], [16], [26])
    bodies: Any = found.bodies
    assert {name: body.tolist() for name, body in bodies.items()} == {"bodies.y": [[36]]}
    assert replace(life_of(0), stored=arrays).memory.tolist() == [[6]]


WHEN = np.arange(60, 73)
"""The last ticks of a life that ends in tick 72."""


@pytest.mark.parametrize(
    ("cause", "lived", "same"),
    [
        (Cause.STARVED, stretch(WHEN, 72, Cause.STARVED), True),
        (Cause.STARVED, stretch(WHEN[:-1]), True),
        (Cause.STARVED, stretch(WHEN, 72, Cause.FATAL), False),
        (Cause.STARVED, stretch(WHEN), False),
        (Cause.FATAL, stretch(WHEN, 72, Cause.FATAL), True),
        (Cause.FATAL, stretch(WHEN), False),
        (Cause.REPLACED, stretch(WHEN), True),
        (Cause.REPLACED, stretch(WHEN, 72, Cause.HAZARD), False),
        (Cause.HAZARD, stretch(WHEN[:-1], 71, Cause.HAZARD), False),
        *(
            (cause, changed._replace(**{name: getattr(changed, name) + 1}), False)
            for name in ("energy", "eaten")
            for cause, changed in (
                (Cause.STARVED, stretch(WHEN, 72, Cause.STARVED)),
                (Cause.REPLACED, stretch(WHEN)),
            )
        ),
    ],
)
def test_a_stretch_must_have_the_recorded_cause_energy_and_food_of_the_death(
    cause: Cause, lived: Stretch, same: bool
) -> None:
    """On record, the organism died in tick 72 with an energy of 72 and a food of 144."""
    life = life_of(1, path="RUN")
    life.record.cause[0] = cause
    vars(life)["death"] = {"energy": 72.0, "food": 144.0}
    if same:
        return life._check(lived)
    with pytest.raises(Trouble, match="did not repeat as recorded"):
        life._check(lived)


def test_a_life_has_the_seed_of_its_world() -> None:
    seed = life_of(0, world_seeds=np.array([7, 2**33 + 5, 9], np.uint64))._seed
    assert (np.asarray(seed.hi).tolist(), np.asarray(seed.lo).tolist()) == ([2], [5])
