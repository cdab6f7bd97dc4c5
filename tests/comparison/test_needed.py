"""How many worlds a claim needs, and intervals of several contrasts that hold together."""

import math

import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st

from primordia.comparison import needed
from primordia.comparison.contrast import contrast
from primordia.comparison.measured import Measured
from primordia.comparison.pairs import Paired
from primordia.comparison.resample import LEAST, RESAMPLES, enough, interval, least

LEVEL = st.sampled_from([0.05, 0.025, 0.01, 0.001])


def known(values: np.ndarray) -> Measured:
    return Measured(np.asarray(values, float), np.ones(len(values), bool))


@given(st.integers(0, 30), st.integers(0, 30), st.integers(1, 30), LEVEL)
def test_pairs_that_contradict_each_other_need_more_worlds(
    larger: int, smaller: int, more: int, level: float
) -> None:
    clear = larger + smaller + more
    effect, clearer = Paired(clear + 9, smaller + more, smaller), Paired(clear, clear, 0)
    needs = needed.of_pairs(effect, level) or 0
    assert needs >= (needed.of_pairs(clearer, level) or 0) > 0
    assert needs == needed.of_pairs(Paired(clear + 9, smaller, smaller + more), level)
    assert needs <= (needed.of_pairs(effect, level / 2) or 0)
    assert needed.of_pairs(Paired(clear + 9, smaller, smaller), level) is None


def test_the_numbers_are_those_of_noether() -> None:
    """Per run (z + z)^2 / (6 (p - 1/2)^2); pairs (z + z)^2 / (4 (p - 1/2)^2), of those without ties."""
    sum_of_z = scipy.stats.norm.ppf(0.975) + scipy.stats.norm.ppf(0.8)
    assert needed.of_each_run(0.4, 0.05) == math.ceil(sum_of_z**2 / (6 * 0.2**2)) == 33
    assert needed.of_pairs(Paired(10, 8, 2), 0.05) == math.ceil(sum_of_z**2 / (4 * 0.3**2)) == 22
    assert needed.of_pairs(Paired(20, 8, 2), 0.05) == math.ceil(2 * sum_of_z**2 / (4 * 0.3**2))


@pytest.mark.parametrize("worlds", [LEAST - 1, LEAST])
def test_few_worlds_and_no_effect_need_nothing(worlds: int) -> None:
    rows = np.arange(worlds), np.arange(worlds)
    some, more = known(np.arange(worlds)), known(np.arange(worlds) + 0.5)
    for pairs in (None, rows):
        assert contrast(some, some, pairs).needed is None
        assert (contrast(more, some, pairs).needed is None) == (worlds < LEAST)


@pytest.mark.parametrize(("contrasts", "worlds"), [(1, 5), (2, 6), (3, 7), (4, 7), (8, 8)])
def test_more_contrasts_take_more_worlds(contrasts: int, worlds: int) -> None:
    assert least(contrasts) == worlds
    few, wanted = (known(np.arange(1.0, n + 1)) for n in (worlds - 1, worlds))
    assert contrast(few, few, contrasts=contrasts).interval is None
    assert contrast(wanted, wanted, contrasts=contrasts).interval is not None
    assert contrast(wanted, wanted, contrasts=contrasts).word == "negligible"


@pytest.mark.parametrize("contrasts", [1, 2, 10, 100])
def test_an_interval_leaves_out_its_share_of_resamples_and_not_only_the_last(
    contrasts: int,
) -> None:
    missed = 0.05 / contrasts
    count = enough(missed)
    values = np.arange(float(count))
    low, high = interval(np.stack([values, -values], axis=1), missed)
    assert 10 <= low[0] == count - 1 - high[0] == -high[1] == low[1] + count - 1
    assert low[0] == pytest.approx(count * missed / 2, abs=1)
    assert enough(0.05) == RESAMPLES
