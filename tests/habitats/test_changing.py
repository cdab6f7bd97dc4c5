"""Changes within a life, in JAX and on the host: what changes, when, and from which draws."""

from typing import Any

import jax
import numpy as np
import pytest
from jax import lax

from primordia.compiled import shared
from primordia.config import load
from primordia.errors import InputError
from primordia.habitats.changing import Changed, advance, begin, changes_at
from primordia.habitats.contract import JaxHabitat
from primordia.testing import check_habitat
from tests.chance import binomial
from tests.worlds import MILL, Lived, config

BODIES, TICKS = 64, 120
REVERSED = {"kind": "reverse-actions", "at": [7, 30]}
PERMUTED = {"kind": "permute-actions", "every": [5, 40]}
WEAK = {"kind": "weaken", "of": [1], "range": [0.2, 0.6], "chance": 0.05}
INVERTED = {"kind": "invert-senses", "of": [0, 2], "every": [10, 10]}
CHANGES = [REVERSED, PERMUTED, WEAK, INVERTED]


def mill(*changes: dict[str, Any]) -> Any:
    """Return the mill with changes; without changes, the mill itself."""
    table = {"change": list(changes)} if changes else {}
    return config(MILL, habitat=table).build_habitat()


def lived(habitat: JaxHabitat, words: Any, actions: Any) -> tuple:
    """Live some ticks with given actions; return courses and senses at each age from 0, and bodies."""

    def tick(bodies: Any, action: Any) -> tuple:
        now = getattr(bodies, "course", None), habitat.sense(bodies)
        return habitat.step(bodies, action)[0], (now, getattr(bodies, "inner", bodies))

    past: Any = lax.scan(tick, habitat.reset(words), actions)[1]
    return *past[0], past[1]


RNG = np.random.default_rng(3)
WORDS = RNG.integers(0, 2**32, (BODIES, 4), dtype=np.uint32)
ACTIONS = RNG.normal(size=(TICKS, BODIES, 2)).astype(np.float32)


@pytest.fixture(scope="module")
def past() -> Any:
    """Return courses (T, N, ...), senses (T, N, 3) and inner bodies (T, N, 2) of mills that change."""
    return jax.tree.map(np.asarray, shared(lived, mill(*CHANGES))(WORDS, ACTIONS))


