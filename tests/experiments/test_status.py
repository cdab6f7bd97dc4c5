"""The figures of arms so far, from the counts of jobs alone."""

import numpy as np
import pytest

from primordia.experiments.status import _interval


@pytest.mark.parametrize("worlds", [5, 6, 9, 20, 100])
def test_the_interval_of_a_median_holds_it_as_often_as_promised(worlds: int) -> None:
    """Counted over samples of a law whose median is known."""
    draws = np.random.default_rng(worlds).exponential(size=(4000, worlds))
    intervals = [_interval(sample) or (np.nan, np.nan) for sample in draws]
    held = [low <= np.log(2) <= high for low, high in intervals]
    assert np.mean(held) > 0.93


def test_few_worlds_have_no_interval() -> None:
    assert _interval(np.arange(4.0)) is None
    assert _interval(np.arange(5.0)) == (0.0, 4.0)
