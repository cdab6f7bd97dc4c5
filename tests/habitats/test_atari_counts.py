"""What is counted in Atari games: points of all frames, scores and kills; and options of a console."""

from collections import defaultdict
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("ale_py")

from primordia.habitats.atari import simulator
from primordia.habitats.atari.habitat import Atari
from primordia.habitats.atari.simulator import Arcade, console
from primordia.random import dice


def test_scores_are_sums_of_points_and_kills_are_ticks_with_points_of_ones_own() -> None:
    """Points of a cell that does not live are not counted."""
    pong = Atari(game="pong")
    pong._tally = np.zeros((4, 3), np.int32)
    alive = np.array([True, True, True, False])
    for points in ([3, 0, -2, 5], [4, 0, 1, 5], [0, 0, -7, -1]):
        pong._count(np.array(points, np.float32), alive)
    assert pong.tally().tolist() == [[7, 2, 0], [0, 0, 0], [-8, 1, 0], [0, 0, 0]]
    assert pong.tallies == ("score", "kills", "lives")


@pytest.mark.parametrize(
    ("skip", "points"), [(1, [5, -1, 4]), (2, [4, 3]), (3, [8]), (4, [7]), (5, [9])]
)
def test_the_points_of_a_tick_are_those_of_all_its_frames(skip: int, points: list[int]) -> None:
    made, buttons = object.__new__(Arcade), list[int]()
    made._skip, made._sticky = skip, 0
    frames = iter([5, -1, 4, -1, 2])

    def act(button: int) -> int:
        buttons.append(button)
        return next(frames)

    ale: Any = type("Emulator", (), {"act": staticmethod(act)})
    assert [made._frames(ale, 0, 3) for _ in points] == points
    assert buttons == [3] * (skip * len(points))


def test_the_last_button_stays_down_if_the_word_is_below_its_share(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made, words = object.__new__(Arcade), iter([2**30, 2**30 - 1, 2**30 - 1, 2**32 - 1, 0])
    made._sticky, made._held, made._dice = 2**30, {0: 0, 1: 5}, {0: 7, 1: 7}
    monkeypatch.setattr(dice, "roll", lambda state: (state + 1, next(words)))
    assert [made._button(0, button) for button in (1, 2, 3, 4, 5)] == [1, 1, 1, 4, 4]
    assert (made._held, made._dice) == ({0: 4, 1: 5}, {0: 12, 1: 7})


def test_a_limited_number_of_emulators_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    kept: defaultdict[Any, list[Any]] = defaultdict(list)
    monkeypatch.setattr(simulator, "_SPARE", kept)
    monkeypatch.setattr(simulator, "SPARES", 3)
    pong, boxing = ("pong", None, None), ("boxing", None, None)
    for game, names in ((pong, "ab"), (boxing, "c"), (pong, "de"), (boxing, "fghi")):
        consoles: Any = {cell: (name, None) for cell, name in enumerate(names)}
        simulator._spare(game, consoles)
    assert kept == {pong: ["a", "b", "d"], boxing: ["c", "f", "g"]}


def test_a_life_that_is_won_is_no_life_lost() -> None:
    """The games have 3, 4, 2 and 2 lives after the tick; the last one stays as it was before."""
    none = np.zeros(4, bool)
    arrays = {"action": np.zeros(4, np.int32), "ram": np.zeros((4, 128), np.uint8), "game_over": none,
              "points": np.zeros(4, np.float32), "lives": np.array([3, 4, 2, 2])}  # fmt: skip
    game = Atari(game="pong", food="lives_lost", fatal="lives_lost > 1")
    stub: Any = SimpleNamespace(arrays=arrays, step=lambda alive: None)
    game._pool, game._tally = stub, np.zeros((4, 3), np.int32)
    game._lives = game._tally[:, 2]
    game._lives[:] = [4, 3, 4, 2]
    _, outcome = game.step(np.zeros(4, np.int32), np.array([True, True, True, False]))
    assert np.asarray(outcome.food).tolist() == [1, 0, 2, 0]
    assert np.asarray(outcome.fatal).tolist() == [False, False, True, False]
    assert game.tally()[:, 2].tolist() == [3, 4, 2, 2]


@pytest.mark.parametrize(
    ("name", "near"),
    [("Ms-Pacman", "ms_pacman, pacman"), ("tenis", "tennis, atlantis"), ("space", "space_war")],
)
def test_an_unknown_game_suggests_those_with_a_similar_name(name: str, near: str) -> None:
    with pytest.raises(ValueError, match=rf"there is no game '{name}'; did you mean {near}\?"):
        Atari(game=name)


@pytest.mark.parametrize("option", ["mode", "difficulty"])
def test_mode_and_difficulty_are_those_of_the_settings(
    option: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pong's mode and difficulty change what its memory holds."""
    made: list[tuple[Any, ...]] = []

    def noted(*given: Any) -> Any:
        made.append(given)
        return console(*given)

    monkeypatch.setattr(simulator, "console", noted)
    monkeypatch.setattr(simulator, "_SPARE", defaultdict(list))
    simulator._start.cache_clear()
    starts = []
    for value in (None, 1):
        chosen: dict[str, Any] = {option: value}
        game = Atari(game="pong", workers=0, **chosen)
        game.open(2)
        game.reset(np.arange(2), np.zeros((2, game.words), np.uint32))
        for _ in range(30):
            game.step(np.ones(2, np.int32), np.ones(2, bool))
        starts.append(game.seen()["ram"].copy())
        alone = console("pong", **chosen)
        fire = game._buttons[1]
        for _ in range(30):
            alone.act(fire)
        np.testing.assert_array_equal(starts[-1], [alone.getRAM()] * 2)
        game.close()
    simulator._start.cache_clear()
    place = 1 if option == "mode" else 2
    assert {given[place] for given in made} == {None, 1}
    assert (starts[0] != starts[1]).any()


@pytest.mark.parametrize(
    ("settings", "words"),
    [({}, 0), ({"noops": 1}, 2), ({"sticky": 0.1}, 2), ({"noops": 1, "sticky": 0.1}, 2)],
)
def test_a_birth_needs_random_words_if_no_ops_or_buttons_are_random(
    settings: dict[str, Any], words: int
) -> None:
    assert Atari(game="pong", **settings).words == words


def test_what_is_scored_has_points_as_food_and_all_other_settings_of_the_task() -> None:
    own: dict[str, Any] = {"senses": (49, 51), "sticky": 0.25, "noops": 30, "frame_skip": 4,
                           "actions": "NOOP UP", "mode": 1, "workers": 0}  # fmt: skip
    game = Atari(game="pong", fatal="points < 0", food="2", **own).original()
    assert game == Atari(game="pong", fatal="game_over", food="points", **own)
