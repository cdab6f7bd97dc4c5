"""Organisms in a stored state: their cells and genomes."""

import numpy as np
import pytest

from primordia.brains.layout import Layout
from primordia.errors import Trouble
from primordia.history.births import genome_in, place_in

LAYOUT = Layout((("a", (2,)), ("b", (1, 3))))


@pytest.fixture
def state() -> dict[str, np.ndarray]:
    """Return two worlds of four cells. Numbers stay in the cells of the dead; one has a high word."""
    low = np.array([5, 6, 7, 7, 7, 6, 5, 9], np.uint32)
    high = np.array([0, 0, 1, 0, 0, 0, 0, 0], np.uint32)
    weights = np.arange(8 * 5, dtype=np.float32).reshape(8, 5)
    return {
        "world.worlds.tick.hi": np.zeros(2, np.uint32),
        "world.worlds.tick.lo": np.full(2, 30, np.uint32),
        "world.organisms.number.hi": high,
        "world.organisms.number.lo": low,
        "world.organisms.alive": np.array([1, 0, 1, 1, 0, 1, 1, 1], bool),
        "world.organisms.genome.a": weights[:, :2],
        "world.organisms.genome.b": weights[:, 2:].reshape(8, 1, 3),
    }


@pytest.mark.parametrize(
    ("organism", "world", "cell"),
    [(5, 0, 0), (7, 0, 3), (2**32 + 7, 0, 2), (6, 1, 5), (5, 1, 6), (9, 1, 7)],
)
def test_an_organism_is_found_among_the_living_of_its_world(
    state: dict[str, np.ndarray], organism: int, world: int, cell: int
) -> None:
    assert place_in(state, organism, world) == cell
    assert genome_in(state, LAYOUT, organism, world).tolist() == [*range(5 * cell, 5 * cell + 5)]


@pytest.mark.parametrize(("organism", "world"), [(6, 0), (7, 1), (9, 0)])
def test_an_organism_that_is_not_alive_in_a_state_is_missing(
    state: dict[str, np.ndarray], organism: int, world: int
) -> None:
    words = f"organism {organism} of world {world} is missing in the state"
    with pytest.raises(Trouble, match=words):
        place_in(state, organism, world)
