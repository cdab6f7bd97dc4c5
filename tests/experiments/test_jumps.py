"""Sudden jumps of a world's course, as `experiments/jumps.py` finds them."""

from importlib import import_module
from typing import Any

import numpy as np
import pytest

from tests.experiments.test_shipped import EXPERIMENTS


@pytest.fixture
def jumps(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return the module `experiments/jumps.py`, which here draws a quarter as often."""
    monkeypatch.syspath_prepend(str(EXPERIMENTS))
    script = import_module("jumps")
    monkeypatch.setattr(script, "SHUFFLES", 100)
    monkeypatch.setattr(script, "SURROGATES", 49)
    return script


def test_jumps_are_found_where_they_are_and_nowhere_else(jumps: Any) -> None:
    """Steps are found at their places. Of 24 series of noise, few have a jump."""
    noise = np.random.default_rng(3)
    stairs = np.repeat([2.0, 4.0, 3.0, 6.0], [120, 200, 80, 100])

    def parted(series: np.ndarray) -> Any:
        return jumps.cut(series, jumps.penalty(series))

    steps = parted(stairs + 0.5 * noise.standard_normal(500))
    assert np.abs(np.array(steps.ends) - [120, 320, 400, 500]).max() <= 3
    np.testing.assert_allclose(np.log(steps.factors), [2, -1, 3], atol=0.3)
    steps_of_stairs = jumps.described(stairs)
    assert (steps_of_stairs["jumps"], steps_of_stairs["falls"]) == (2, 1)
    assert steps_of_stairs["largest jump"] == pytest.approx(np.exp(3), rel=0.01)
    flat = [len(parted(noise.standard_normal(200)).ends) > 1 for _ in range(24)]
    assert sum(flat) <= 6  # a twentieth of 24 is 1; more than 6 occur once in 10,000 tries
    assert len(parted(np.arange(19.0)).ends) == 1


def test_a_smooth_rise_has_no_sudden_jumps_and_a_step_has_one(jumps: Any) -> None:
    """Both have jumps, since a staircase is fitted to a smooth rise too."""
    noise, at = np.random.default_rng(5), np.linspace(0, 1, 300)
    smooth = [3 * at, 3 / (1 + np.exp(-12 * (at - 0.5))), 2 * np.sqrt(at), np.log1p(20 * at)]
    rises = [jumps.described(smooth[n % 4] + 0.4 * noise.standard_normal(300)) for n in range(12)]
    assert np.median([each["jumps"] for each in rises]) >= 2
    assert abs(np.mean([each["jumps"] - each["jumps if smooth"] for each in rises])) < 1
    assert sum(each["sudden jumps"] > 0 for each in rises) <= 3  # 0.6 are a twentieth
    assert sum(each["p of the largest"] <= 0.05 for each in rises) <= 3
    step = 2.0 * (at > 0.4)
    steps = [jumps.described(step + 0.3 * noise.standard_normal(300)) for _ in range(6)]
    assert all(each["jumps"] == 1 for each in steps)
    assert sum(each["sudden jumps"] == 1 for each in steps) >= 5
    assert sum(each["p of the largest"] <= 0.05 for each in steps) >= 5
