"""The lives that a check of a habitat plays: which bodies are born and stepped in which tick."""

from typing import Any

import numpy as np
import pytest
from PIL import Image

from primordia.habitats import Compound, Continuous, Discrete, HostHabitat, Outcome
from primordia.habitats.bodies import random_actions
from primordia.random.trials import words
from primordia.testing import ContractError
from primordia.testing.lives import HALF, TICKS, Lives, Past
from primordia.testing.report import ALL

LATER, SOONER = 9, 4
"""The ages at which bodies with an even word die. Bodies with a multiple of 4 die sooner."""


class Noted(HostHabitat):
    """A habitat that notes all calls. A body is the word of its birth, and its age."""

    senses_size, action, words = 2, Discrete(5), 1
    ends = "fatal"
    calls: list[tuple[Any, ...]]

    def __deepcopy__(self, _: object) -> "Noted":
        return self

    def __init__(self) -> None:
        self.calls = []

    def open(self, cells: int, watched: bool = False) -> None:
        self.calls.append(("open", cells, watched))
        self.bodies = np.zeros((cells, 2), np.float32)

    def close(self) -> None:
        self.calls.append(("close",))

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.calls.append(("reset", born.tolist(), words[:, 0].tolist()))
        self.bodies[born, 0], self.bodies[born, 1] = words[:, 0] % 1024, 0
        return self.bodies[born]

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        self.calls.append(("step", np.where(alive, action, -1).tolist()))
        self.bodies[alive, 1] += 1
        last = np.where(self.bodies[:, 0] % 4 == 0, SOONER, LATER)
        dies = (self.bodies[:, 0] % 2 == 0) & (self.bodies[:, 1] >= last)
        none = np.zeros(len(alive), bool)
        return self.bodies, Outcome(**{"fatal": none, self.ends: dies})  # the array of every tick

    def save(self) -> dict[str, np.ndarray]:
        return {"bodies": self.bodies}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.calls.append(("load", arrays["bodies"][:, 0].tolist()))
        self.bodies = arrays["bodies"]

    def seen(self) -> np.ndarray:
        return self.bodies

    def picture(self, body: Any, action: Any) -> Any:
        self.calls.append(("picture", body.tolist(), int(action)))
        return Image.new("RGB", (1, 1))

    def caption(self, body: Any, action: Any) -> str:
        return "a body"


WORD = words(0, ALL, 1)[:, 0]
ACTION = random_actions(Discrete(5), TICKS, ALL)
DIES = WORD % 1024 % 2 == 0
ENDS = np.where(DIES, np.where(WORD % 1024 % 4 == 0, SOONER, LATER), TICKS)
"""Ticks of each life."""


def stepped(calls: list[tuple[Any, ...]]) -> list[list[int]]:
    """Return the action of each cell in each step; -1 for cells that are not alive."""
    return [call[1] for call in calls if call[0] == "step"]


def ages(past: Past) -> list[int]:
    return [int(row[0][1]) for row in past]


def expected_steps(ages_by_tick: list[np.ndarray], bodies: np.ndarray) -> list[list[int]]:
    """Return actions by tick and cell; a body of a negative age, or at its end, has none."""
    return [
        [
            int(ACTION[age, body]) if 0 <= age < ENDS[body] else -1
            for age, body in zip(row, bodies, strict=True)
        ]
        for row in ages_by_tick
    ]


@pytest.mark.parametrize("ends", ["fatal", "fault", "expired"])
def test_all_lives_are_played_to_their_ends_side_by_side(
    ends: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Noted, "ends", ends)
    pasts = Lives(habitat := Noted()).whole()
    assert set(ENDS.tolist()) == {SOONER, LATER, TICKS}
    assert habitat.calls[0] == ("open", ALL, False)
    assert habitat.calls[1] == ("reset", list(range(ALL)), WORD.tolist())
    assert habitat.calls[-1] == ("close",)
    lived = [np.full(ALL, tick) for tick in range(TICKS)]
    assert stepped(habitat.calls) == expected_steps(lived, np.arange(ALL))
    for body, past in enumerate(pasts):
        assert ages(past) == list(range(ENDS[body] + 1))
        assert {row[0][0] for row in past} == {float(WORD[body] % 1024)}
        place = 1 + Outcome._fields.index(ends)
        assert [bool(row[place]) for row in past[1:]] == [
            bool(DIES[body]) and age == ENDS[body] for age in range(1, ENDS[body] + 1)
        ]


