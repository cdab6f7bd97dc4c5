"""Lives in which an environment is measured: their seeds, actions and records, and their comparison."""

from itertools import product
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from gymnasium import spaces

from primordia.habitats.gymnasium import check
from primordia.habitats.gymnasium.check import (
    ENDED,
    GOING_ON,
    LIVES,
    Measured,
    _Life,
    _repeat,
    _Trial,
    measure,
)
from tests.ponds import Pond, noted_seeds


def test_lives_that_do_not_end_share_the_ticks_and_each_has_its_own_seed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(check, "TICKS", 10 * LIVES)
    seeds = noted_seeds(monkeypatch)
    found = measure("tests.ponds:Pond-v0", {"edge": 1e9})
    assert (found.lifespan, found.ended) == (10, 0)
    assert seeds[:LIVES] == [1, 3, 5, 7, 9, 11, 13, 15]
    beside = {seed + 1 for seed in seeds[:LIVES]}
    assert set(seeds) == {0, *seeds[:LIVES], *beside}  # 0: before a state is restored


def test_random_actions_cover_the_whole_space(monkeypatch: pytest.MonkeyPatch) -> None:
    """Numbers are uniform, choices have equal shares, and all are independent of each other."""
    parts = [spaces.Box(-1, 3, (2,), np.float64), spaces.Discrete(3), spaces.Discrete(2)]
    monkeypatch.setattr(Pond, "action_space", spaces.Tuple(parts))
    trial = _Trial("tests.ponds:Pond-v0", {})
    trial.first.action_space.seed(4)
    rows = trial._random_rows(5000)
    numbers, gear, side = rows[:, :2], rows[:, 2], rows[:, 3]
    np.testing.assert_allclose(np.quantile(numbers, [0, 0.25, 0.5, 0.75, 1], axis=0).T,
                               [[-1, 0, 1, 2, 3]] * 2, atol=0.1)  # fmt: skip
    np.testing.assert_allclose([np.mean(gear == k) for k in range(3)], [1 / 3] * 3, atol=0.03)
    np.testing.assert_allclose([np.mean(side == k) for k in range(2)], [1 / 2] * 2, atol=0.03)
    np.testing.assert_allclose(np.corrcoef(rows.T), np.eye(4), atol=0.06)


def test_records_differ_if_observation_reward_or_end_differ() -> None:
    trial = _Trial("tests.ponds:Pond-v0", {})
    ends = [(False, False), (False, True), (True, False), (True, True)]
    ticks = list(product(([3.0, 4.0], [3.0, 5.0], [6.0, 4.0]), (0.5, 0.25), ends))
    records = [trial._seen(np.array(seen), reward, *end) for seen, reward, end in ticks]
    assert len(set(records)) == 3 * 2 * 2
    for record, (_, _, end) in zip(records, ticks, strict=True):
        assert record.endswith(ENDED if any(end) else GOING_ON)


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
def test_each_fault_of_a_step_is_noted_once(
    seen: list[float], reward: float, changed: bool, fault: list[str]
) -> None:
    trial = _Trial("tests.ponds:Pond-v0", {})
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
    """Each life is repeated in a used environment, in a new one, and in a new one beside another life."""
    trial: Any = object.__new__(_Trial)
    made, repeated = iter(["used", *["new"] * 2, *["twice"] * 2]), list[Any]()

    def live(env: str, life: _Life, beside: str | None = None) -> list[bytes]:
        assert beside == ("used" if env == "twice" else None)
        repeated.append((env, life.seed))
        return change.get((env, life.seed), LIVED[life.seed])

    trial.new, trial.live = lambda: next(made), live
    lives = [_Life(seed, np.zeros((1, 1)), list(LIVED[seed])) for seed in (0, 1)]
    found = Measured()
    _repeat(trial, lives, found)
    assert (found.saving, found.fresh) == (saving, fresh)
    assert [fault[: len(text)] for fault, text in zip(found.faults, says, strict=True)] == says
    assert sorted(repeated) == [*product(("new", "twice", "used"), (0, 1))]
    if fresh:  # later lives are compared with those in new environments
        assert [life.seen for life in lives] == [change.get(("new", k), LIVED[k]) for k in (0, 1)]
