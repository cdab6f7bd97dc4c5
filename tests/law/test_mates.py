"""Mates in several worlds: which organisms they are, and mutation of genomes with two parents."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law.genesis import begin
from primordia.law.world import BirthCause, Cause, World
from primordia.random.wide import wide
from tests.law.turning import numbered, turned
from tests.worlds import MEADOW, law_of

W, N = 5, 5
EMPTY = [2, 4, 2, -1, 0]
"""The empty cell of each ring; the fourth world has no organism at all."""
PARENT = [1, 0, 1, -1, 1]
OTHER = [3, 3, 3, -1, 4]
"""The other neighbour of the empty cell. In the third world it dies in the tick."""
NONE = -1


@pytest.mark.parametrize(
    ("probability", "mutation"),
    [
        (0.0, {"kind": "gaussian"}),
        (1.0, {"kind": "heritable", "belongs": "cell"}),
    ],
)
def test_a_mate_is_a_neighbour_in_the_childs_world_that_survives_the_tick(
    probability: float, mutation: dict[str, Any]
) -> None:
    """All weights of an organism are its number, so a child's weights show which parent each is from.

    A note is minus this number. A note that belongs to a cell is that of the cell's last organism.
    """
    values: dict[str, Any] = {
        "placement": {"rule": "empty-only"},
        "mutation": {**mutation, "probability": 0.0},
        "recombination": {"probability": probability},
    }
    law = law_of(MEADOW, cells=N, seeds=W, **values)
    world = begin(law, np.arange(W, dtype=np.uint64), tick=9)
    alive, wants, cause = np.ones((W, N), bool), np.zeros((W, N), bool), np.full((W, N), -1)
    alive[3] = False
    for w in (0, 1, 2, 4):
        alive[w, EMPTY[w]], wants[w, PARENT[w]] = False, True
    cause[2, 3] = Cause.HAZARD
    numbers = np.arange(W * N, dtype=np.int32) + 1
    organisms = world.organisms._replace(
        alive=jnp.asarray(alive.ravel()),
        number=wide(numbers),
        genome=numbered(world.organisms.genome, numbers),
        notes=jnp.broadcast_to(-numbers[:, None], world.organisms.notes.shape),
    )
    world = world._replace(
        organisms=organisms, worlds=world.worlds._replace(births=wide([1000] * W))
    )
    organisms, _, _, births, _ = turned(law, world, wants, cause)
    assert len(births["cell"]) == W
    for w in range(W):
        cell = births["cell"][w]
        if EMPTY[w] < 0:
            assert births["cause"][w] == BirthCause.FOUNDER
            assert births["mate"][w] == births["parent"][w] == NONE
            continue
        assert cell == w * N + EMPTY[w]
        parent, other = w * N + PARENT[w] + 1, w * N + OTHER[w] + 1
        mated = bool(probability) and w != 2
        assert births["parent"][w] == parent
        assert births["mate"][w] == (other if mated else NONE)
        weights = np.concatenate([np.ravel(b[cell]) for b in organisms.genome.values()])
        assert set(weights.tolist()) == ({parent, other} if mated else {parent})
        if law.heredity.mutation.notes:
            note = -(cell.astype(int) + 1) if "belongs" in mutation else -parent
            assert births["quarters"][w].view(np.int32) == organisms.notes[cell, 0] == note


def test_a_calibrated_mutation_is_measured_against_the_recombined_genome() -> None:
    """A child with weights of its mate acts unlike its parent. This difference is no effect of mutation.

    Mutations are much smaller than the weights. So the largest of them, q = 0, changes no choice.
    Children know the moments of their parents. The last world is empty, and its founder knows none.
    """
    worlds = 8
    law = law_of(
        MEADOW, cells=3, seeds=worlds, brain={"kind": "linear"}, placement={"rule": "empty-only"},
        recombination={"unit": "block"},
        mutation={"kind": "calibrated", "probability": 1.0, "differs": 0.0, "remembered": 2},
    )  # fmt: skip
    organisms, counts = begin(law, np.arange(worlds, dtype=np.uint64), tick=9)
    of_parent, of_mate = np.float32([[1, 0], [1, 0]]), np.float32([[0, 1], [0, 1]])
    genome = np.tile([of_parent, np.zeros((2, 2), np.float32), of_mate], (worlds, 1, 1))
    known = jax.tree.map(jnp.ones_like, organisms.moments)
    empty = np.arange(3 * worlds) >= 3 * (worlds - 1)
    alive = (np.arange(3 * worlds) % 3 != 1) & ~empty
    organisms = organisms._replace(
        alive=jnp.asarray(alive), genome={"output": jnp.asarray(genome)}, moments=known
    )
    wants = alive & (np.arange(3 * worlds) % 3 == 0)
    after, _, newborn, births, _ = turned(
        law, World(organisms, counts), wants, np.full(3 * worlds, -1)
    )
    assert newborn.tolist()[:-3] == [False, True, False] * (worlds - 1)
    assert after.moments is not None
    knows = np.asarray(after.moments.known)[newborn]
    assert knows.tolist() == [[True, True]] * (worlds - 1) + [[False, False]]
    assert not births["quarters"].any()
    children = np.asarray(after.genome["output"])[1:-3:3]
    mated = [abs(child - of_mate).max() < 0.1 for child in children]
    alone = [abs(child - of_parent).max() < 0.1 for child in children]
    assert [one != other for one, other in zip(mated, alone, strict=True)] == [True] * (worlds - 1)
    assert 0 < sum(mated) < worlds - 1
