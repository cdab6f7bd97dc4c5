"""One tick of deaths and births in invented worlds, for tests of turnover."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from primordia.brains.contract import Genome
from primordia.law import events as log
from primordia.law.law import Law
from primordia.law.turnover import birth_keys, turnover
from primordia.law.world import Organisms, World, Worlds


class Turned(NamedTuple):
    """The worlds after a tick, and the columns of the lists of births and deaths."""

    organisms: Organisms
    worlds: Worlds
    newborn: np.ndarray
    births: dict[str, np.ndarray]
    deaths: dict[str, np.ndarray]


def turned(
    law: Law, world: World, wants: np.ndarray, cause: np.ndarray, stopped: int | None = None
) -> Turned:
    """Return the result of a tick in which some organisms want a child, and some die of a cause.

    Args:
        law: the law.
        world: the worlds; their tick is the one that ends.
        wants: bool, (W, N) or (C,).
        cause: causes of death, or -1; (W, N) or (C,).
        stopped: the number of a world that has stopped.
    """
    (organisms, worlds), lists, newborn = jax.jit(turnover, static_argnums=0)(
        law, world, log.empty(law), jnp.arange(law.worlds) != (-1 if stopped is None else stopped),
        jnp.asarray(wants.ravel()), jnp.asarray(cause.ravel(), jnp.int32),
        birth_keys(law, world.worlds),
    )  # fmt: skip
    births, deaths = (
        columns.unpacked(np.asarray(list_.rows)[: int(list_.filled)])
        for columns, list_ in (
            (log.births_of(law.heredity), lists.births),
            (log.DEATHS, lists.deaths),
        )
    )
    return Turned(organisms, worlds, np.asarray(newborn), births, deaths)


def numbered(genome: Genome, numbers: np.ndarray) -> Genome:
    """Return genomes in which each weight of an organism is the organism's number."""
    return {
        name: jnp.broadcast_to(
            jnp.asarray(numbers, jnp.float32).reshape(-1, *[1] * (block.ndim - 1)), block.shape
        )
        for name, block in genome.items()
    }
