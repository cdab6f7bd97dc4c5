"""Mates in several worlds: the mate is the living neighbour of a child that is not its parent."""

from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law import events as log
from primordia.law.genesis import begin
from primordia.law.turnover import birth_keys, turnover
from primordia.law.world import BirthCause, Cause
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
