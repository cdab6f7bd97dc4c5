"""One tick of births in occupied cells; `tests/engine/test_strange.py` has them in whole runs."""

from functools import partial

import numpy as np
import pytest

from primordia.random.keys import Purpose
from primordia.random.wide import wide
from tests.chronicle import reach
from tests.law.test_placement import one_after_another
from tests.law.turning import Turned, drawn, numbered, turned
from tests.worlds import MEADOW, begun, law_of

pytestmark = pytest.mark.slow
N, SEED, TICK = 12, 18, 30
CAUSES = np.array([-1, 1, -1, 0, -1, 2, -1, 5, -1, 4, -1, -1])
"""Causes of death, or -1. The last cell is empty. All other organisms without a cause want a child."""
ALIVE = np.arange(N) < N - 1
WANTS = ALIVE & (CAUSES < 0)


def words(purpose: Purpose) -> np.ndarray:
    """Return the high and low words of all cells, (2, N)."""
    return np.array(drawn(SEED, purpose, TICK, np.arange(N)), np.uint64)


@pytest.fixture(scope="module")
def tick() -> Turned:
    """Return the worlds after the tick. Before it, each weight of an organism is its cell's number."""
    law = law_of(
        MEADOW, cells=N, placement={"topology": "well-mixed", "rule": "replacing"},
        mutation={"probability": 0.0}, recombination={"unit": "row"}, brain={"kind": "linear"},
    )  # fmt: skip
    world = begun(law, np.array([SEED], np.uint64), tick=TICK)
    organisms = world.organisms._replace(
        alive=ALIVE,
        number=wide(np.arange(N) + 100),
        genome=numbered(world.organisms.genome, np.arange(N)),
    )
    world = world._replace(organisms=organisms, worlds=world.worlds._replace(births=wide([200])))
    return turned(law, world, WANTS, CAUSES)


def parents() -> np.ndarray:
    """Return the parent of the child that is born in each cell, or -1."""
    near = partial(reach, "well-mixed", cells=N)
    return one_after_another(near, "replacing", words(Purpose.PLACE)[None], WANTS, ALIVE)


def test_an_organism_that_is_replaced_is_a_parent_but_no_mate(tick: Turned) -> None:
    """Births are written in order of cells, so a parent may be overwritten before its child is made."""
    births, overwritten = tick.births, []
    parent = parents()
    survivors = np.flatnonzero(WANTS & (parent < 0)).tolist()
    high, genome = words(Purpose.MATE)[0], np.asarray(tick.organisms.genome["output"])
    for row, cell in enumerate(births["cell"].tolist()):
        mates = [c for c in survivors if c != parent[cell]]
        mate = mates[int(high[cell]) * len(mates) >> 32]
        assert births["mate"][row] == mate + 100
        weights = set(np.ravel(genome[cell]).tolist())
        assert weights <= {float(parent[cell]), float(mate)}
        if parent[cell] < cell and parent[parent[cell]] >= 0:
            overwritten.append(float(parent[cell]) in weights)
    assert any(overwritten)
