"""Dice, the table of quantiles, and random numbers of trials, compared with published numbers."""

from statistics import NormalDist

import numpy as np
import pytest

from primordia.random import dice, gaussian, trials
from primordia.random.keys import threefry
from primordia.random.wide import to_host, wide

SPLITMIX = [
    6457827717110365317,
    3203168211198807973,
    9817491932198370423,
    4593380528125082431,
    16408922859458223821,
]
"""The first numbers that the C code of SplitMix64's authors gives from 1234567."""


def test_dice_roll_the_high_halves_of_the_published_numbers() -> None:
    state, rolled = 1234567, []
    for _ in SPLITMIX:
        state, bits = dice.roll(state)
        rolled.append(bits)
    assert rolled == [number >> 32 for number in SPLITMIX]
    assert state == (1234567 + len(SPLITMIX) * 0x9E3779B97F4A7C15) % 2**64


def test_dice_begin_with_the_first_word_on_top() -> None:
    assert dice.begin(1, 2) == 2**32 + 2
    assert dice.begin(2**32 - 1, 2**32 - 1) == 2**64 - 1


def test_each_quantile_is_that_of_the_middle_of_its_share() -> None:
    """The i-th of 65,536 equal shares has its middle at i + 1/2."""
    table = gaussian.quantiles()
    assert table.shape == (65_536,)
    assert table.dtype == np.float32
    for i in (0, 1, 9_999, 32_767, 32_768, 50_000, 65_534, 65_535):
        assert NormalDist().cdf(float(table[i])) == pytest.approx((i + 0.5) / 65_536, rel=1e-4)
    np.testing.assert_array_equal(table, -table[::-1])


def test_quantiles_that_differ_from_other_machines_are_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(gaussian, "QUANTILES_SHA256", "0" * 64)
    with pytest.raises(RuntimeError, match="different Gaussian quantiles"):
        gaussian.quantiles.__wrapped__()


def test_random_numbers_of_trials_depend_on_their_name_and_place() -> None:
    """Word i is the high word of count i under the name; a Gaussian takes its upper 16 bits."""
    words = trials.words(7, 3, 4)
    expected = to_host(threefry(wide(7), wide(np.arange(12, dtype=np.uint64) << np.uint64(32))))
    assert words.dtype == np.uint32
    np.testing.assert_array_equal(words.ravel(), expected >> np.uint64(32))
    assert (words != trials.words(8, 3, 4)).all()
    normal = trials.normal(7, 3, 4)
    assert normal.dtype == np.float32
    np.testing.assert_array_equal(normal, gaussian.quantiles()[words // 65_536])
