"""One tick of deaths and births in invented worlds, six of which have another kind of change in each.

In two crowded worlds, the draws of a child depend on its cell, round and world.
"""

from functools import partial
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law import events as log
from primordia.law.law import Law
from primordia.law.metabolism import ONE
from primordia.law.turnover import _birth, _birth_rows
from primordia.law.world import BirthCause, Cause, World
from primordia.random.keys import Purpose
from primordia.random.wide import to_host, wide
from tests.chronicle import reach
from tests.law.test_placement import one_after_another
from tests.law.turning import N, Turned, W, crowd_law, drawn, numbered, turned
from tests.worlds import MEADOW, begun, law_of

DYING, FIRST, STOPPED, LOSING, QUIET, BEARING = range(6)
TICK = 50
NEVER = 2**64 - 1
ALIVE = np.zeros((W, N), bool)
ALIVE[[DYING, LOSING, QUIET], :4], ALIVE[BEARING, 2] = True, True
NUMBER = np.arange(W * N) + 100
CAUSES = np.full((W, N), -1)
CAUSES[DYING, :4] = Cause.STARVED, Cause.FATAL, Cause.STARVED, Cause.HAZARD
CAUSES[LOSING, 1] = Cause.HAZARD
BRANCH = np.zeros((W, N), int)
BRANCH[DYING], BRANCH[LOSING, :4], BRANCH[QUIET] = 3, [9, 4, 9, 9], 7
BEGUN = {
    "births": [1000 + world for world in range(W)],
    "extinctions": [2] * W,
    "organism_ticks": [2**32 if world == DYING else 77 * (world != FIRST) for world in range(W)],
    "fixed": [20, NEVER, NEVER, NEVER, 30, NEVER],
    "fixed_births": [900, NEVER, NEVER, NEVER, 901, NEVER],
}
STORES = [float(10 + world) for world in range(W)]


def posed() -> tuple[Law, World]:
    law = crowd_law()
    world = begun(law, np.arange(W, dtype=np.uint64), tick=TICK)
    worlds = world.worlds._replace(
        **{name: wide(values) for name, values in BEGUN.items()},
        calm=np.full(W, 8, np.int32),
        deaths=wide(np.full((W, len(Cause)), 5)),
        climate=world.worlds.climate | {"metabolism.store": np.float32(STORES)},
    )
    organisms = world.organisms._replace(
        alive=ALIVE.ravel(),
        number=wide(NUMBER),
        branch=wide(BRANCH.ravel()),
        born=wide(np.full(W * N, 40)),
        energy=np.arange(W * N, dtype=np.int32) * ONE,
        eaten=np.arange(W * N, dtype=np.int32) + 500,
        memory=np.ones(world.organisms.memory.shape, np.float32),
    )
    return law, World(organisms, worlds)


@pytest.fixture(scope="module")
def after() -> dict[str, Any]:
    """Return the worlds after the tick, and the lists; one organism copies itself."""
    law, world = posed()
    wants = np.zeros((W, N), bool)
    wants[BEARING, 2] = True
    organisms, worlds, newborn, births, deaths = turned(law, world, wants, CAUSES, stopped=STOPPED)
    cells = {"alive": organisms.alive, "energy": organisms.energy, "eaten": organisms.eaten,
             "newborn": newborn, "memory": np.asarray(organisms.memory).sum(axis=1)}  # fmt: skip
    wides = {name: to_host(getattr(organisms, name)) for name in ("number", "branch", "born")}
    by_world = {name: np.asarray(v).reshape(W, N) for name, v in (cells | wides).items()}
    return {**by_world, "worlds": worlds, "births": births, "deaths": deaths}


def founded_cell(world: int) -> int:
    """Return the cell of the founder, which the first word for seed, tick and genesis gives."""
    return int(drawn(world, Purpose.GENESIS, TICK, 0).hi) * N >> 32


def child_cell(after: dict[str, Any]) -> int:
    (cell,) = np.flatnonzero(after["newborn"][BEARING])
    return int(cell)


