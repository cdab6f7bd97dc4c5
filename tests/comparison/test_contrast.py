"""Contrasts of two runs' worlds: pairs, bounds and intervals, for worlds stopped for any reason."""

from dataclasses import replace

import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st

from primordia.comparison import needed, resample
from primordia.comparison.contrast import contrast
from primordia.comparison.measured import Measured
from primordia.comparison.pairs import Paired
from primordia.comparison.resample import LEAST, resamples
from primordia.errors import InputError

WORLD = st.tuples(st.integers(1, 20), st.booleans())
SOME = st.lists(WORLD, min_size=1, max_size=12)


def figures(worlds: list[tuple[int, bool]]) -> Measured:
    value, known = (np.array(column) for column in zip(*worlds, strict=True))
    return Measured(value.astype(float), known)


@given(SOME, SOME)
def test_delta_counts_pairs_whose_order_is_known(run: list, reference: list) -> None:
    effect = contrast(figures(run), figures(reference))
    balance = decided = 0
    for value, known in run:
        for other, other_known in reference:
            larger, smaller = other_known and value > other, known and value < other
            balance += larger - smaller
            decided += larger or smaller or (known and other_known)
    pairs = len(run) * len(reference)
    assert effect.delta == pytest.approx(balance / pairs)
    assert effect.decided == pytest.approx(decided / pairs)


@given(SOME, st.lists(st.integers(0, 30), min_size=12, max_size=12))
def test_bounds_hold_for_every_future_of_the_worlds(run: list, on: list[int]) -> None:
    later = [value + more * (not known) for (value, known), more in zip(run, on, strict=False)]
    for q in (0.25, 0.5, 0.75):
        low, high = figures(run).quantile(q)
        assert low <= np.quantile(later, q, method="inverted_cdf") <= high
    known = Measured(np.array(later, float), np.ones(len(later), bool))
    base = figures([(5, True), (9, True), (12, True)])
    sure, unsure = contrast(known, base), contrast(figures(run), base)
    of_base = contrast(base, known), contrast(base, figures(run))
    for then, now in ((sure, unsure), of_base):
        assert now.ratio[0] <= then.ratio[0] == then.ratio[1] <= now.ratio[1]
        assert abs(then.delta - now.delta) <= 1 - now.decided + 1e-9


@given(SOME, st.integers(1, 25))
def test_a_horizon_ignores_what_happens_later(run: list, horizon: int) -> None:
    whole = figures(run)
    if any(not known and value < horizon for value, known in run):
        with pytest.raises(InputError, match="it is unknown"):
            whole.before(horizon)
        return
    near = whole.before(horizon)
    assert near.known.sum() == sum(known and value < horizon for value, known in run)
    assert near.value.max() <= horizon
    others = figures([(value if value < horizon else horizon + 7, True) for value, _ in run])
    assert contrast(near, others.before(horizon)).delta == 0


def test_resamples_are_even_and_independent() -> None:
    (drawn,) = resamples(20)
    (again,), (other,) = resamples(20), resamples(20, stream=1)
    assert drawn.shape == (1000, 20)
    counts = np.bincount(drawn.ravel(), minlength=20)
    assert scipy.stats.chisquare(counts).pvalue > 0.001
    assert (drawn == again).all()
    assert (drawn == other).mean() == pytest.approx(0.05, abs=0.01)


@pytest.mark.parametrize("numbers", [1, 6_000])  # parts of 1; of 300, and a last one of 100
def test_resamples_do_not_depend_on_their_parts(
    numbers: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    (whole,) = resamples(20)
    monkeypatch.setattr(resample, "NUMBERS", numbers)
    parts = list(resamples(20))
    assert len(parts) > 1
    np.testing.assert_array_equal(np.concatenate(parts), whole)


@pytest.mark.parametrize(
    ("bound", "below", "above"),
    [(0.147, "negligible", "small"), (0.33, "small", "medium"), (0.474, "medium", "large")],
)
def test_words_change_at_the_bounds_of_romano(bound: float, below: str, above: str) -> None:
    effect = contrast(figures([(1, True)] * LEAST), figures([(1, True)] * LEAST))
    for delta, word in ((bound - 1e-9, below), (bound, above), (bound + 1e-9, above)):
        assert replace(effect, delta=delta).word == replace(effect, delta=-delta).word == word


def test_plain_values_of_a_contrast_are_its_own() -> None:
    """Two worlds are censored, so 3 of 36 pairs are undecided; infinity becomes None."""
    run = figures([(2, True), (3, True), (4, False), (5, True), (6, True), (9, False)])
    reference = figures([(1, True), (2, True), (3, True), (4, True), (5, True), (6, True)])
    rows = np.arange(6), np.arange(6)
    effect = contrast(run, reference, rows, contrasts=2)
    larger = sum(value > other for value in (2, 3, 4, 5, 6, 9) for other in range(1, 7))
    smaller = sum(value < other for value in (2, 3, 5, 6) for other in range(1, 7))
    equal = 4
    assert larger + smaller + equal == 33
    assert effect.to_dict() == {
        "delta": (larger - smaller) / 36,
        "word": "medium",
        "decided": (larger + smaller + equal) / 36,
        "same_seeds": {"pairs": 6, "delta": 1.0},
        "ratio": [4 / 3, 5 / 3],
        "interval": [effect.interval[0], None],
        "coverage": 0.975,
        "needed": needed.of_pairs(Paired(6, 6, 0), 0.025),
    }
    assert effect.interval[1] == np.inf
    alone = contrast(run, reference).to_dict()
    assert (alone["same_seeds"], alone["coverage"]) == (None, 0.95)
    assert alone["needed"] == needed.of_each_run(effect.delta, 0.05)
    for contrasts in (2, 5):
        of_several = contrast(run, reference, contrasts=contrasts)
        assert of_several.needed == needed.of_each_run(effect.delta, 0.05 / contrasts)
    few = contrast(run.take(rows[0][:4]), reference)
    assert (few.worlds, few.to_dict()["interval"], few.needed) == (4, None, None)


@pytest.mark.parametrize("values", [(3, -1), (-1, 3), (3, 0), (-2, -1)])
def test_figures_that_are_not_positive_have_no_ratio(values: tuple[int, int]) -> None:
    run, reference = (figures([(value, True)] * LEAST) for value in values)
    effect = contrast(run, reference)
    assert effect.ratio == effect.interval == (0, np.inf)
    assert effect.delta == np.sign(values[0] - values[1])


def test_the_number_of_resamples_grows_with_the_number_of_contrasts() -> None:
    """The interval of one of four contrasts leaves out 1.25 % of 1,600 resamples: 10 at each end."""
    values = np.random.default_rng(4).lognormal(0, 1, (2, 41))
    run, reference = (Measured(each, np.ones(41, bool)) for each in values)
    medians = [
        np.median(each[np.concatenate([*resamples(41, stream, 1600)])], axis=1)
        for stream, each in enumerate(values)
    ]
    ratios = np.sort(medians[0] / medians[1])
    assert contrast(run, reference, contrasts=4).interval == (ratios[10], ratios[-1 - 10])
