"""Decisions after a settled tick: which worlds go on, and which organisms died or were born.

There are three worlds. Functions of the law are replaced, so nothing is compiled.
"""

from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.engine import calls
from primordia.engine.calls import Unsettled, _Steps
from primordia.engine.held import Bulk, Form
from primordia.law import events
from tests.worlds import HERD, begun, law_of

CELLS = 2
"""Cells of each world."""


def cells(*numbers: int) -> Any:
    """Return a mask of the cells of all worlds."""
    return jnp.asarray(np.isin(np.arange(3 * CELLS), numbers))


def worlds(*numbers: int) -> Any:
    """Return a mask of the worlds."""
    return jnp.asarray(np.isin(np.arange(3), numbers))


def steps() -> _Steps:
    """Return the steps of a law whose worlds are not packed."""
    law: Any = SimpleNamespace(worlds=3, per_cell=lambda each: jnp.repeat(each, CELLS))
    form: Any = SimpleNamespace(release=lambda world, bulk: world, hold=lambda world: world)
    return _Steps(law, form)


@pytest.fixture
def patched(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Replace functions of the law. Return their results, and under "asked" the arguments they got."""
    given: dict[str, Any] = {"live": worlds(0, 2), "due": worlds(), "room": True, "asked": {}}

    def due(law: Any, now: str, ran: Any) -> Any:
        given["asked"]["ran"] = np.flatnonzero(ran).tolist()
        return given["due"]

    def left(law: Any, world: Any, limits: str, live: Any) -> str:
        given["asked"]["live"] = np.flatnonzero(live).tolist()
        return "left"

    monkeypatch.setattr(calls, "running", lambda _, limits: given["live"])
    monkeypatch.setattr(events, "have_room", lambda *_: given["room"])
    monkeypatch.setattr(calls, "moment_due", due)
    monkeypatch.setattr(calls, "ticks_left", left)
    return given


def world_with(alive: Any) -> Any:
    return SimpleNamespace(organisms=SimpleNamespace(alive=alive), worlds="now")


@pytest.mark.parametrize("room", [True, False])
@pytest.mark.parametrize(
    ("live", "due", "newborn"),
    [
        ((), (), ()),
        ((), (2,), (3,)),
        ((1,), (), (3,)),
        ((0, 2), (2,), ()),
        ((0, 1, 2), (0, 1, 2), range(6)),
    ],
)
def test_a_run_goes_on_while_a_world_runs_and_the_lists_have_room(
    live: tuple, due: tuple, newborn: Any, room: bool, patched: dict[str, Any]
) -> None:
    """One world is enough to remember a moment."""
    patched.update(live=worlds(*live), due=worlds(*due), room=room)
    alive = [0, 3, 4, 5]
    ran = worlds(0, 1)
    made = steps()._decide(
        world_with(cells(*alive)), "events", cells(1), cells(*newborn), ran, "limits"
    )
    assert np.flatnonzero(made.alive).tolist() == alive
    assert np.flatnonzero(made.died).tolist() == [1]
    assert np.flatnonzero(made.newborn).tolist() == list(newborn)
    active = [cell for cell in alive if cell // CELLS in live]
    assert np.flatnonzero(made.active).tolist() == active
    assert bool(made.go_on) == (len(live) > 0 and room)
    assert bool(made.remembered) == (len(due) > 0)
    assert (made.due, made.ran is ran) == ("left", True)
    assert patched["asked"] == {"ran": [0, 1], "live": list(live)}


def test_a_survey_has_no_deaths_and_no_births_and_no_world_that_ran(
    patched: dict[str, Any],
) -> None:
    made = steps().survey({}, world_with(cells(0, 5)), "events", "limits")
    assert not np.concatenate([made.died, made.newborn, made.ran]).any()
    assert patched["asked"] == {"ran": [], "live": [0, 2]}


def test_an_organism_has_died_if_its_cell_is_empty_or_has_a_newborn(
    patched: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """World 1 has stopped, so its organisms rest. Cell 0 stays empty, and cell 5 is newly occupied."""
    before, after = world_with(cells(1, 2, 4)), SimpleNamespace(organisms="lived", worlds="later")
    rested: list[list[int]] = []

    def rest(one: Any, other: str, active: Any) -> str:
        assert (one, other) == (before.organisms, "lived")
        rested.append(np.flatnonzero(active).tolist())
        return "rested"

    def settle(law: Any, world: Any, events: str, fates: str, ticks: int, ran: Any) -> tuple:
        assert (world.organisms, world.worlds, events) == ("rested", "later", "events")
        assert (fates, ticks, np.flatnonzero(ran).tolist()) == ("fates", 7, [0, 2])
        return world_with(cells(2, 4, 5)), "more events", cells(4, 5)

    monkeypatch.setattr(calls, "rest", rest)
    monkeypatch.setattr(calls, "settle", settle)
    monkeypatch.setattr(Bulk, "of", lambda world: "bulk")
    bulk, lists, held, made = steps().settle(
        Bulk({}, None), "events", before, Unsettled(after, "fates", 7), "limits"
    )
    assert rested == [[1, 4]]
    assert np.flatnonzero(made.died).tolist() == [1, 4]
    assert np.flatnonzero(made.newborn).tolist() == [4, 5]
    assert np.flatnonzero(made.ran).tolist() == [0, 2]
    packed: Any = held
    assert np.flatnonzero(packed.organisms.alive).tolist() == [2, 4, 5]
    assert (bulk, lists) == ("bulk", "more events")


def test_organisms_remember_their_senses_in_the_worlds_that_ran(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    form: Any = SimpleNamespace(release=lambda held, bulk: f"{held} with {bulk}")
    given: Any = "law", "bulk", "held", "senses", "ran"
    law, bulk, held, senses, ran = given
    monkeypatch.setattr(calls, "remember", lambda *asked: asked)
    monkeypatch.setattr(Bulk, "of", lambda world: world)
    made = _Steps(law, form).remember(bulk, held, senses, ran)
    assert made == ("law", "held with bulk", "senses", "ran")


def test_habitats_whose_bodies_need_other_words_share_all_other_calls() -> None:
    law = law_of(HERD).compiled
    form = Form.of(begun(law, np.arange(3, dtype=np.uint64)))
    one, other = calls.Calls(law, form, 2), calls.Calls(law, form, 30)
    differ = {name for name in vars(one) if getattr(one, name) is not getattr(other, name)}
    assert differ == {"words"}
