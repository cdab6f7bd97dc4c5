"""Living again: the state with which a life begins, the notes of a comparison, and the result."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock, call, patch

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.law.world import Cause
from primordia.organism.reliving import compare, diary, replay
from primordia.organism.reliving.compare import Reliving, Respect
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import checkpoint, directory

A_RUN = MagicMock(made_on="cpu")
KEPT = ({"ticks": [9, 1200]}, {"ticks": [9, 1100]}, {"ticks": [9, 60]})
"""States of a run of two worlds, newest first; the first world has stopped at tick 9."""


def stored(
    monkeypatch: pytest.MonkeyPatch, since: int | None, born: int = 60, ended: int = 1300
) -> int | None:
    """Return the tick of the state with which a life begins; None if it begins at birth."""
    # the life of organism 3 of world 1
    lives = SimpleNamespace(
        row=lambda organism, world: {(3, 1): 2}[organism, world],
        born=np.array([0, 0, born]),
        ended=np.array([5, 5, ended]),
    )
    run: Any = SimpleNamespace(path="RUN", lives=lives, fault_in=None, arrays_of=dict)
    monkeypatch.setattr(checkpoint, "whole_checkpoints", lambda *given: iter(KEPT))
    monkeypatch.setattr(compare, "world_ticks", lambda arrays: arrays["ticks"])
    found = compare._stored(run, 3, 1, since)
    return None if found is None else int(found["ticks"][1])


@pytest.mark.parametrize(
    ("since", "begins"),
    [(None, None), (10**9, 1200), (1200, 1200), (1199, 1100), (1100, 1100), (1099, 60), (60, 60)],
)
def test_a_life_begins_with_the_newest_state_that_is_not_later(
    monkeypatch: pytest.MonkeyPatch, since: int | None, begins: int | None
) -> None:
    assert stored(monkeypatch, since) == begins


@pytest.mark.parametrize(
    ("born", "ended", "begins"), [(60, 61, 60), (60, 1100, 60), (61, 1101, 1100), (61, 1200, 1100)]
)
def test_a_life_begins_with_a_state_that_it_outlives(
    monkeypatch: pytest.MonkeyPatch, born: int, ended: int, begins: int
) -> None:
    """An organism may be born in the tick of the state, but must not die in it."""
    assert stored(monkeypatch, 10**9, born, ended) == begins


@pytest.mark.parametrize(
    ("since", "born", "ended", "says"),
    [
        (59, 60, 1300, "from tick 60 to 1,300; RUN keeps only later .*: 1,200 and 1,100 and 60$"),
        (1099, 61, 1300, "from tick 61 to 1,300; RUN keeps only later .*: 1,200 and 1,100$"),
        (500, 1101, 1200, "from tick 1,101 to 1,200, and RUN keeps no checkpoint of these"),
        (500, 61, 1100, "from tick 61 to 1,100, and RUN keeps no checkpoint of these"),
    ],
)
def test_if_no_state_is_early_enough_the_error_says_which_are_kept(
    monkeypatch: pytest.MonkeyPatch, since: int, born: int, ended: int, says: str
) -> None:
    with pytest.raises(InputError, match=f"^--from {since}: organism 3 lived {says}"):
        stored(monkeypatch, since, born, ended)


@pytest.mark.parametrize(
    ("progress", "given", "notes"),
    [
        ({}, {}, []),
        ({}, {"replaced": True}, ["a child took the cell in the last tick; neighbours were not"]),
        ({}, {"written": True}, ["the run goes on; the records end at tick 1,500"]),
        ({"exact": False}, {}, ["is not sure: parts of this run cannot be repeated"]),
        ({"exact": False}, {"other": ["a 1 then", "b 2 then"]}, ["not sure: a 1 then; b 2 then"]),
        ({"restarts": 1}, {}, ["the living got new bodies once, when the run was resumed"]),
        ({"restarts": 1234}, {}, ["the living got new bodies 1,234 times, when the run"]),
        ({}, {"faults": ["2 is damaged", "1 is missing"]}, ["2 is damaged; an older checkpoint"]),
    ],
)
def test_each_limit_of_a_comparison_is_noted_once(
    monkeypatch: pytest.MonkeyPatch, progress: dict[str, Any], given: dict[str, Any], notes: list
) -> None:
    """One world stopped earlier than the other."""
    monkeypatch.setattr(directory, "is_written", lambda path: given.get("written", False))
    run: Any = SimpleNamespace(
        path="RUN",
        progress=SimpleNamespace(**{"exact": True, "restarts": 0, **progress}),
        newest=("a checkpoint", given.get("faults", [])),
        ends=np.array([1500, 900]),
        other_versions=given.get("other", []),
    )
    course: Any = SimpleNamespace(replaced=given.get("replaced", False))
    found = compare._notes(run, course)
    assert len(found) == len(notes)
    assert all(part in note for part, note in zip(notes, found, strict=True))


def test_a_life_of_one_tick_can_be_saved_and_one_of_no_tick_cannot(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    written: list[Any] = []
    monkeypatch.setattr(diary, "write", lambda path, stretches, counts: written.append(counts))

    def lived(ends: int) -> Any:
        run = SimpleNamespace(schema=SimpleNamespace(tallies=("score",)))
        return SimpleNamespace(begins=5, ends=ends, record=SimpleNamespace(id=[3]), run=run)

    compare._lived(lived(6), Path("a.npz"))
    assert written == [("score",)]
    with pytest.raises(InputError, match="organism 3 has not lived a tick yet"):
        compare._lived(lived(5), Path("a.npz"))


def test_a_reliving_has_plain_values_for_json() -> None:
    respects = (Respect("tick", 9, 9), Respect("cause", "starved", None))
    found = Reliving(3, 1, "fork", 60, 1300, respects, ("a note",), (Path("a.npz"),))
    assert found.to_dict() == {
        "organism": 3, "world": 1, "begin": "fork", "begins": 60, "ends": 1300, "agrees": False,
        "respects": [
            {"name": "tick", "recorded": 9, "relived": 9, "agrees": True},
            {"name": "cause", "recorded": "starved", "relived": None, "agrees": False},
        ],
        "notes": ["a note"], "files": ["a.npz"],
    }  # fmt: skip
    assert Reliving(3, 1, "birth", 0, 9, respects[:1], (), ()).agrees


@pytest.fixture
def again() -> Iterator[MagicMock]:
    """Replace the life of organism 3 and its record; return the replacements.

    World 7 of the arm is world 1 of its run. The life is lived again from tick 60 to tick 90.
    """
    made = MagicMock()
    made.life = SimpleNamespace(stored=None, begins=60, cause=None)
    made.course.found.return_value, made.course.tick = {"tick": 90, "food": 2}, 90
    with (
        patch.object(compare, "run_of", return_value=("a run", 1)),
        patch.object(compare, "_stored", return_value=None) as made.stored,
        patch.object(RelivedLife, "of", return_value=made.life) as made.of,
        patch.object(compare, "recorded", return_value={"tick": 90, "food": 2}) as made.recorded,
        patch.object(compare, "_lived", return_value=made.course) as made.lived,
        patch.object(compare, "_notes", return_value=["a note"]),
        patch.object(replay, "parts_of", return_value="the parts") as made.parts,
        patch.object(replay, "film") as made.film,
    ):
        yield made


@pytest.mark.parametrize(
    ("stored", "since", "begin"),
    [(None, None, "birth"), ({}, None, "fork"), ({}, 0, "checkpoint"), ({}, 60, "checkpoint")],
)
def test_the_result_says_whether_a_life_began_with_birth_fork_or_checkpoint(
    stored: Any, since: int | None, begin: str, again: MagicMock
) -> None:
    again.life.stored = stored
    found = compare.relive(A_RUN, 3, 7, since=since)
    assert (found.organism, found.world) == (3, 7)
    assert (found.begin, found.begins, found.ends) == (begin, 60, 90)
    assert again.stored.call_args == call("a run", 3, 1, since)
    assert again.of.call_args == call("a run", 3, 1, again.stored.return_value)
    assert again.lived.call_args == call(again.life, None)
    assert (found.agrees, found.notes, found.files) == (True, ("a note",), ())
    again.film.assert_not_called()


@pytest.mark.parametrize("save", [None, Path("a.npz")])
@pytest.mark.parametrize("recorded", [{"tick": 90, "food": 2}, {"tick": 90, "food": 3}, {"x": 0}])
def test_only_a_life_that_agrees_in_all_respects_is_filmed(
    recorded: dict[str, int], save: Path | None, again: MagicMock
) -> None:
    """A value that the relived life lacks differs, too. The life is saved in each case."""
    again.recorded.return_value = recorded
    found = compare.relive(A_RUN, 3, 7, save=save, film=Path("b.gif"))
    assert again.lived.call_args == call(again.life, save)
    saved = [] if save is None else [save]
    if recorded == {"tick": 90, "food": 2}:
        again.film.assert_called_once_with(Path("b.gif"), (again.life, "the parts"))
        assert (found.notes, found.files) == (("a note",), (*saved, Path("b.gif")))
    else:
        again.film.assert_not_called()
        not_made = "b.gif was not made, since the life differs from its record"
        assert (found.notes, found.files) == (("a note", not_made), (*saved,))


@pytest.mark.parametrize("cause", Cause)
def test_only_a_life_that_lost_its_body_cannot_be_lived_again(
    cause: Cause, again: MagicMock
) -> None:
    again.life.cause, again.life.record = cause, SimpleNamespace(id=[3])
    if cause is not Cause.RESTART:
        assert compare.relive(A_RUN, 3, 7).agrees
        return
    with pytest.raises(InputError, match=r"^organism 3 ended when its run was resumed"):
        compare.relive(A_RUN, 3, 7)
