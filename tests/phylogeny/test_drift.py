"""The neutral shadow, event by event: what is drawn, how often, and by which keys."""

from typing import Any

import numpy as np
import pytest

from primordia.phylogeny import drift as module
from primordia.phylogeny import slopes
from primordia.phylogeny.drift import Deal, drift
from primordia.phylogeny.living import Census, Turnover
from primordia.runs.lives import Lives
from tests.pedigrees import lives_of, moran, walked


def dealt(lives: Lives, ticks: list[int], lines: int) -> Any:
    return drift(lives, Turnover.of(lives), np.array(ticks), lines, seed=2)


def test_each_of_the_living_is_the_parent_or_dies_with_equal_probability() -> None:
    born = dealt(walked([([0], [])], founders=5), [0, 1], 5)
    died = dealt(walked([([], [0])], founders=5), [0, 1], 5)
    for found, changed, others in ((born, 2 / 6, 1 / 6), (died, 0, 1 / 4)):
        assert found.final.shape == (200, 5)
        assert np.sort(np.abs(found.final - others))[:, :4] == pytest.approx(0)
        mean = np.isclose(found.final, changed).mean(axis=0)
        assert mean.sum() == pytest.approx(1)
        assert mean == pytest.approx(np.full(5, 0.2), abs=0.1)
        np.testing.assert_allclose(found.largest[:, 0], 1 / 5)
        np.testing.assert_allclose(found.largest[:, 1], max(changed, others))
        np.testing.assert_allclose(found.effective[:, 0], 5)
    np.testing.assert_allclose(born.effective[:, 1], 36 / (4 * 1 + 4))
    np.testing.assert_allclose(died.effective[:, 1], 4)


def test_a_single_line_is_always_all_of_the_living() -> None:
    lives = walked([([0], []), ([0, 1], []), ([], []), ([], [0, 1, 2]), ([0], [])])
    found = dealt(lives, [0, 1, 2, 3, 4, 5], 1)
    assert (found.final == 1).all()
    assert (found.largest == 1).all()
    assert (found.effective == 1).all()


def test_founders_that_are_born_later_are_in_no_line() -> None:
    """The only line has one organism, which is alone until three founders are born."""
    lives = lives_of([-1] * 4, [0, 5, 5, 6], [9] * 4, [False] * 4)
    found = dealt(lives, [0, 3, 5, 9], 1)
    assert (found.largest == [1, 1, 1 / 3, 1 / 4]).all()
    assert (found.final == 1 / 4).all()
    assert (found.effective == 1).all()


def test_draws_depend_on_the_seed_the_first_tick_and_their_purpose() -> None:
    lives = moran(5, 40)

    def key(first: int, seed: int, what: int) -> tuple[int, int]:
        ticks = np.array([first, 30])
        found = Deal.of(lives, Turnover.of(lives), ticks, seed, what).key
        return int(found.hi), int(found.lo)

    given = [(4, 7, 0), (5, 7, 0), (4, 8, 0), (4, 7, 1), (4, 7, 0)]
    keys = [key(*each) for each in given]
    assert keys[0] == keys[-1]
    assert len({*keys}) == 4


def test_slopes_are_drawn_apart_from_the_course_of_all_lines(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[int] = []
    make: Any = Deal.of

    def of(lives: Lives, turnover: Turnover, ticks: np.ndarray, seed: int, what: int) -> Deal:
        asked.append(what)
        return make(lives, turnover, ticks, seed, what=what)

    monkeypatch.setattr(Deal, "of", of)
    monkeypatch.setattr(slopes, "_drift_on", lambda *_: None)
    lives = walked([([0], [])], founders=5)
    dealt(lives, [0, 1], 5)
    census = Census(lives, np.array([0, 1]))
    slopes.of_shadows(census, Turnover.of(lives), np.ones((2, 1), int), seed=2)
    assert len({*asked}) == len(asked) == 2


def test_more_draws_leave_fewer_shadows_within_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """The events are 40 births of founders. Each line with a slope is drawn."""
    lives = lives_of([-1] * 80, [0] * 40 + list(range(1, 41)), [40] * 80, [False] * 80)
    monkeypatch.setattr(module, "DRAWS", 40 * 2 * 300)
    monkeypatch.setattr(slopes, "MOST", 500)
    monkeypatch.setattr(slopes, "_drift_on", lambda *_: None)
    census = Census(lives, np.arange(0, 42, 2))
    for lines, shadows in ((2, 300), (1, 500), (4, 200)):
        counts = np.full((21, lines), 20)
        found = slopes.of_shadows(census, Turnover.of(lives), counts, seed=1)
        assert found.shape == (lines, shadows)


def test_a_line_grows_and_shrinks_by_its_share_and_ends_with_all_or_nothing() -> None:
    """Of five organisms, a line of one changes in a fifth of its shadows, a line of two in two fifths."""
    for history, step in (([([0], [])], 1), ([([], [0])], -1)):
        lives = walked(history, founders=5)
        deal = Deal.of(lives, Turnover.of(lives), np.array([0, 1]), seed=4, what=1)
        now = np.repeat([0, 1, 2, 3, 5], 50).astype(np.int32)
        before = now.copy()
        slopes._drift_on(now, deal, 0, 1)
        changed = (now - before).reshape(5, 50)
        assert not changed[0].any()
        assert (now[-50:] == 0).all()
        for count in (1, 2, 3):
            assert {*changed[count].tolist()} == {0, step}
            assert (changed[count] != 0).mean() == pytest.approx(count / 5, abs=0.16)


def test_shadows_of_lines_pass_each_event_once(monkeypatch: pytest.MonkeyPatch) -> None:
    passed: list[int] = []
    monkeypatch.setattr(slopes, "EVENTS", 7)
    monkeypatch.setattr(slopes, "_drift_on", lambda _, deal, *part: passed.extend(range(*part)))
    lives, ticks = moran(5, 60), np.array([3, 4, 5, 20, 60])
    counts = np.ones((5, 2), int)
    slopes.of_shadows(Census(lives, ticks), Turnover.of(lives), counts, seed=1)
    assert passed == list(range(2 * (60 - 3)))
