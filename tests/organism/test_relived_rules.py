"""Rules of lives that are lived again: where each begins and ends, and how its end is compared."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.errors import InputError, Trouble
from primordia.law.metabolism import ONE, Rates
from primordia.law.world import Cause
from primordia.organism.reliving import relived
from primordia.organism.reliving.instant import Stretch
from primordia.organism.reliving.relived import RelivedLife
from tests.organism.test_relived import life_of


def stretch(ticks: np.ndarray, death: int | None = None, cause: Cause = Cause.FATAL) -> Stretch:
    """Return ticks of a life that may die; the energy is the tick, the food twice the tick."""
    none: Any = None
    causes = np.where(ticks == death, int(cause), -1).astype(np.int32)
    energy, eaten = (ONE * ticks).astype(np.int32), (2 * ONE * ticks).astype(np.int32)
    return Stretch(ticks, none, none, none, energy, eaten, causes, none)


class Alone:
    """A life of stretches of 4 ticks, which may die."""

    TICKS = 4

    def __init__(self, death: int | None) -> None:
        self.death, self.asked, self.closed = death, list[Any](), 0

    def live(self, now: int, ticks: np.ndarray, rates: Any, count: int) -> tuple[int, Stretch]:
        self.asked.append((now, ticks.tolist(), rates, count))
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
    """Every call has four ticks, of which those after the end do not count."""
    alone = Alone(death)
    monkeypatch.setattr(RelivedLife, "_alone", lambda self, watched: alone)
    monkeypatch.setattr(RelivedLife, "_start", lambda self, alone: 0)
    monkeypatch.setattr(RelivedLife, "_climate", lambda self, ticks: f"climate of {ticks[0]}")
    monkeypatch.setattr(RelivedLife, "_with_accidents", lambda self, stretch, *given: stretch)
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
        (number, list(range(first, first + 4)), f"climate of {first}", min(4, 51 - first))
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
def test_what_was_born_up_to_a_fork_begins_with_the_state_of_the_fork(
    born: int, given: Any, begin: str | None, exact: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The fork is at tick 40. A state is of use only if the habitat can save bodies."""
    monkeypatch.setattr(relived, "rebuild", lambda run, *place: np.float32([*place]))
    lives = SimpleNamespace(
        row=lambda organism, world: {(5, 1): 0}[organism, world],
        take=lambda rows: SimpleNamespace(born=np.array([born])),
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


def test_a_stored_life_goes_on_with_what_its_own_cell_holds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Organism 5 of world 1 is at place 6 of the arrays."""
    monkeypatch.setattr(relived, "place_in", lambda arrays, *place: {(5, 1): 6}[place])
    names = "world.organisms.memory", "world.organisms.energy", "world.organisms.eaten", "bodies.y"
    arrays: Any = {
        name: 10 * number + np.arange(8, dtype=np.int32)[:, *([None] * (name in names[::3]))]
        for number, name in enumerate(names)
    }
    alone: Any = SimpleNamespace(restore=lambda stored: stored)
    found = life_of(0)._restored(alone, arrays)
    energy, eaten = found.vitals
    assert (found.memory.tolist(), energy.tolist(), eaten.tolist()) == ([[6]], [16], [26])
    bodies: Any = found.bodies
    assert {name: body.tolist() for name, body in bodies.items()} == {"bodies.y": [[36]]}


WHEN = np.arange(60, 73)


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
def test_a_stretch_is_compared_with_the_cause_the_energy_and_the_food_of_the_death(
    cause: Cause, lived: Stretch, same: bool
) -> None:
    """The organism died in tick 72, with an energy of 72 and a food of 144."""
    life = life_of(1, path="RUN")
    life.record.cause[0] = cause
    vars(life)["death"] = {"energy": 72.0, "food": 144.0}
    if same:
        return life._check(lived)
    with pytest.raises(Trouble, match="did not repeat as recorded"):
        life._check(lived)


def test_the_seed_of_a_life_is_that_of_its_world() -> None:
    seed = life_of(0, world_seeds=np.array([7, 2**33 + 5, 9], np.uint64))._seed
    assert (np.asarray(seed.hi).tolist(), np.asarray(seed.lo).tolist()) == ([2], [5])
