"""What a tick of an Atari game reports: senses, fatal events, food, scores, kills and lives."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("ale_py")

from primordia.config import load
from primordia.habitats.atari.habitat import Atari
from primordia.habitats.atari.simulator import console


def test_scores_are_sums_of_points_and_kills_are_ticks_with_points_for_the_player() -> None:
    """Points of a cell that does not live are not counted."""
    pong = Atari(game="pong")
    pong._tally = np.zeros((4, 3), np.int32)
    alive = np.array([True, True, True, False])
    for points in ([3, 0, -2, 5], [4, 0, 1, 5], [0, 0, -7, -1]):
        pong._count(np.array(points, np.float32), alive)
    assert pong.tally().tolist() == [[7, 2, 0], [0, 0, 0], [-8, 1, 0], [0, 0, 0]]
    assert pong.tallies == ("score", "kills", "lives")


def test_a_life_that_is_gained_is_no_life_lost() -> None:
    """The games have 3, 4, 2 and 2 lives after the tick; the last body is dead and keeps its 2."""
    none = np.zeros(4, bool)
    arrays = {"action": np.zeros(4, np.int32), "ram": np.zeros((4, 128), np.uint8), "game_over": none,
              "points": np.zeros(4, np.float32), "lives": np.array([3, 4, 2, 2])}  # fmt: skip
    game = Atari(game="pong", food="lives_lost", fatal="lives_lost > 1")
    stub: Any = SimpleNamespace(arrays=arrays, begin=lambda alive: None, finish=lambda: None)
    game._pool, game._tally = stub, np.zeros((4, 3), np.int32)
    game._lives = game._tally[:, 2]
    game._lives[:] = [4, 3, 4, 2]
    _, outcome = game.step(np.zeros(4, np.int32), np.array([True, True, True, False]))
    assert np.asarray(outcome.food).tolist() == [1, 0, 2, 0]
    assert np.asarray(outcome.fatal).tolist() == [False, False, True, False]
    assert game.tally()[:, 2].tolist() == [3, 4, 2, 2]


class Played:
    """An Atari habitat with two cells in a pool, in this process to save time."""

    def __init__(self, **settings: Any) -> None:
        self.habitat = Atari(**settings, workers=0)
        self.habitat.open(2)
        both = np.array([0, 1])
        self.senses = self.habitat.reset(both, np.zeros((2, self.habitat.words), np.uint32))

    def until(self, name: str, most: int = 3000, button: int = 0) -> tuple[int, Any]:
        """Step with one button, by default the first, until the first body reports the event."""
        for tick in range(1, most):
            _, outcome = self.habitat.step(np.full(2, button, np.int32), np.ones(2, bool))
            if np.asarray(getattr(outcome, name))[0]:
                return tick, outcome
        raise AssertionError(f"no {name} in {most} ticks")


def test_a_player_of_breakout_that_never_serves_still_gets_the_ball() -> None:
    """With any button held the ball comes; a player that stays on one side loses it."""
    settings = load("Breakout-survival-forager").habitat
    breakout = Played(**{name: value for name, value in settings.items() if name != "name"})
    assert breakout.habitat.action.size == 3
    assert breakout.until("fatal", 300, button=2)[0] > 60
    breakout.habitat.close()


def test_senses_are_the_selected_bytes_of_ram_scaled() -> None:
    played = Played(game="pong")
    ram = played.habitat._pool.arrays["ram"][0].astype(float)
    np.testing.assert_array_equal(played.senses[0], (ram - 128) / 128)
    some, blind = Atari(game="pong", senses=(51, 49)), Atari(game="pong", blind=True)
    for each in (some, blind):
        each._pool, each._lives = played.habitat._pool, played.habitat._lives
    np.testing.assert_array_equal(some._compute_senses(), played.senses[:, [51, 49]])
    assert some.senses_size == 2
    assert blind._compute_senses().tolist() == [[1.0] * 128] * 2


def test_a_lost_point_is_fatal_if_the_settings_say_so() -> None:
    first, _ = Played(game="pong", fatal="points < 0").until("fatal")
    second, _ = Played(game="pong", fatal="ram[13] == 2").until("fatal")
    assert first < second  # RAM 13 holds the opponent's score


def test_a_lost_life_is_reported() -> None:
    """It is reported once, in the tick in which an emulator without a habitat loses it."""
    settings: dict[str, Any] = {"fatal": "lives_lost > 0", "food": "lives_lost", "actions": "FIRE"}
    breakout = Played(game="breakout", frame_skip=3, **settings).habitat
    alone = console("breakout")
    (fire,) = breakout._buttons
    left, lost, both = alone.lives(), 0, np.ones(2, bool)
    for _ in range(400):
        _, outcome = breakout.step(np.zeros(2, np.int32), both)
        for _ in range(3):
            alone.act(fire)
        fewer = left - alone.lives()
        left, lost = alone.lives(), lost + fewer
        assert outcome.fatal.tolist() == [fewer > 0] * 2
        assert outcome.food.tolist() == [fewer] * 2
        assert breakout.tally()[:, 2].tolist() == [left] * 2
    assert lost >= 2
    breakout.close()


def test_tallies_are_of_the_present_life_and_of_its_own_ticks() -> None:
    """A cell that is not stepped keeps its tally, whatever its last points were."""
    pong = Played(game="pong", frame_skip=8, food="0 - points")
    pong.until("food")
    before = pong.habitat.tally().copy()
    assert (before[:, 0] == -1).all()
    for _ in range(5):
        pong.habitat.step(np.zeros(2, np.int32), np.array([False, True]))
    assert pong.habitat.tally().tolist() == before.tolist()
    pong.habitat.reset(np.array([1]), np.zeros((1, pong.habitat.words), np.uint32))
    assert pong.habitat.tally().tolist() == [before[0].tolist(), [0, 0, 0]]
    pong.habitat.close()
    breakout = Played(game="breakout", frame_skip=3, food="lives_lost", actions="FIRE")
    breakout.until("food")
    assert breakout.habitat.tally()[:, 2].tolist() == [4, 4]
    breakout.habitat.reset(np.array([0]), np.zeros((1, breakout.habitat.words), np.uint32))
    assert breakout.habitat.tally()[:, 2].tolist() == [5, 4]
    breakout.habitat.close()
