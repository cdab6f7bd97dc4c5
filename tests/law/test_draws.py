"""Births of one tick in two crowded worlds: each child has the draws of its own cell, round and world.

The worlds have so many cells that births are written two at a time, and the last batch is padded.
"""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law import events as log
from primordia.law.genesis import begin
from primordia.law.law import Law
from primordia.law.turnover import birth_keys, turnover
from primordia.law.world import BirthCause, World
from primordia.random.keys import Purpose, bits, stream
from primordia.random.wide import to_host, wide
from tests.law.test_placement import one_after_another
from tests.worlds import MEADOW, law_of

W, N, TICK = 2, 256, 30
SEEDS = [4, 2**40]
EMPTY = [[7, 100, 101, 200], [0, 3, 9]]
PARENTS = [[5, 6, 210], [50, 130]]
"""Cells of the organisms that copy themselves. There are five children, so the last batch has one."""
BRANCHES = [2**32, 3 * 2**32]
"""In each world all organisms are of one branch, whose low word is 0."""


def word(purpose: Purpose, world: int, cell: int, index: int = 0) -> int:
    key = stream(wide(SEEDS[world]), purpose, wide(TICK))
    return int(bits(key, jnp.uint32(cell), index).hi)


def posed() -> tuple[Law, World]:
    """Return worlds whose organisms have their number as each weight. All of world 1 are to mutate."""
    law = law_of(
        MEADOW, cells=N, seeds=W, brain={"kind": "linear", "biases": True}, metabolism={"store": 9.0},
        placement={"topology": "well-mixed", "rule": "empty-only"}, recombination={"unit": "row"},
        mutation={"scale": 0.0},
    )  # fmt: skip
    organisms, worlds = begin(law, np.array(SEEDS, np.uint64), tick=TICK)
    alive = np.ones((W, N), bool)
    for world, cells in enumerate(EMPTY):
        alive[world, cells] = False
    numbers = np.arange(W * N)
    genome = {
        name: jnp.broadcast_to(
            jnp.asarray(numbers, jnp.float32).reshape(-1, *[1] * (block.ndim - 1)), block.shape
        )
        for name, block in organisms.genome.items()
    }
    organisms = organisms._replace(
        alive=jnp.asarray(alive.ravel()),
        number=wide(numbers),
        branch=wide(np.repeat(BRANCHES, N)),
        genome=genome,
    )
    of_worlds = {
        name: jnp.array([0, 1], jnp.float32)
        for name in worlds.climate
        if name.startswith("mutation.") and name.endswith(".probability")
    }
    return law, World(organisms, worlds._replace(climate=worlds.climate | of_worlds))


@pytest.fixture(scope="module")
def born() -> tuple[Law, World, World, dict[str, np.ndarray]]:
    """Return the law, the worlds before and after the tick, and the births."""
    law, world = posed()
    wants = np.zeros((W, N), bool)
    for each, cells in enumerate(PARENTS):
        wants[each, cells] = True
    after, lists, _ = jax.jit(turnover, static_argnums=0)(
        law, world, log.empty(law), jnp.ones(W, bool), jnp.asarray(wants.ravel()),
        jnp.full(W * N, -1, jnp.int32), birth_keys(law, world.worlds),
    )  # fmt: skip
    rows = np.asarray(lists.births.rows)[: int(lists.births.filled)]
    return law, world, after, log.births_of(law.heredity).unpacked(rows)


def parents_of(world: int) -> dict[int, int]:
    """Return cell of child -> cell of parent, with words of their own in each round."""
    words = np.array(
        [
            [to_host(bits(stream(wide(SEEDS[world]), Purpose.PLACE, wide(TICK)), np.arange(N), round_))
             >> np.uint64(shift) & np.uint64(2**32 - 1) for shift in (32, 0)]
            for round_ in range(6)
        ]
    )  # fmt: skip
    cells = np.arange(N)
    wants, occupied = np.isin(cells, PARENTS[world]), ~np.isin(cells, EMPTY[world])
    parent = one_after_another("well-mixed", "empty-only", words, wants, occupied)
    return {cell: int(parent[cell]) for cell in np.flatnonzero(parent >= 0).tolist()}


def test_children_are_placed_by_the_words_of_each_round(born: Any) -> None:
    _, _, _, births = born
    expected = [
        (world * N + cell, world * N + parent)
        for world in range(W)
        for cell, parent in parents_of(world).items()
    ]
    assert len(expected) == 5
    assert list(zip(births["cell"], births["parent"], strict=True)) == expected


def mate_of(world: int, cell: int, parent: int) -> int:
    living = [c for c in range(N) if c not in EMPTY[world] and c != parent]
    return living[word(Purpose.MATE, world, cell) * len(living) >> 32]


def test_mates_and_their_weights_are_drawn_for_each_child(born: Any) -> None:
    """Row r of both blocks is the mate's if the highest bit of the child's word r is set."""
    law, _, after, births = born
    mates, mixed = set(), 0
    for child, parent, mate in zip(
        *(births[name] for name in ("cell", "parent", "mate")), strict=True
    ):
        world, cell = divmod(int(child), N)
        assert mate == world * N + mate_of(world, cell, int(parent) % N)
        mates.add(int(mate) % N)
        for block in after.organisms.genome.values():
            rows = np.asarray(block[child]).reshape(block.shape[1], -1)
            for row, weights in enumerate(rows):
                of_mate = word(Purpose.CROSS, world, cell, row) >> 31
                assert set(weights.tolist()) == {float(mate if of_mate else parent)}
                mixed += of_mate
    assert len(mates) == 5
    assert 0 < mixed < 5 * sum(shape[0] for _, shape in law.heredity.layout.blocks)


def test_children_mutate_with_the_chances_of_their_world(born: Any) -> None:
    births = born[3]
    causes = [BirthCause.MUTANT if cell >= N else BirthCause.COPY for cell in births["cell"]]
    assert births["cause"].tolist() == causes


def test_a_child_is_of_the_branch_of_its_parent_unless_that_is_a_founder(born: Any) -> None:
    """A branch whose low word is 0 is a branch. Its world has come to fixation."""
    _, _, after, births = born
    branch = to_host(after.organisms.branch)
    assert branch[births["cell"]].tolist() == [BRANCHES[cell // N] for cell in births["cell"]]
    assert to_host(after.worlds.fixed).tolist() == [TICK] * W
    assert to_host(after.worlds.fixed_births).tolist() == [3, 2], "births of the tick are counted"


def test_organisms_that_are_not_born_keep_their_weights(born: Any) -> None:
    """The padding of the last batch is no birth."""
    _, before, after, births = born
    old = np.setdiff1d(np.arange(W * N), births["cell"])
    for name, block in after.organisms.genome.items():
        np.testing.assert_array_equal(block[old], before.organisms.genome[name][old])
