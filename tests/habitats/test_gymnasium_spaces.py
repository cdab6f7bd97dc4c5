"""Spaces of Gymnasium: observations become senses within bounds, outputs become actions of the space."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from gymnasium import spaces

from primordia.habitats import Compound, Continuous, Discrete
from primordia.habitats.gymnasium.spaces import Acting, Observation, described
from tests.ponds import Odd


def row_of(observation: Observation, value: Any) -> np.ndarray:
    row = np.zeros(observation.width, observation.dtype)
    observation.fill(row, value)
    return row


def test_all_observations_of_a_space_become_senses_of_one_length() -> None:
    space = Odd.observation_space
    observation = Observation(space)
    senses = observation.senses(np.ones(observation.width), squash=False)
    space.seed(3)
    for _ in range(100):
        sampled = space.sample()
        row = row_of(observation, sampled)
        where, free, side = sampled["where"].ravel(), sampled["free"], sampled["side"]
        numbers, flags = sampled["both"]
        expected = [
            *([numbers[0] == n for n in range(2)] + [numbers[1] == n for n in range(4)]),
            *(2 * flags.astype(float) - 1),
            *free,
            *[side == n for n in (-1, 0, 1)],
            *(where / 10),
        ]
        np.testing.assert_allclose(senses(row[None])[0], np.array(expected, np.float32), rtol=1e-6)
    assert senses.size == len(expected)


@pytest.mark.parametrize(
    ("box", "value", "sense"),
    [
        (spaces.Box(0, 255, (2,), np.uint8), [0, 255], [-1, 1]),
        (spaces.Box(-2, 6, (2,), np.float32), [0, 2], [-0.5, 0]),
        (spaces.Box(-np.inf, np.inf, (2,), np.float64), [-8, 6], [-2, 1.5]),
        (spaces.Box(-3e38, 3e38, (2,), np.float32), [-8, 6], [-2, 1.5]),
    ],
)
def test_bounds_and_scales(box: spaces.Box, value: list[float], sense: list[float]) -> None:
    """A number without bounds is divided by its scale, here 4."""
    observation = Observation(box)
    senses = observation.senses(np.full(2, 4.0), squash=False)
    found = senses(row_of(observation, np.array(value, box.dtype))[None])
    np.testing.assert_allclose(found[0], sense, rtol=1e-6)
    squashed = observation.senses(np.full(2, 4.0), squash=True)(
        row_of(observation, np.array(value, box.dtype))[None]
    )
    bounded = np.isfinite(box.low[0]) and box.high[0] < 1e6
    wanted = np.array(sense) if bounded else np.array(sense) / (1 + np.abs(sense))
    np.testing.assert_allclose(squashed[0], wanted, rtol=1e-6)


def test_whatever_a_brain_puts_out_is_an_action_of_the_space() -> None:
    acting = Acting(Odd.action_space)
    kinds = (Continuous(2), Discrete(2), Discrete(2), Discrete(2), Discrete(3), Discrete(4))
    assert acting.kind == Compound(kinds)
    rng = np.random.default_rng(0)
    seen = set()
    for row in range(200):
        columns = [rng.integers(part.size) for part in kinds[1:]]
        law = np.array([*(10 ** rng.uniform(-1, 6) * rng.normal(size=2)), *columns], np.float32)
        law[1] = abs(law[1])  # its bounds are 0 and none, which no brain knows
        action = acting.build(acting.rows(law[None])[0])
        assert Odd.action_space.contains(action), row
        assert action[0][1] == law[1]
        seen.add((action[2], *action[1]["gear"]))
    assert seen == {(a, b, c) for a in range(7, 11) for b in (1, 2) for c in (-1, 0, 1)}


def test_outputs_from_minus_one_to_one_cover_the_bounds() -> None:
    low, high = np.float32([-2, 0, -0.4]), np.float32([2, 8, 0.4])
    acting = Acting(spaces.Box(low, high))
    rows = acting.rows(np.array([[-1, -1, -1], [0, 0, 0], [1, 1, 1], [9, 9, -9]], np.float32))
    np.testing.assert_allclose(rows, [[-2, 0, -0.4], [0, 4, 0], [2, 8, 0.4], [2, 8, -0.4]])
    for row in rows:
        built = acting.build(row)
        assert built.dtype == np.float32
        assert (built >= low).all()
        assert (built <= high).all()


def test_whole_numbers_are_the_nearest_to_the_outputs() -> None:
    acting = Acting(spaces.Box(-2, 6, (5,), np.int8))
    (row,) = acting.rows(np.array([[-0.95, -0.55, 0.2, 0.65, 0.9]], np.float32))
    np.testing.assert_allclose(row, [-1.8, -0.2, 2.8, 4.6, 5.6], rtol=1e-6)
    built = acting.build(row)
    assert built.dtype == np.int8
    assert built.tolist() == [-2, 0, 3, 5, 6]


def test_a_single_choice_counts_from_its_start() -> None:
    acting = Acting(spaces.Discrete(3, start=5))
    assert acting.kind == Discrete(3)
    assert [acting.build(row) for row in acting.rows(np.array([0, 2], np.int32))] == [5, 7]


@pytest.mark.parametrize(
    ("space", "says"),
    [
        (spaces.Dict({"a": spaces.Sequence(spaces.Discrete(2))}), r"space\['a'\] is a Sequence"),
        (spaces.Graph(spaces.Discrete(2), None), "space is a Graph"),
        (spaces.Text(3), "space is a Text"),
    ],
)
def test_what_has_no_fixed_length_is_refused(space: Any, says: str) -> None:
    for kind in (Observation, Acting):
        with pytest.raises(ValueError, match=says):
            kind(space)


@pytest.mark.parametrize(
    ("low", "high", "scaled", "senses", "action"),
    [
        (-1e6, 1e6, False, [-3, 5], [-0.5, 20]),
        (-0.99e6, 0.99e6, True, [-3 / 0.99e6, 5 / 0.99e6], [-0.495e6, 0.99e6]),
        (-8.0, np.inf, False, [-3, 5], [-0.5, 20]),
        (-np.inf, 8.0, False, [-3, 5], [-0.5, 8]),
        (-8.0, 8.0, True, [-0.375, 0.625], [-4, 8]),
    ],
)
def test_a_bound_of_a_million_is_no_bound(
    low: float, high: float, scaled: bool, senses: list[float], action: list[float]
) -> None:
    """A sense or an output is scaled only if it has both bounds. Every output is cut at a bound."""
    box = spaces.Box(low, high, (2,), np.float64)
    observation, acting = Observation(box), Acting(box)
    found = observation.senses(np.ones(2), squash=False)(np.array([[-3.0, 5.0]]))
    np.testing.assert_allclose(found, [senses], rtol=1e-6)
    assert observation.unbounded().tolist() == [not scaled] * 2
    rows = acting.rows(np.array([[-0.5, 20.0]], np.float32))
    np.testing.assert_allclose(rows, [action])


def test_a_number_with_a_single_value_is_divided_by_its_scale() -> None:
    observation = Observation(spaces.Box(8.0, 8.0, (2,), np.float64))
    senses = observation.senses(np.array([4.0, 2.0]), squash=False)
    assert senses(np.array([[8.0, 8.0]])).tolist() == [[2.0, 4.0]]


def test_a_box_is_described_by_its_least_and_largest_number() -> None:
    low, high = np.float32([-1, -5]), np.float32([2, 3])
    assert described(spaces.Box(low, high)) == "Box (2,) of float32, from -5 to 3"
    assert described(spaces.Discrete(3)) == "Discrete(3)"


@pytest.mark.parametrize(
    ("space", "dtype"),
    [
        (spaces.Box(0, 255, (2,), np.uint8), "float32"),
        (spaces.Box(-1, 1, (2,), np.float32), "float32"),
        (spaces.MultiBinary(3), "float32"),
        (spaces.Box(-1, 1, (2,), np.float64), "float64"),
        (spaces.Box(0, 2**30, (2,), np.int32), "float64"),
        (spaces.Discrete(3), "float64"),
        (spaces.Tuple([spaces.Box(-1, 1, (2,), np.float32), spaces.Discrete(3)]), "float64"),
    ],
)
def test_a_row_is_float32_if_float32_holds_all_values(space: Any, dtype: str) -> None:
    assert Observation(space).dtype == dtype


def test_every_part_of_an_action_has_a_choice() -> None:
    one, three = spaces.Discrete(1), spaces.Discrete(3)
    for parts in ([one, three], [three, one], [spaces.MultiDiscrete([2, 1])]):
        with pytest.raises(ValueError, match="a part of its action space has a single choice"):
            Acting(spaces.Tuple(parts))
    with pytest.raises(ValueError, match="its action space has no choice"):
        Acting(spaces.Tuple([one, one]))


def test_numbers_in_rows_and_columns_keep_their_order() -> None:
    box = spaces.Box(-1, 1, (2, 3), np.float32)
    acting, numbers = Acting(box), np.linspace(-1, 1, 6, dtype=np.float32)
    assert acting.kind == Continuous(6)
    (row,) = acting.rows(numbers[None])
    assert acting.build(row).tolist() == numbers.reshape(2, 3).tolist()
    assert row_of(Observation(box), numbers.reshape(2, 3)).tolist() == numbers.tolist()


def test_choices_of_a_list_count_from_their_starts() -> None:
    space = spaces.MultiDiscrete([2, 3], start=[5, -1])
    observation, acting = Observation(space), Acting(space)
    assert row_of(observation, np.array([6, 1])).tolist() == [1, 2]
    assert acting.build(np.array([1.0, 2.0])).tolist() == [6, 1]
