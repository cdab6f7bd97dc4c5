"""Mates in several worlds: who they are, and that mutation begins with the genome of both parents."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law import events as log
from primordia.law.genesis import begin
from primordia.law.turnover import birth_keys, turnover
from primordia.law.world import BirthCause, Cause, World
from primordia.random.wide import wide
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
        (1.0, {"kind": "heritable"}),
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
    numbers = jnp.arange(W * N, dtype=jnp.float32) + 1
    organisms = world.organisms._replace(
        alive=jnp.asarray(alive.ravel()),
        number=wide(np.arange(W * N) + 1),
        genome={
            name: jnp.broadcast_to(numbers.reshape(-1, *[1] * (block.ndim - 1)), block.shape)
            for name, block in world.organisms.genome.items()
        },
        notes=jnp.broadcast_to(-numbers.astype(jnp.int32)[:, None], world.organisms.notes.shape),
    )
    world = world._replace(
        organisms=organisms, worlds=world.worlds._replace(births=wide([1000] * W))
    )
    after, lists, _ = turnover(
        law, world, log.empty(law), jnp.ones(W, bool), jnp.asarray(wants.ravel()),
        jnp.asarray(cause.ravel(), jnp.int32), birth_keys(law, world.worlds),
    )  # fmt: skip
    rows = np.asarray(lists.births.rows)[: int(lists.births.filled)]
    births = log.births_of(law.heredity).unpacked(rows)
    assert len(rows) == W
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
        weights = np.concatenate([np.ravel(b[cell]) for b in after.organisms.genome.values()])
        assert set(weights.tolist()) == ({parent, other} if mated else {parent})
        if law.heredity.mutation.notes:
            note = -(cell.astype(int) + 1) if "belongs" in mutation else -parent
            assert births["quarters"][w].view(np.int32) == after.organisms.notes[cell, 0] == note


def test_a_calibrated_mutation_is_measured_against_the_genome_of_both_parents() -> None:
    """A child with the mate's weights acts unlike its parent before it mutates, and keeps acting so.

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
    alive = jnp.asarray((np.arange(3 * worlds) % 3 != 1) & ~empty)
    organisms = organisms._replace(
        alive=alive, genome={"output": jnp.asarray(genome)}, moments=known
    )
    after, lists, newborn = jax.jit(turnover, static_argnums=0)(
        law, World(organisms, counts), log.empty(law), jnp.ones(worlds, bool),
        alive & (jnp.arange(3 * worlds) % 3 == 0), jnp.full(3 * worlds, -1, jnp.int32),
        birth_keys(law, counts),
    )  # fmt: skip
    assert newborn.tolist()[:-3] == [False, True, False] * (worlds - 1)
    assert after.organisms.moments is not None
    knows = np.asarray(after.organisms.moments.known)[np.asarray(newborn)]
    assert knows.tolist() == [[True, True]] * (worlds - 1) + [[False, False]]
    rows = np.asarray(lists.births.rows)[: int(lists.births.filled)]
    assert not log.births_of(law.heredity).unpacked(rows)["quarters"].any()
    children = np.asarray(after.organisms.genome["output"])[1:-3:3]
    mated = [abs(child - of_mate).max() < 0.1 for child in children]
    alone = [abs(child - of_parent).max() < 0.1 for child in children]
    assert [one != other for one, other in zip(mated, alone, strict=True)] == [True] * 7
    assert 0 < sum(mated) < 7
