"""Saved states as arrays, and the checks of a habitat's properties at their bounds."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.errors import InputError
from primordia.habitats import Compound, Continuous, Discrete, JaxHabitat
from primordia.habitats.checks import check_properties
from primordia.habitats.states import packed, unpacked


@given(st.lists(st.binary(max_size=9), min_size=1, max_size=6))
def test_states_of_all_lengths_are_stored_in_rows(states: list[bytes]) -> None:
    """Zeros at the end of a state are a part of it."""
    arrays = packed(states)
    assert unpacked(arrays) == states
    assert arrays["states"].shape == (len(states), max(map(len, states)))
    assert arrays["lengths"].tolist() == list(map(len, states))


class Stone(JaxHabitat):
    """A habitat of which only the properties are read."""

    def __init__(self, **properties: Any) -> None:
        own = {"senses_size": 1, "action": Discrete(2), "words": 0, **properties}
        for name, value in own.items():
            setattr(self, name, value)

    def reset(self, words: Any) -> Any:
        return words

    def sense(self, bodies: Any) -> Any:
        return bodies

    def step(self, bodies: Any, action: Any) -> Any:
        return bodies


BOUNDS: list[tuple[str, Any, Any]] = [
    ("senses_size", 1, 0),
    ("senses_size", 2**20, 2**20 + 1),
    ("senses_size", 1, True),
    ("words", 0, -1),
    ("words", 2**20, 2**20 + 1),
    ("words", 1, 1.0),
    ("rate", 1e-6, 0.9e-6),
    ("rate", 1e9, 1.1e9),
    ("rate", None, "fast"),
    ("rate", 30, float("nan")),
    ("action", Discrete(2), Discrete(1)),
    ("action", Continuous(1), Continuous(0)),
    ("action", Discrete(2**20), Discrete(2**20 + 1)),
    ("action", Compound((Discrete(2), Continuous(1))), Compound((Discrete(1), Continuous(1)))),
    ("action", Compound((Continuous(1),)), Compound(())),
    ("action", Compound((Discrete(2**20 - 1), Continuous(1))),
     Compound((Discrete(2**20 - 1), Continuous(2)))),
    ("versions", {"a": "1"}, {"a": 1}),
    ("versions", {}, {1: "a"}),
    ("tallies", (), ("score",)),
    ("tallies", (), ["score"]),
]  # fmt: skip
"""property, a value that is accepted, a value that is refused"""


@pytest.mark.parametrize(("name", "accepted", "refused"), BOUNDS)
def test_a_property_at_its_bound_is_accepted_and_one_beyond_it_is_not(
    name: str, accepted: Any, refused: Any
) -> None:
    check_properties(Stone(**{name: accepted}))
    said = "tallies" if name == "tallies" else f"{name}|the rate"
    with pytest.raises(InputError, match=said):
        check_properties(Stone(**{name: refused}))


def test_a_compound_action_has_a_column_for_a_choice_and_several_for_numbers() -> None:
    action = Compound((Discrete(4), Continuous(3), Discrete(2)))
    assert (action.size, action.columns) == (9, 5)
    assert Discrete(4).parts == (Discrete(4),)
    assert Continuous(3).parts == (Continuous(3),)
