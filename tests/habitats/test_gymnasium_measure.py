"""How lives of an environment are compared: seeds, actions and records, and what follows from them."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from gymnasium import spaces

from primordia.habitats.gymnasium.check import (
    ENDED,
    GOING_ON,
    LIVES,
    TICKS,
    Measured,
    _Life,
    _repeat,
    _Trial,
    measure,
)
from tests.ponds import Pond, noted_seeds


def test_lives_that_do_not_end_share_the_ticks_and_have_seeds_of_their_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seeds = noted_seeds(monkeypatch)
    found = measure("tests.ponds:Pond-v0", {"edge": 1e9}, ())
    assert (found.lifespan, found.ended) == (TICKS / LIVES, 0)
    assert seeds[:LIVES] == [1, 3, 5, 7, 9, 11, 13, 15]
    assert set(seeds) == {0, *seeds[:LIVES]}  # a restored environment was reset with the seed 0


def test_random_actions_cover_the_whole_space(monkeypatch: pytest.MonkeyPatch) -> None:
    """Numbers have the bounds -1 and 3; a choice is the largest of its own outputs."""
    parts = [spaces.Box(-1, 3, (2,), np.float64), spaces.Discrete(3), spaces.Discrete(2)]
    monkeypatch.setattr(Pond, "action_space", spaces.Tuple(parts))
    trial = _Trial("tests.ponds:Pond-v0", {}, ())
    trial.first.action_space.seed(4)
    rows = trial._random_rows(50)
    trial.first.action_space.seed(4)
    for row in rows:
        drawn = trial.first.action_space.np_random.random(7)
        expected = [*(4 * drawn[:2] - 1), np.argmax(drawn[2:5]), np.argmax(drawn[5:])]
        np.testing.assert_allclose(row, expected)


def test_a_record_has_observation_reward_and_end() -> None:
    trial, seen = _Trial("tests.ponds:Pond-v0", {}, ()), np.array([3.0, 4.0])
    numbers = np.array([3.0, 4.0, 0.5]).tobytes()
    for terminated in (False, True):
        for truncated in (False, True):
            ends = ENDED if terminated or truncated else GOING_ON
            assert trial._seen(seen, 0.5, terminated, truncated) == numbers + ends


@pytest.mark.parametrize(
    ("seen", "reward", "changed", "fault"),
    [
        ([3.0, 4.0], 0.5, False, []),
        ([3.0, 10.0], 0.5, False, []),
        ([3.0, 4.0], np.nan, False, ["a reward is not finite"]),
        ([3.0, 4.0], -np.inf, False, ["a reward is not finite"]),
        ([3.0, 10.1], 0.5, False, ["an observation is outside the declared space"]),
        ([3.0, 4.0], 0.5, True, ["step changes the action that it is given"]),
    ],
)
def test_what_is_wrong_in_a_step_is_noted_once(
    seen: list[float], reward: float, changed: bool, fault: list[str]
) -> None:
    trial = _Trial("tests.ponds:Pond-v0", {}, ())
    for _ in range(2):
        trial._watch(trial.first, np.array(seen), reward, changed)
    assert trial.faults == fault


LIVED = {0: [b"a", b"b"], 1: [b"c", b"d"]}
"""The records of two lives."""


@pytest.mark.parametrize(
    ("change", "saving", "fresh", "says"),
    [
        ({}, "replay", False, []),
        ({("used", 0): [b"a", b"x"]}, "replay", True, ["a life depends on earlier lives"]),
        ({("used", 1): [b"c", b"x"]}, "replay", True, ["a life depends on earlier lives"]),
        ({("new", 0): [b"a", b"x"], ("twice", 0): [b"a", b"x"]}, "replay", True,
         ["a life depends on earlier lives"]),
        ({("twice", 0): [b"a", b"x"]}, "restart", False, ["the same seed and actions give another life"]),
        ({("twice", 1): [b"c", b"x"]}, "restart", False, ["the same seed and actions give another life"]),
        ({("twice", 0): [b"x", b"b"]}, "restart", False, ["a reset with the same seed gives another"]),
        ({("new", 1): [b"x", b"d"]}, "restart", False, ["a reset with the same seed gives another"]),
    ],
)  # fmt: skip
def test_one_life_that_does_not_repeat_is_enough(
    change: dict[Any, Any], saving: str, fresh: bool, says: list[str]
) -> None:
    """The lives are repeated in one used environment, and twice in new ones."""
    trial: Any = object.__new__(_Trial)
    made, times = iter(["used", *["new"] * 2, *["twice"] * 2]), dict[Any, Any]()

    def live(env: str, life: _Life) -> list[bytes]:
        times[env, life.seed] = True
        return change.get((env, life.seed), LIVED[life.seed])

    trial.new, trial.live = lambda: next(made), live
    lives = [_Life(seed, np.zeros((1, 1)), list(LIVED[seed])) for seed in (0, 1)]
    found = Measured()
    _repeat(trial, lives, found)
    assert (found.saving, found.fresh) == (saving, fresh)
    assert [fault[: len(text)] for fault, text in zip(found.faults, says, strict=True)] == says
    assert len(times) == 6
    if fresh:  # the lives in new environments are those with which others are compared
        assert [life.seen for life in lives] == [change.get(("new", k), LIVED[k]) for k in (0, 1)]
