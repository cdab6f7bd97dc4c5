"""The compared values of a life: as recorded, and as found when the life is lived again."""

import hashlib
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.reliving.course import Course, recorded
from primordia.organism.reliving.instant import Stretch
from primordia.settings.islands import Islands

PLACE = 6
"""The index of cell 2 of world 1 in arrays of a state. Each world has 4 cells."""


def state(cells: int) -> dict[str, np.ndarray]:
    """Return the arrays of a state. No two numbers are equal."""
    whole = np.arange(cells)
    return {
        "world.organisms.energy": (ONE * whole).astype(np.int32),
        "world.organisms.eaten": (ONE * (100 + whole)).astype(np.int32),
        "world.organisms.memory": np.stack([whole / 8, whole / 4 + 50], axis=1).astype(np.float32),
        "world.organisms.id": whole + 1000,
        "bodies.y": np.stack([whole + 300, whole + 400], axis=1).astype(np.float32),
        "bodies.senses": np.stack([whole + 500, whole + 600], axis=1).astype(np.float32),
        "bodies.tally": np.stack([whole + 700, whole + 800], axis=1).astype(np.int32),
    }


def digest(*arrays: np.ndarray) -> str:
    return hashlib.sha256(b"".join(each.tobytes() for each in arrays)).hexdigest()[:12]


def life(kind: str = "host", cause: Cause | None = None, **other: Any) -> Any:
    """Return the life of the organism in cell 2 of world 1, from tick 40 to tick 90.

    If the organism is dead, its record has an energy of 1.5 and a food of 8.
    """
    names = ("score", "lives") if kind == "host" else ()
    lives = SimpleNamespace(world=np.array([1]), cell=np.array([2]), born=np.array([90]))
    run = SimpleNamespace(schema=SimpleNamespace(tallies=names), state=state(8), lives=lives)
    if kind != "host":
        del run.state["bodies.tally"]
    values = {
        "run": run, "world": 1,
        "config": SimpleNamespace(cells=4, islands=Islands(("",), (0, 4))), "begins": 40, "ends": 90,
        "record": SimpleNamespace(cell=np.array([2])), "habitat": SimpleNamespace(kind=kind),
        "cause": cause, "at_death": (3 * ONE // 2, 8 * ONE), "death": {"score": 5, "lives": 0, "tick": 9},
    }  # fmt: skip
    return SimpleNamespace(**{**values, **other})


def test_the_dead_are_compared_with_the_row_of_their_death() -> None:
    vitals = {"energy": 1.5, "food": 8.0}
    starved, struck = recorded(life(cause=Cause.STARVED)), recorded(life("jax", Cause.HAZARD))
    assert starved == {"tick": 90, "cause": "starved", **vitals, "score": 5, "lives": 0}
    assert struck == {"tick": 90, "cause": "hazard", **vitals}


@pytest.mark.parametrize("begins", [40, 90])
def test_the_living_are_compared_with_the_newest_state_of_their_cell(begins: int) -> None:
    """Before an organism's first tick, the counts of its cell are those of an earlier organism."""
    arrays = state(8)
    memory = digest(arrays["world.organisms.memory"][PLACE])
    own = {"tick": 90, "cause": "alive", "energy": 6.0, "food": 106.0, "memory": memory}
    senses = {"senses": digest(arrays["bodies.senses"][PLACE])}
    counts = {"score": 706, "lives": 806} if begins == 40 else {}
    assert recorded(life(begins=begins)) == {**own, **senses, **counts}
    body = digest(*(arrays[f"bodies.{name}"][PLACE] for name in ("senses", "y")))
    assert recorded(life("jax", begins=begins)) == {**own, "body": body}


def stretch(last: int, ticks: int, cause: int = -1) -> Stretch:
    """Return the ticks of a life up to tick `last`, in which it may end. No two numbers are equal."""
    tick = np.arange(last - ticks + 1, last + 1)
    none: Any = None
    ends = np.full(ticks, -1, np.int32)
    ends[-1] = cause
    counts = np.stack([tick + 1000, tick + 2000], axis=1)
    return Stretch(tick, none, none, none, ONE * tick, ONE * (tick + 100), ends, counts)


def held(cells: int) -> dict[str, np.ndarray]:
    """Return the part of a state that belongs to the last of its organisms."""
    wanted = ("memory", "energy", "eaten", "senses")
    return {name: each[-1:] for name, each in state(cells).items() if name.endswith(wanted)}


def found(lived: Any, *stretches: Stretch) -> dict[str, Any]:
    """Live a life that has these stretches, and return the values found."""
    steps: list[Any] = [(held(3), None), *((held(4 + n), s) for n, s in enumerate(stretches))]
    lived.instants = lambda: iter(steps)
    course = Course(lived)
    assert list(course.stretches()) == list(stretches)
    return course.found()


def test_the_values_of_the_living_are_those_at_the_end_of_the_last_stretch() -> None:
    last = held(5)
    senses, memory = last["bodies.senses"], last["world.organisms.memory"]
    digests = {"memory": digest(memory), "senses": digest(senses)}
    values = {"energy": 90.0, "food": 190.0, "score": 1090, "lives": 2090}
    both = stretch(70, 30), stretch(90, 20)
    assert found(life(), *both) == {"cause": "alive", "tick": 90, **digests, **values}
    recorded_as_dead = found(life(cause=Cause.STARVED), *both)
    assert recorded_as_dead == {"cause": "alive", **digests, **values}
    begun = held(3)
    assert found(life(begins=90)) == {
        "cause": "alive", "tick": 90, "energy": 2.0, "food": 102.0,
        "memory": digest(begun["world.organisms.memory"]), "senses": digest(begun["bodies.senses"]),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("cause", "on_record"),
    [
        (Cause.FATAL, Cause.STARVED),
        (Cause.STARVED, Cause.REPLACED),
        (Cause.HAZARD, None),
    ],
)
def test_a_death_in_the_relived_life_has_its_own_cause_whatever_the_record_says(
    cause: Cause, on_record: Cause | None
) -> None:
    """Memory and body have no meaning after a death."""
    values = {"energy": 85.0, "food": 185.0, "score": 1085, "lives": 2085}
    end = stretch(85, 15, int(cause))
    assert found(life(cause=on_record), stretch(70, 30), end) == {
        "cause": cause.label, "tick": 85, **values,
    }  # fmt: skip


def test_a_life_is_replaced_if_a_child_is_born_in_its_cell_at_its_end() -> None:
    values = {"energy": 90.0, "food": 190.0, "score": 1090, "lives": 2090}
    lived = life(cause=Cause.REPLACED)
    assert found(lived, stretch(90, 50)) == {"cause": "replaced", "tick": 90, **values}
    for name, value in (("born", 89), ("cell", 3), ("world", 0)):
        lived = life(cause=Cause.REPLACED)
        getattr(lived.run.lives, name)[0] = value
        assert found(lived, stretch(90, 50))["cause"] == "alive"


@pytest.mark.parametrize("cause", [None, Cause.FATAL, Cause.STARVED])
def test_an_organism_with_its_own_cause_of_death_is_not_replaced(cause: Cause | None) -> None:
    lived = life(cause=Cause.REPLACED)
    end = stretch(90, 50, -1 if cause is None else int(cause))
    lived.instants = lambda: iter([(held(3), None), (held(4), end)])
    course = Course(lived)
    assert len(list(course.stretches())) == 1
    assert course.replaced == (cause is None)
