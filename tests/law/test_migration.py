"""Children on islands of a well-mixed world, compared with a plain reference that acts one by one."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law.placement import Placement
from primordia.random.wide import Wide
from primordia.settings.islands import Islands
from tests.law.test_placement import ROUNDS, N, W, one_after_another, words

ISLANDS = Islands(("west", "middle", "east"), (0, 3, 8, N))
MIGRATION = np.repeat(np.float32([0.25, 0.0, 1.0]), ISLANDS.sizes)
"""No child of the middle leaves it, and every child of the east leaves."""


def placed(rule: str, wants: np.ndarray, occupied: np.ndarray, drawn: np.ndarray) -> np.ndarray:
    """Return parents (W, N); the last round of words decides who leaves."""
    placement = Placement(topology="well-mixed", rule=rule)

    def place(words: jax.Array, wants: jax.Array, occupied: jax.Array) -> jax.Array:
        migration = jnp.broadcast_to(MIGRATION, wants.shape)
        return placement.parents(
            lambda number: Wide(*words[jnp.minimum(number, ROUNDS - 1)]),
            wants,
            occupied,
            ISLANDS,
            migration,
        )

    return np.asarray(jax.jit(place)(drawn, wants, occupied))


def reach(cell: int, drawn: np.ndarray) -> list[int]:
    """Return the cells in which a child may be born; it leaves if its parent's word, one of `drawn`, is
    below the chance."""
    home = int(ISLANDS.of_cells(cell))
    leaves = int(drawn[cell]) < MIGRATION[cell] * 2**32
    there = ISLANDS.of_cells(np.arange(N)) == home
    return [each for each in range(N) if (there[each] != leaves) and each != cell]


@pytest.mark.parametrize("rule", ["blind", "empty-only"])
def test_placing_all_at_once_equals_placing_one_by_one(rule: str) -> None:
    rng, drawn = np.random.default_rng(3), words(4)
    occupied = rng.random((W, N)) < rng.random((W, 1))
    wants = occupied & (rng.random((W, N)) < 0.8)
    parents = placed(rule, wants, occupied, drawn)
    for world in range(W):
        near = partial(reach, drawn=drawn[-1, 0, world])
        rounds = drawn[:-1, :, world]
        alone = one_after_another(near, rule, rounds, wants[world], occupied[world])
        assert parents[world].tolist() == alone.tolist()
