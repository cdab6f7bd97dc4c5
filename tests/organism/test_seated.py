"""Games played side by side: the seats of players, the parts of a play, and the sums of a game."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.organism.playing import games
from primordia.organism.playing.games import Games, Players, play
from primordia.organism.playing.seats import Frozen, Stretch
from primordia.random.wide import wide


def players(count: int, kind: str = "host") -> Players:
    """Return players. Player k has the genome (k, k) and the key 10 + k."""
    genomes = np.repeat(np.arange(count, dtype=np.float32)[:, None], 2, axis=1)
    none: Any = None
    habitat: Any = SimpleNamespace(kind=kind)
    return Players(LAW, habitat, genomes, wide(np.arange(count) + 10), none)


LAW: Any = SimpleNamespace(alone="the law of an organism alone")


def script(count: int) -> Games:
    """Return games of k + 1 ticks for player k. Its actions are 10 k, 10 k + 1, ..."""
    none: Any = None
    actions = [10 * k + np.arange(k + 1) for k in range(count)]
    return Games(none, none, none, none, actions)


def frozen(count: int) -> Frozen:
    """Freeze the senses of each second player, and the memory of each third player."""
    number = np.arange(count)[:, None]
    return Frozen(number % 2 == 0, number % 3 == 0)


@pytest.mark.parametrize(
    ("at_once", "parts"),
    [(5, [[0, 1], [2, 3], [4]]), (1, [[0], [1], [2], [3], [4]]), (10, [[0, 1, 2, 3, 4]])],
)
def test_players_in_parts_keep_their_own_scripts_and_frozen_inputs(
    at_once: int, parts: list[list[int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The games of one player are never separated."""
    asked: list[Any] = []

    def play_at_once(own: Players, count: int, ticks: int, held: Any, repeated: Any) -> Games:
        numbers = own.genomes[:, 0].astype(int)
        asked.append(numbers.tolist())
        assert (count, ticks) == (2, 70)
        np.testing.assert_array_equal(held.senses, frozen(5).senses[numbers])
        np.testing.assert_array_equal(held.memory, frozen(5).memory[numbers])
        for actions, number in zip(repeated.actions, numbers, strict=True):
            np.testing.assert_array_equal(actions, script(5).actions[number])
        each = np.stack([numbers, 100 + numbers], axis=1)
        return Games(each, each > 3, each / 2, each + 7, [np.array([k]) for k in numbers])

    monkeypatch.setattr(games, "_play_at_once", play_at_once)
    monkeypatch.setitem(games.AT_ONCE, "host", at_once)
    found = play(players(5), 2, 70, frozen=frozen(5), script=script(5))
    assert asked == parts
    assert found.ticks.tolist() == [[k, 100 + k] for k in range(5)]
    assert found.over.tolist() == [[k > 3, True] for k in range(5)]
    assert found.food.tolist() == [[k / 2, 50 + k / 2] for k in range(5)]
    assert found.course.tolist() == [[k + 7, k + 107] for k in range(5)]
    assert [each.tolist() for each in found.actions] == [[k] for k in range(5)]


PLAYING = np.array([[1, 1, 1, 1], [1, 0, 1, 1], [1, 0, 0, 1], [1, 0, 0, 1]], bool)
"""Whether each game goes on in each tick, bool (4 ticks, 2 players with 2 games each)."""


def played(food: np.ndarray | None, marks: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> Games:
    """Play games of four ticks, in a stretch of three ticks and a stretch of one tick."""
    tick = np.arange(1, 5)[:, None]
    actions = tick + 10 * np.arange(4)
    alive = np.array([True, False, False, False])

    def given(*_: Any) -> Any:
        for part, after in ((slice(0, 3), PLAYING[3]), (slice(3, 4), alive)):
            eaten = None if food is None else food[part]
            yield Stretch(PLAYING[part], actions[part], eaten, marks[part], after)

    monkeypatch.setattr(games, "stretches", given)
    return play(players(2), 2, 4)


def marked(*changes: tuple[int, int]) -> np.ndarray:
    """Return marks of senses (T, N, 2). Those of the given ticks and games are changed."""
    marks = np.arange(32, dtype=np.uint32).reshape(4, 4, 2)
    for tick, game in changes:
        marks[tick, game] += np.uint32(1000)
    return marks


def test_a_game_counts_only_what_happens_while_it_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    food = np.array([[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [13, 14, 15, 16]], np.float32)
    found = played(food, marked(), monkeypatch)
    assert found.ticks.tolist() == [[4, 1], [2, 4]]
    assert found.over.tolist() == [[False, True], [True, True]]
    assert found.food.tolist() == [[1 + 5 + 9 + 13, 2], [3 + 7, 4 + 8 + 12 + 16]]
    assert [each.tolist() for each in found.actions] == [[1, 2, 3, 4], [21, 22]]
    without = played(None, marked(), monkeypatch)
    assert not without.food.any()
    later = np.where(PLAYING, food, 99).astype(np.float32)
    np.testing.assert_array_equal(played(later, marked(), monkeypatch).course, found.course)
    assert (played(food + 1, marked(), monkeypatch).course != found.course).all()


def test_courses_differ_if_senses_differ_in_any_tick_of_the_game(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    before = played(None, marked(), monkeypatch).course.ravel()
    courses = {}
    for tick in range(4):
        for game in range(4):
            after = played(None, marked((tick, game)), monkeypatch).course.ravel()
            expected = (np.arange(4) == game) & PLAYING[tick, game]
            np.testing.assert_array_equal(after != before, expected)
            courses[tick, game] = after[game]
    lasting = [int(courses[tick, 0]) for tick in range(4)]  # the same change at other ticks
    assert len(set(lasting)) == 4
