"""Recorded births as inputs of heredity, and the genomes of organisms in a stored state."""

from collections.abc import Mapping

import numpy as np

from primordia.brains.layout import Layout
from primordia.errors import Trouble
from primordia.law.heredity import Birth, Heredity
from primordia.law.world import Climate
from primordia.mutations.contract import Draws
from primordia.random.keys import streams
from primordia.runs.arrays import read_count, world_ticks


def genome_in(
    state: Mapping[str, np.ndarray], layout: Layout, organism: int, world: int
) -> np.ndarray:
    """Return the genome of an organism that is alive in a state, float32 (P,)."""
    cell = place_in(state, organism, world)
    blocks = {name: state[f"world.organisms.genome.{name}"][[cell]] for name in layout.names}
    return layout.join(blocks)[0]


def place_in(state: Mapping[str, np.ndarray], organism: int, world: int) -> int:
    """Return the cell, on the axis of all worlds, of an organism that is alive in a state.

    Raises:
        Trouble: the organism is not in the state.
    """
    number = read_count(state, "world.organisms.number")
    cells = len(number) // len(world_ticks(state))
    here = np.arange(len(number)) // cells == world
    places = np.flatnonzero(here & state["world.organisms.alive"] & (number == organism))
    if len(places) != 1:
        raise Trouble(
            f"organism {organism} of world {world} is missing in the state of a tick at which it lived"
        )
    return int(places[0])


def recorded(heredity: Heredity, counts: tuple, marks: tuple, climate: Climate) -> Birth:
    """Return recorded births (K,) as inputs of heredity.

    Args:
        heredity: the heredity of the run.
        counts: seed of the world, birth number and tick of each birth, Wide.
        marks: cell within the world; whether the newborn is a founder.
        climate: values of the settings at each birth.
    """
    (seed, number, tick), (cell, founder) = counts, marks
    draws = Draws(streams(seed, tick, *heredity.purposes), cell)
    return Birth(seed, number, draws, founder, heredity.rates(climate))
