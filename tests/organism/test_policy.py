"""A brain as a function: its weights, and the number of its senses. `test_life.py` has its memory."""

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.law.law import Law
from primordia.organism.policy import Policy
from tests.worlds import MILL, law_of


@pytest.fixture(scope="module")
def law() -> Law:
    return law_of(MILL, brain={"hidden": 2})


@pytest.fixture
def policy(law: Law) -> Policy:
    """Return a brain with 2 neurons. The weights are 0, 1, 2, ... in the order of the genome."""
    return Policy(law, np.arange(law.heredity.layout.length, dtype=np.float32))


def test_weights_are_blocks_in_the_order_of_the_genome(law: Law, policy: Policy) -> None:
    blocks, first = law.heredity.layout.blocks, 0
    assert list(policy.weights) == [name for name, _ in blocks]
    for name, shape in blocks:
        size = int(np.prod(shape))
        np.testing.assert_array_equal(
            policy.weights[name], np.arange(first, first + size).reshape(shape)
        )
        first += size


@pytest.mark.parametrize("more", [-1, 1, 5])
def test_neither_fewer_nor_more_senses_are_accepted(more: int, law: Law, policy: Policy) -> None:
    says = f"^{law.senses + more} senses are given; the brain has {law.senses}$"
    with pytest.raises(InputError, match=says):
        policy(np.zeros(law.senses + more, np.float32))
