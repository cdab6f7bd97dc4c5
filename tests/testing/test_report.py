"""What the checks of parts have in common: a comparison of bits, since digests are of bits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.testing.report import ContractError, same

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
