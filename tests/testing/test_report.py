"""What the checks of parts have in common: a comparison of bits, since digests are of bits."""

import re
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.brains.linear import Linear
from primordia.errors import InputError
from primordia.testing.report import ContractError, advise, kept, last, need, same, typed

ALIKE = [0, 0x80000000, 0x7FC00000, 0x7FC00001, 0xFFC00000]
"""Words of 0, -0, and three NaNs: different bits that are equal as numbers."""
WORDS = st.lists(st.sampled_from(ALIKE) | st.integers(0, 2**32 - 1), min_size=6, max_size=6)


def floats(words: list[int]) -> np.ndarray:
    return np.array(words, np.uint32).view(np.float32).reshape(3, 2)


@given(WORDS, st.integers(0, 5), st.sampled_from(ALIKE))
def test_arrays_are_the_same_only_if_all_bits_are(words: list[int], place: int, word: int) -> None:
    changed = [*words[:place], word, *words[place + 1 :]]
    same("part", floats(words), floats(list(words)), "twice")
    if changed == words:
        return
    with pytest.raises(ContractError, match=f"different bits for organism {7 + place // 2} twice"):
        same("part", floats(words), floats(changed), "twice", 7)


def test_the_first_organism_that_differs_in_any_array_is_named() -> None:
    one = {"a": np.zeros((4, 2)), "b": (np.arange(4), np.ones((4, 1)))}
    other = {"a": np.array(one["a"]), "b": (np.array([0, 1, 2, 9]), np.ones((4, 1)))}
    with pytest.raises(ContractError, match=r"^int gives different bits for organism 3 at all$"):
        same(5, one, other, "at all")
    other["b"][1][1] = 7
    with pytest.raises(ContractError, match=r"^int gives different bits for organism 11 at all$"):
        same(5, one, other, "at all", 10)
    with pytest.raises(ValueError, match="shorter"):
        same(5, np.zeros(3), np.zeros(2), "at all")


@pytest.mark.parametrize(("count", "rows"), [(1, [3]), (2, [2, 3]), (4, [0, 1, 2, 3]), (0, [])])
def test_the_last_rows_of_a_tree(count: int, rows: list[int]) -> None:
    a, b = last((np.arange(4), [np.arange(4) * 10]), count)
    assert (a.tolist(), b[0].tolist()) == (rows, [row * 10 for row in rows])


def test_failures_are_errors_of_the_contract_that_name_the_part() -> None:
    with pytest.raises(ContractError, match=re.escape("a: b: c")), kept():
        raise InputError("habitat: a: b: c")
    with pytest.raises(ContractError, match=r"^Linear is wrong$"):
        need([], Linear(), "is wrong")
    need([0], Linear(), "is wrong")
    typed(Linear(), "x", np.zeros(2, np.int32), (2,), np.int32)
    with pytest.raises(ContractError, match=r"^Linear gives x as int32 \(2,\); the contract says"):
        typed(Linear(), "x", np.zeros(2, np.int32), (3,), np.int32)


class ByIdentity:
    """Parts that are equal only if they are one object."""


class ByValue(ByIdentity):
    """Parts that are equal and have the same hash."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ByValue)

    def __hash__(self) -> int:
        return 1


class Unhashed(ByIdentity):
    """Parts that can be compared but not hashed."""

    def __eq__(self, other: object) -> bool:
        return True

    __hash__ = None


@pytest.mark.parametrize("part", [ByIdentity(), Unhashed()])
def test_a_part_that_cannot_share_compiled_code_gives_a_warning(part: object) -> None:
    with pytest.warns(UserWarning, match=f"^{type(part).__name__} is not hashed by its values"):
        advise(part)


def test_a_part_that_shares_compiled_code_gives_no_warning() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        advise(ByValue())
        advise(Linear())