def test_the_dead_are_listed_with_their_energy_and_food(after: dict[str, Any]) -> None:
    cells = [0, 1, 2, 3, LOSING * N + 1]
    assert after["deaths"]["cell"].tolist() == cells
    assert after["deaths"]["id"].tolist() == [100 + cell for cell in cells]
    assert after["deaths"]["tick"].tolist() == [TICK] * 5
    assert after["deaths"]["cause"].tolist() == CAUSES.ravel()[cells].tolist()
    assert after["deaths"]["energy"].tolist() == [cell * ONE for cell in cells]
    assert after["deaths"]["food"].tolist() == [cell + 500 for cell in cells]


def test_founders_and_children_are_listed_in_the_order_of_cells(after: dict[str, Any]) -> None:
    born, none = after["births"], -1  # 2^64 - 1 as int64
    child = child_cell(after)
    assert child != 2
    cells = [founded_cell(DYING), N + founded_cell(FIRST), BEARING * N + child]
    assert born["cell"].tolist() == cells
    assert born["id"].tolist() == [1000 + DYING, 1000 + FIRST, 1000 + BEARING]
    assert born["parent"].tolist() == [none, none, 100 + BEARING * N + 2]
    assert born["tick"].tolist() == [TICK] * 3
    assert born["cause"].tolist() == [BirthCause.FOUNDER, BirthCause.FOUNDER, BirthCause.COPY]


def test_the_living_are_survivors_and_newborn(after: dict[str, Any]) -> None:
    """A world that has stopped stays empty."""
    alive = ALIVE & (CAUSES < 0)
    newborn = np.zeros((W, N), bool)
    for world, cell in enumerate((founded_cell(DYING), founded_cell(FIRST))):
        newborn[world, cell] = True
    newborn[BEARING, child_cell(after)] = True
    np.testing.assert_array_equal(after["newborn"], newborn)
    np.testing.assert_array_equal(after["alive"], alive | newborn)
    of = np.nonzero(newborn)
    assert after["energy"][of].tolist() == [STORES[world] * ONE for world in of[0]]
    assert after["number"][of].tolist() == [1000 + world for world in of[0]]
    assert after["born"][of].tolist() == [TICK] * 3
    assert after["branch"][of].tolist() == [0, 0, 1001 + BEARING]
    assert not after["eaten"][of].any()
    assert not after["memory"][of].any()
    numbers = NUMBER.reshape(W, N)
    assert after["number"][alive].tolist() == numbers[alive].tolist()
    assert after["branch"][alive].tolist() == BRANCH[alive].tolist()
    assert after["energy"][alive].tolist() == ((numbers[alive] - 100) * ONE).tolist()
    assert after["eaten"][alive].tolist() == (numbers[alive] + 400).tolist()
    assert set(after["born"][alive]) == {40}
    assert after["memory"][alive].all()


def test_births_deaths_and_extinctions_are_counted_in_their_worlds(after: dict[str, Any]) -> None:
    """A world's first founder follows no extinction. Each death or birth sets the calm ticks to 0."""
    worlds = after["worlds"]
    assert to_host(worlds.births).tolist() == [1001, 1002, 1002, 1003, 1004, 1006]
    assert to_host(worlds.extinctions).tolist() == [3, 2, 2, 2, 2, 2]
    deaths = np.full((W, len(Cause)), 5)
    for world in range(W):
        for cause in CAUSES[world][CAUSES[world] >= 0]:
            deaths[world, cause] += 1
    assert to_host(worlds.deaths).tolist() == deaths.tolist()
    assert worlds.calm.tolist() == [0, 0, 8, 0, 8, 0]


def test_fixation_is_noted_once_and_forgotten_in_an_extinction(after: dict[str, Any]) -> None:
    """The death of the last of branch 4 leaves one branch; a founder with one child is no fixation."""
    worlds = after["worlds"]
    assert to_host(worlds.fixed).tolist() == [NEVER, NEVER, NEVER, TICK, 30, NEVER]
    assert to_host(worlds.fixed_births).tolist() == [NEVER, NEVER, NEVER, 1003, 901, NEVER]


