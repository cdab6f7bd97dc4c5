"""Births of one tick in two crowded worlds: the draws of a child depend on its cell, round and world.

The five births are written in batches of three, and the last batch is padded. Other worlds are quiet.
"""

import numpy as np
import pytest

from primordia.law.law import Law
from primordia.law.world import BirthCause, World
from primordia.random.keys import Purpose
from primordia.random.wide import to_host, wide
from tests.law.test_placement import one_after_another
from tests.law.turning import N, Turned, W, crowd_law, drawn, numbered, turned
from tests.worlds import begun

TICK, BORN = 2**33 + 30, 2**32
"""The tick, and the number of births before it."""
SEEDS = [4, 2**40, 1, 2, 3, 5]
EMPTY = [[7, 100, 101, 120], [0, 3, 9]]
PARENTS = [[5, 6, 110], [50, 90]]
"""Cells of the organisms that copy themselves. There are five children, so the last batch has two."""
BRANCHES = [(1 + 2 * world) * 2**32 for world in range(W)]
"""In each world all organisms are of one branch, whose low word is 0."""


def word(purpose: Purpose, world: int, cell: int, index: int = 0) -> int:
    """Return the high word of a draw of a cell."""
    return int(drawn(SEEDS[world], purpose, TICK, cell, index).hi)


def posed() -> tuple[Law, World]:
    """Return worlds in which each weight of an organism is its number. All children of world 1 mutate."""
    law = crowd_law()
    organisms, worlds = begun(law, np.array(SEEDS, np.uint64), TICK, BORN)
    alive = np.ones((W, N), bool)
    for world, cells in enumerate(EMPTY):
        alive[world, cells] = False
    numbers = np.arange(W * N)
    organisms = organisms._replace(
        alive=alive.ravel(),
        number=wide(numbers),
        branch=wide(np.repeat(BRANCHES, N)),
        genome=numbered(organisms.genome, numbers),
    )
    chances = {
        name: np.float32(np.arange(W) == 1)
        for name in worlds.climate
        if name.startswith("mutation.") and name.endswith(".probability")
    }
    return law, World(organisms, worlds._replace(climate=worlds.climate | chances))


@pytest.fixture(scope="module")
def after() -> Turned:
    """Return the worlds after the tick."""
    law, world = posed()
    wants = np.zeros((W, N), bool)
    for each, cells in enumerate(PARENTS):
        wants[each, cells] = True
    return turned(law, world, wants, np.full((W, N), -1))


def parents_of(world: int) -> dict[int, int]:
    """Return cell of child -> cell of parent. Each round of placement has its own words."""
    pairs = [drawn(SEEDS[world], Purpose.PLACE, TICK, np.arange(N), round_) for round_ in range(6)]
    words = np.array(pairs, np.uint64)
    cells = np.arange(N)
    wants, occupied = np.isin(cells, PARENTS[world]), ~np.isin(cells, EMPTY[world])
    parent = one_after_another("well-mixed", "empty-only", words, wants, occupied)
    return {cell: int(parent[cell]) for cell in np.flatnonzero(parent >= 0).tolist()}


def test_children_are_placed_by_the_words_of_each_round(after: Turned) -> None:
    expected = [
        (world * N + cell, world * N + parent)
        for world in range(2)
        for cell, parent in parents_of(world).items()
    ]
    assert len(expected) == 5
    found = zip(after.births["cell"], after.births["parent"], strict=True)
    assert list(found) == expected


def mate_of(world: int, cell: int, parent: int) -> int:
    """Return the cell of the mate of a child's parent."""
    living = [c for c in range(N) if c not in EMPTY[world] and c != parent]
    return living[word(Purpose.MATE, world, cell) * len(living) >> 32]


def test_mates_and_their_weights_are_drawn_for_each_child(after: Turned) -> None:
    """Row r of each block is the mate's if the highest bit of the child's word r is set."""
    mates, mixed = set(), 0
    columns = (after.births[name] for name in ("cell", "parent", "mate"))
    genome = [np.asarray(block) for block in after.organisms.genome.values()]
    for child, parent, mate in zip(*columns, strict=True):
        world, cell = divmod(int(child), N)
        assert mate == world * N + mate_of(world, cell, int(parent) % N)
        mates.add(int(mate) % N)
        for block in genome:
            rows = block[child].reshape(block.shape[1], -1)
            for row, weights in enumerate(rows):
                of_mate = word(Purpose.CROSS, world, cell, row) >> 31
                assert set(weights.tolist()) == {float(mate if of_mate else parent)}
                mixed += of_mate
    assert len(mates) == 5
    assert 0 < mixed < 5 * sum(block.shape[1] for block in genome)


def test_children_mutate_with_the_chances_of_their_world(after: Turned) -> None:
    cells = after.births["cell"]
    causes = [BirthCause.MUTANT if cell >= N else BirthCause.COPY for cell in cells]
    assert after.births["cause"].tolist() == causes


def test_a_child_is_of_its_parents_branch_even_if_the_low_word_of_the_branch_is_0(
    after: Turned,
) -> None:
    """Only founders have branch 0. A branch is fixed once all organisms of a world belong to it."""
    branch, cells = to_host(after.organisms.branch), after.births["cell"]
    assert branch[cells].tolist() == [BRANCHES[cell // N] for cell in cells]
    assert to_host(after.worlds.fixed).tolist() == [TICK] * W
    born = to_host(after.worlds.fixed_births) - BORN
    assert born.tolist() == [3, 2, 0, 0, 0, 0], "those of the tick"


def test_organisms_that_are_not_born_keep_their_weights(after: Turned) -> None:
    """The padding of the last batch is no birth."""
    old = np.setdiff1d(np.arange(W * N), after.births["cell"])
    for block in after.organisms.genome.values():
        weights = np.asarray(block)[old].reshape(len(old), -1)
        assert (weights == old[:, None]).all()
