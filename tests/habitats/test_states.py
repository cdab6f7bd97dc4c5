"""Saved states of all lengths as arrays."""

from hypothesis import given
from hypothesis import strategies as st

from primordia.habitats.states import packed, unpacked


@given(st.lists(st.binary(max_size=9), min_size=1, max_size=6))
def test_states_of_all_lengths_are_stored_in_rows(states: list[bytes]) -> None:
    """Zeros at the end of a state are kept."""
    arrays = packed(states)
    assert unpacked(arrays) == states
    assert arrays["states"].shape == (len(states), max(map(len, states)))
    assert arrays["lengths"].tolist() == list(map(len, states))