def test_without_heredity_a_child_is_a_founder_that_has_a_parent() -> None:
    """A child is born in cell 1, and the founder of the other world in cell 5."""
    law, cells = law_of(MEADOW, cells=3, seeds=2, inheritance="founder"), np.array([1, 5])
    organisms, worlds = begun(law, np.array([3, 4], np.uint64), tick=9)
    world = World(organisms._replace(number=wide(np.arange(6) + 20)), worlds)
    births: Any = SimpleNamespace(
        founded=jnp.arange(6) == 5, number=wide(np.arange(6) + 50), parent=jnp.array([2] * 6)
    )
    keys: Any = SimpleNamespace(take=lambda _: None)
    newborn: Any = SimpleNamespace(mutated=np.zeros(2, bool), notes=np.zeros((2, 0)))

    @jax.jit
    def recorded(cells: jax.Array) -> tuple[jax.Array, jax.Array]:
        founder = _birth(law, worlds, births, keys, cells).founder
        return founder, _birth_rows(law, world, births, cells, None, founder, newborn)

    founder, rows = recorded(cells)
    assert founder.tolist() == [True, True]
    found = log.births_of(law).unpacked(np.asarray(rows))
    assert found["cause"].tolist() == [BirthCause.FOUNDER] * 2
    assert found["parent"].tolist() == [22, -1]
    assert found["id"].tolist() == [51, 55]


PARENT = [1, 0, 1, -1, 1, 2]
OTHER = [3, 2, 3, -1, 3, 4]
"""The other organism of each world. The fourth world has none at all. In the third world it dies in the
tick, and the last world has no child."""


def test_a_mate_is_an_organism_of_the_childs_world_that_survives_the_tick() -> None:
    """All weights of an organism are its number, so a child's weights show which parent each is from.

    A note is the number modulo 16. A note that belongs to a cell is that of the cell's last organism.
    """
    law = crowd_law()
    world = begun(law, np.arange(W, dtype=np.uint64), tick=9)
    alive, wants, cause = np.zeros((W, N), bool), np.zeros((W, N), bool), np.full((W, N), -1)
    for w in (0, 1, 2, 4, 5):
        alive[w, [PARENT[w], OTHER[w]]], wants[w, PARENT[w]] = True, w < 5
    cause[2, 3] = Cause.HAZARD
    numbers = np.arange(W * N, dtype=np.int32) + 1
    organisms = world.organisms._replace(
        alive=alive.ravel(),
        number=wide(numbers),
        genome=numbered(world.organisms.genome, numbers),
        notes=numbers[:, None] % 16,
    )
    counted = world.worlds._replace(births=wide([1000] * W))
    organisms, _, _, births, _ = turned(law, World(organisms, counted), wants, cause)
    assert len(births["cell"]) == 5
    mixed = 0
    for w in range(5):
        cell = births["cell"][w]
        if PARENT[w] < 0:
            assert births["cause"][w] == BirthCause.FOUNDER
            assert births["mate"][w] == births["parent"][w] == -1
            continue
        assert cell // N == w
        parent, other = w * N + PARENT[w] + 1, w * N + OTHER[w] + 1
        mated = w != 2
        assert births["parent"][w] == parent
        assert births["mate"][w] == (other if mated else -1)
        weights = np.concatenate([np.ravel(np.asarray(b)[cell]) for b in organisms.genome.values()])
        assert set(weights.tolist()) <= ({parent, other} if mated else {parent})
        mixed += other in weights
        note = (cell.astype(int) + 1) % 16
        assert births["quarters"][w].view(np.int32) == np.asarray(organisms.notes)[cell, 0] == note
    assert mixed > 0


LATE, BORN_BEFORE = 2**33 + 30, 2**32
"""The tick, and the number of births before it."""
SEEDS = [4, 2**40, 1, 2, 3, 5]
EMPTY = [[7, 100, 101, 120], [0, 3, 9]]
COPYING = [[5, 6, 110], [50, 90]]
"""Cells of the organisms that copy themselves. There are five children, which are written in batches
of three, so the last batch has two. Other worlds are quiet."""
BRANCH_OF = [(1 + 2 * world) * 2**32 for world in range(W)]
"""In each world all organisms are of one branch, whose low word is 0."""


def word(purpose: Purpose, world: int, cell: int, index: int = 0) -> int:
    """Return the high word of a draw of a cell."""
    return int(drawn(SEEDS[world], purpose, LATE, cell, index).hi)