def test_changes_come_at_their_ages_periods_and_chances(past: Any) -> None:
    course = past[0]
    age = np.arange(TICKS)[:, None]
    assert (course.age == age).all()
    at, every, chance, fixed = np.moveaxis(course.times, 2, 0)
    np.testing.assert_array_equal(at, np.broadcast_to((age >= 7) * 1 + (age >= 30), at.shape))
    period = course.period[0, :, 1]
    assert period.min() >= 5
    assert period.max() <= 40
    assert len(set(period)) > 15
    np.testing.assert_array_equal(every, age // period)
    assert binomial(int(chance[-1].sum()), BODIES * (TICKS - 1), 0.05)
    np.testing.assert_array_equal(fixed, np.broadcast_to(age // 10, fixed.shape))


def test_the_ages_of_changes_can_be_told_from_any_moment_of_a_life(past: Any) -> None:
    course, made, ages = past[0], mill(*CHANGES), np.arange(1, TICKS)
    for number, moment in ((0, 0), (5, 50), (63, TICKS - 1)):
        now = jax.tree.map(lambda leaf, at=moment, own=number: leaf[at, own], course)
        came = (np.diff(course.times[:, number], axis=0) > 0).any(axis=1)
        np.testing.assert_array_equal(changes_at(made, Changed(None, now), ages), came)
    assert not changes_at(made, Changed(None, now), ages - TICKS).any(), (
        "none at an age of 0 or before"
    )
    assert not changes_at(mill(), None, ages).any()


def test_only_what_changes_is_changed_and_in_the_way_that_is_said(past: Any) -> None:
    course, senses, inner = past
    reversed_, order, factors, inverted = course.state
    first, second = inner[..., 0], inner[..., 1]
    plain = np.stack([first, second, first * second], axis=2)
    signs = np.where(inverted[..., None] & np.array([True, False, True]), -1, 1)
    np.testing.assert_array_equal(senses, plain * signs)
    np.testing.assert_array_equal(reversed_, course.times[..., 0] % 2 == 1)
    assert (np.sort(order, axis=2) == [0, 1]).all()
    assert (order[course.times[..., 1] == 0] == [0, 1]).all()
    later = order[course.times[..., 1] > 0]
    assert 0.2 < (later == [1, 0]).all(axis=1).mean() < 0.8
    assert (factors[..., 0] == 1).all()
    weak = factors[..., 1][course.times[..., 2] > 0]
    assert ((weak >= 0.2) & (weak <= 0.6)).all()
    assert weak.std() == pytest.approx(0.4 / np.sqrt(12), rel=0.2)


def test_each_change_draws_for_itself_from_both_words_of_a_birth() -> None:
    """Two changes with the same settings come at different ages."""
    often = {"kind": "reverse-actions", "chance": 0.5}
    made = mill(PERMUTED, PERMUTED, often, often)

    def started(words: Any) -> tuple[Any, Any]:
        course = begin(made.changes, made.action, words)
        return course.period, advance(made.changes, course).times

    drawn = jax.jit(started)
    period, times = (np.asarray(each) for each in drawn(WORDS))
    assert (period[:, 0] != period[:, 1]).mean() > 0.9
    assert 0.25 < (times[:, 2] != times[:, 3]).mean() < 0.75
    for place in (-2, -1):
        others = WORDS.copy()
        others[:, place] += np.uint32(1)
        assert (np.asarray(drawn(others)[0])[:, 0] != period[:, 0]).mean() > 0.9


def test_bodies_do_what_their_changed_actions_say(past: Any) -> None:
    """The same mill without changes goes the same way if it is given the changed actions."""
    course, _, inner = past
    reversed_, order, factors, _ = course.state
    actions = np.where(reversed_[..., None], -ACTIONS, ACTIONS)
    actions = np.take_along_axis(actions, order, axis=2) * factors
    plain = np.asarray(shared(lived, mill())(WORDS[:, :2], actions)[2])
    np.testing.assert_array_equal(inner, plain)


@pytest.mark.slow
def test_habitats_that_change_keep_the_contract() -> None:
    check_habitat(mill(*CHANGES))
    table = {"name": "tests.toys:Mirror", "change": [REVERSED, PERMUTED]}
    check_habitat(config(MILL, habitat=table, motor={"kind": "direct"}).build_habitat())


@pytest.mark.slow
def test_a_run_is_the_same_in_jax_and_on_the_host() -> None:
    """Chunks of other lengths and a life on the host change nothing."""
    change, many = {"change": [PERMUTED, INVERTED]}, {"replication": 0.3}
    mirror = {"name": "tests.toys:Mirror", "inner": "mill", **change}
    in_jax = Lived(config(MILL, habitat=change, **many), 200)
    on_host = Lived(config(MILL, habitat=mirror, **many), 200, 7)
    for name in ("births", "deaths"):
        one, other = in_jax.table(name), on_host.table(name)
        assert len(one["id"]) > 50
        for column in one:
            np.testing.assert_array_equal(one[column], other[column])


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"kind": "weaken", "at": [3]}, "habitat.change.0: the actions of this habitat are not amounts"),
        ({"kind": "invert-senses", "of": [4], "at": [3]}, "change.0: of: there is no number 4; the last"),
        ({"kind": "reverse-actions"}, "say when it changes, by one of at, every and chance"),
        ({"kind": "reverse-actions", "at": [3], "chance": 0.1}, "by one of at, every and chance"),
        ({"kind": "reverse-actions", "every": [9, 3]}, "the shortest period is longer than the longest"),
        ({"kind": "reverse-actions", "at": [0]}, "should be greater than or equal to 1"),
        ({"kind": "reverse", "at": [1]}, "habitat.change.0: .*'reverse'"),
        ({"kind": "weaken", "at": [1], "rang": [0, 1]}, "there is no setting 'habitat.change.0.*rang'"),
    ],
)  # fmt: skip
def test_a_wrong_change_is_named(change: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        load("CartPole-survival", {"habitat": {"change": [change]}})


@pytest.mark.parametrize("change", [[], "swap", {"kind": "reverse-actions", "at": [1]}])
def test_changes_are_a_list(change: Any) -> None:
    with pytest.raises(InputError, match="change: write a list of changes"):
        load("CartPole-survival", {"habitat": {"change": change}})