def test_the_counts_of_each_tick_are_noted_if_the_habitat_returns_the_same_array(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The count is the age of the body plus 7."""
    counts = np.zeros((ALL, 1), np.int32)

    def tally(self: Noted) -> np.ndarray:
        counts[:, 0] = self.bodies[:, 1] + 7
        return counts

    monkeypatch.setattr(Noted, "tally", tally)
    monkeypatch.setattr(Noted, "tallies", ("count",), raising=False)
    for body, past in enumerate(Lives(Noted()).whole()):
        assert [row[-1].tolist() for row in past[1:]] == [[8 + age] for age in range(ENDS[body])]


def test_lives_among_few_are_those_of_the_last_bodies_in_reversed_order() -> None:
    pasts = Lives(habitat := Noted()).among(3)
    who = np.array([ALL - 1, ALL - 2, ALL - 3])
    assert habitat.calls[:2] == [("open", 3, False), ("reset", [0, 1, 2], WORD[who].tolist())]
    assert stepped(habitat.calls) == expected_steps([np.full(3, at) for at in range(TICKS)], who)
    assert [len(past) for past in pasts] == [0] * (ALL - 3) + [ENDS[body] + 1 for body in who[::-1]]


def test_every_second_body_rests_for_three_ticks() -> None:
    pasts = Lives(habitat := Noted()).interrupted()
    rests = np.arange(ALL) % 2 == 0
    lived = [
        np.where(rests & (3 <= at < 6), -1, np.where(rests & (at >= 6), at - 3, at))
        for at in range(TICKS + 3)
    ]
    assert stepped(habitat.calls) == expected_steps(lived, np.arange(ALL))
    assert [len(past) for past in pasts] == (ENDS + 1).tolist()


def test_every_third_body_is_born_again_after_half_of_the_ticks() -> None:
    pasts = Lives(habitat := Noted()).born_late()
    again = np.arange(ALL) % 3 == 0
    born = [call[1:] for call in habitat.calls if call[0] == "reset"]
    assert born[1] == (np.flatnonzero(again).tolist(), WORD[again].tolist())
    assert len(born) == 2
    assert habitat.calls.index(("reset", *born[1])) == 2 + HALF
    lived = [np.where(again & (at >= HALF), at - HALF, at) for at in range(TICKS)]
    assert stepped(habitat.calls) == expected_steps(lived, np.arange(ALL))
    lasted = np.where(again, np.minimum(ENDS, TICKS - HALF), ENDS)
    assert [len(past) for past in pasts] == (lasted + 1).tolist()


@pytest.mark.parametrize("rows", [slice(None), slice(2, 3)])
def test_lives_go_on_after_half_of_the_ticks_from_what_was_saved(rows: slice) -> None:
    pasts = Lives(habitat := Noted()).restored(rows)
    who = np.arange(ALL)[rows]
    at = habitat.calls.index(("open", len(who), False), 1)
    first, second = habitat.calls[:at], habitat.calls[at:]
    assert len(stepped(first)) == HALF
    assert second[1] == ("load", [float(word % 1024) for word in WORD[who]])
    lived = [np.full(len(who), age) for age in range(HALF, TICKS)]
    assert stepped(second) == expected_steps(lived, who)
    for body, past in enumerate(pasts):
        assert ages(past) == (list(range(ENDS[body] + 1)) if body in who else [])


def test_the_second_of_two_bodies_is_drawn_with_the_action_of_its_tick(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    Lives(habitat := Noted()).drawn()
    assert habitat.calls[0] == ("open", 2, True)
    assert len(stepped(habitat.calls)) == 1
    drawn = ("picture", [float(WORD[1] % 1024), 1.0], int(ACTION[0, 1]))
    assert habitat.calls[-2:] == [drawn, ("close",)]
    monkeypatch.setattr(Noted, "caption", lambda *_: None)
    with pytest.raises(ContractError, match=r"^Noted returns None from caption; return a string$"):
        Lives(Noted()).drawn()


@pytest.mark.parametrize(
    ("saved", "says"),
    [
        ([0.0] * ALL, rf"saves 'x' as \({ALL},\); save NumPy arrays"),
        (np.zeros(ALL - 1), rf"saves 'x' as \({ALL - 1},\)"),
        (np.zeros(()), r"saves 'x' as \(\)"),
    ],
)
def test_what_is_saved_has_a_row_for_each_cell(
    saved: Any, says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Noted, "save", lambda _: {"x": saved})
    with pytest.raises(ContractError, match=says):
        Lives(habitat := Noted()).restored(slice(None))
    assert habitat.calls[-1] == ("close",)


def test_the_first_life_that_differs_is_named_with_its_age() -> None:
    def lives(*changes: tuple[int, int, int, float]) -> list[Past]:
        pasts: list[Past] = [
            [(np.float32(body), None, np.array([age])) for age in range(4)] for body in range(3)
        ]
        for body, age, part, value in changes:
            row = list(pasts[body][age])
            row[part] = np.float32(value)
            pasts[body][age] = tuple(row)
        return pasts

    part = Lives(Noted())
    part.compare(lives(), lives(), "twice")
    part.compare(lives(), [past[:2] for past in lives((1, 3, 0, 9.0))], "as far as both go")
    part.compare(lives(), [past[:1] for past in lives()], "as far as both go")
    for change in [(1, 3, 0, 9.0), (1, 3, 1, 0.0), (1, 3, 2, 9.0), (0, 3, 0, -0.0)]:
        says = f"^Noted: body {change[0]} has a different life at age 3 twice$"
        with pytest.raises(ContractError, match=says):
            part.compare(lives(), lives((2, 0, 0, 7.0), change), "twice")


def test_actions_are_of_their_kind_and_use_all_its_values() -> None:
    chosen = random_actions(Discrete(3), TICKS, ALL)
    assert (chosen.shape, chosen.dtype) == ((TICKS, ALL), np.int32)
    assert set(chosen.flat) == {0, 1, 2}
    many = random_actions(Discrete(3), 500, 32)
    np.testing.assert_allclose(np.bincount(many.ravel()) / many.size, [1 / 3] * 3, atol=0.02)
    moved = random_actions(Continuous(2), TICKS, ALL)
    assert (moved.shape, moved.dtype) == ((TICKS, ALL, 2), np.float32)
    assert abs(moved.mean()) < 0.2
    assert abs(moved.std() - 1) < 0.1
    both = random_actions(
        Compound((Continuous(2), Discrete(4), Continuous(1), Discrete(2))), TICKS, ALL
    )
    assert both.shape == (TICKS, ALL, 5)
    for column, values in ((2, {0.0, 1.0, 2.0, 3.0}), (4, {0.0, 1.0})):
        assert set(both[..., column].flat) == values
    for column in (0, 1, 3):
        assert len(set(both[..., column].flat)) > 300
