"""A mutation that is measured, of a genome with two parents; `test_strange.py` has it in whole runs."""

import jax
import numpy as np
import pytest

from primordia.law.world import World
from tests.law.turning import turned
from tests.worlds import MEADOW, begun, law_of


@pytest.mark.slow
def test_a_calibrated_mutation_is_measured_against_the_recombined_genome() -> None:
    """A child with weights of its mate acts unlike its parent. This difference is no effect of mutation.

    Mutations are much smaller than the weights. So the largest of them, q = 0, changes no choice.
    Children know the moments of their parents. The last world is empty, and all moments of
    its founder are zero.
    """
    worlds = 8
    law = law_of(
        MEADOW, cells=3, seeds=worlds, brain={"kind": "linear"}, placement={"rule": "empty-only"},
        recombination={"unit": "block"},
        mutation={"kind": "calibrated", "probability": 1.0, "differs": 0.0, "remembered": 2},
    )  # fmt: skip
    organisms, counts = begun(law, np.arange(worlds, dtype=np.uint64), tick=9)
    of_parent, of_mate = np.float32([[1, 0], [1, 0]]), np.float32([[0, 1], [0, 1]])
    genome = np.tile([of_parent, np.zeros((2, 2), np.float32), of_mate], (worlds, 1, 1))
    known = jax.tree.map(np.ones_like, organisms.moments)
    empty = np.arange(3 * worlds) >= 3 * (worlds - 1)
    alive = (np.arange(3 * worlds) % 3 != 1) & ~empty
    organisms = organisms._replace(alive=alive, genome={"output": genome}, moments=known)
    wants = alive & (np.arange(3 * worlds) % 3 == 0)
    after, _, newborn, births, _ = turned(
        law, World(organisms, counts), wants, np.full(3 * worlds, -1)
    )
    assert newborn.tolist()[:-3] == [False, True, False] * (worlds - 1)
    assert after.moments is not None
    for moments in after.moments:
        of_newborn = np.asarray(moments)[newborn]
        assert (of_newborn[:-1] == 1).all()
        assert not of_newborn[-1].any(), "the founder has nothing of an organism of another world"
    assert not births["quarters"].any()
    children = np.asarray(after.genome["output"])[1:-3:3]
    mated = [abs(child - of_mate).max() < 0.1 for child in children]
    alone = [abs(child - of_parent).max() < 0.1 for child in children]
    assert [one != other for one, other in zip(mated, alone, strict=True)] == [True] * (worlds - 1)
    assert 0 < sum(mated) < worlds - 1
