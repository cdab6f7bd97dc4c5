"""The inside of organisms: which worlds show it, what acts, and colours of numbers."""

from typing import Any

import jax
import numpy as np
import pytest

from primordia.habitats.contract import Compound, Continuous, Discrete
from primordia.organism import inside
from primordia.organism.inside import acting, is_shown, news_of, since_change, squashed, tints
from tests.worlds import config

SWAP = {"change": [{"kind": "reverse-actions", "at": [30, 60]}]}


@pytest.mark.parametrize(
    ("settings", "shown"),
    [
        ({}, False),
        ({"brain": {"kind": "gated"}}, False),
        ({"brain": {"kind": "plastic"}}, True),
        ({"brain": {"kind": "plastic", "efference": True}}, True),
        ({"brain": {"kind": "plastic", "bound": 0.0}}, False),
        ({"brain": {"kind": "feed-forward"}, "habitat": SWAP}, True),
    ],
)
def test_pictures_show_the_inside_of_those_that_learn_or_whose_world_changes(
    settings: dict[str, Any], shown: bool
) -> None:
    made = config(**settings)
    habitat = made.build_habitat()
    assert is_shown(made.build_law(habitat), habitat) is shown


def test_a_change_is_new_for_half_a_second() -> None:
    """CartPole has 50 ticks in a second. A body's changes follow from its birth, whatever its age."""
    habitat: Any = config(habitat=SWAP).build_habitat()
    newborn = habitat.reset(np.zeros((1, habitat.words), np.uint32))
    body = jax.tree.map(lambda leaf: np.asarray(leaf)[0], newborn)
    assert news_of(habitat) == 25
    found = {age: since_change(habitat, body, age) for age in (0, 29, 30, 40, 54, 55, 60, 61)}
    assert found == {0: None, 29: None, 30: 0, 40: 10, 54: 24, 55: None, 60: 0, 61: 1}
    assert since_change(config().build_habitat(), body, 30) is None


def test_the_largest_output_of_each_choice_acts_and_so_do_all_amounts() -> None:
    """An output beyond those of the action does not act."""
    action = Compound((Discrete(3), Continuous(2), Discrete(2)))
    output = np.array([1.0, 3.0, 2.0, -1.0, 0.0, 5.0, 5.0, 9.0])
    assert acting(action, output).tolist() == [False, True, False, True, True, True, False, False]


def test_bars_of_outputs_are_shorter_than_one_and_broken_outputs_have_none() -> None:
    found = squashed(np.array([0.0, 1.0, -1.0, 1e30, np.nan, np.inf]))
    np.testing.assert_allclose(found, [0, 0.5, -0.5, 1, 0, 0])


def test_numbers_are_pale_at_0_and_have_full_colours_at_1_and_beyond() -> None:
    middle, low, high = (np.asarray(each) for each in (inside.MIDDLE, inside.LOW, inside.HIGH))
    found = tints(np.array([[0.0, -1.0, 1.0], [np.nan, -7.0, 0.5]]))
    assert (found.dtype, found.shape) == (np.uint8, (2, 3, 3))
    np.testing.assert_array_equal(found[0], [middle, low, high])
    np.testing.assert_array_equal(found[1, :2], [middle, low])
    np.testing.assert_allclose(found[1, 2], (middle + high) / 2, atol=1)