def crowded() -> tuple[Law, World]:
    """Return worlds in which each weight of an organism is its number. All children of world 1 mutate."""
    law = crowd_law()
    organisms, worlds = begun(law, np.array(SEEDS, np.uint64), LATE, BORN_BEFORE)
    alive = np.ones((W, N), bool)
    for world, cells in enumerate(EMPTY):
        alive[world, cells] = False
    numbers = np.arange(W * N)
    organisms = organisms._replace(
        alive=alive.ravel(),
        number=wide(numbers),
        branch=wide(np.repeat(BRANCH_OF, N)),
        genome=numbered(organisms.genome, numbers),
    )
    chances = {
        name: np.float32(np.arange(W) == 1)
        for name in worlds.climate
        if name.startswith("mutation.") and name.endswith(".probability")
    }
    return law, World(organisms, worlds._replace(climate=worlds.climate | chances))


@pytest.fixture(scope="module")
def crowd() -> Turned:
    """Return the worlds after the tick."""
    law, world = crowded()
    wants = np.zeros((W, N), bool)
    for each, cells in enumerate(COPYING):
        wants[each, cells] = True
    return turned(law, world, wants, np.full((W, N), -1))


def parents_of(world: int) -> dict[int, int]:
    """Return cell of child -> cell of parent. Each round of placement has its own words."""
    pairs = [drawn(SEEDS[world], Purpose.PLACE, LATE, np.arange(N), round_) for round_ in range(6)]
    words = np.array(pairs, np.uint64)
    cells = np.arange(N)
    wants, occupied = np.isin(cells, COPYING[world]), ~np.isin(cells, EMPTY[world])
    near = partial(reach, "well-mixed", cells=N)
    parent = one_after_another(near, "empty-only", words, wants, occupied)
    return {cell: int(parent[cell]) for cell in np.flatnonzero(parent >= 0).tolist()}


def test_children_are_placed_by_the_words_of_each_round(crowd: Turned) -> None:
    expected = [
        (world * N + cell, world * N + parent)
        for world in range(2)
        for cell, parent in parents_of(world).items()
    ]
    assert len(expected) == 5
    found = zip(crowd.births["cell"], crowd.births["parent"], strict=True)
    assert list(found) == expected


def mate_of(world: int, cell: int, parent: int) -> int:
    """Return the cell of the mate of a child's parent."""
    living = [c for c in range(N) if c not in EMPTY[world] and c != parent]
    return living[word(Purpose.MATE, world, cell) * len(living) >> 32]


def test_mates_and_their_weights_are_drawn_for_each_child(crowd: Turned) -> None:
    """Row r of each block is the mate's if the highest bit of the child's word r is set."""
    mates, mixed = set(), 0
    columns = (crowd.births[name] for name in ("cell", "parent", "mate"))
    genome = [np.asarray(block) for block in crowd.organisms.genome.values()]
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


def test_children_mutate_with_the_chances_of_their_world(crowd: Turned) -> None:
    cells = crowd.births["cell"]
    causes = [BirthCause.MUTANT if cell >= N else BirthCause.COPY for cell in cells]
    assert crowd.births["cause"].tolist() == causes


def test_a_child_is_of_its_parents_branch_even_if_the_low_word_of_the_branch_is_0(
    crowd: Turned,
) -> None:
    """Only founders have branch 0. A branch is fixed once all organisms of a world belong to it."""
    branch, cells = to_host(crowd.organisms.branch), crowd.births["cell"]
    assert branch[cells].tolist() == [BRANCH_OF[cell // N] for cell in cells]
    assert to_host(crowd.worlds.fixed).tolist() == [LATE] * W
    born = to_host(crowd.worlds.fixed_births) - BORN_BEFORE
    assert born.tolist() == [3, 2, 0, 0, 0, 0], "those of the tick"


def test_organisms_that_are_not_born_keep_their_weights(crowd: Turned) -> None:
    """The padding of the last batch is no birth."""
    old = np.setdiff1d(np.arange(W * N), crowd.births["cell"])
    for block in crowd.organisms.genome.values():
        weights = np.asarray(block)[old].reshape(len(old), -1)
        assert (weights == old[:, None]).all()
