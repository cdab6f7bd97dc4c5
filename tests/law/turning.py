"""One tick of deaths and births in invented worlds, for tests of turnover."""

from functools import cache, partial
from typing import NamedTuple

import jax
import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.law import events as log
from primordia.law.law import Law
from primordia.law.tick import Fates
from primordia.law.turnover import birth_keys, turnover
from primordia.law.world import Organisms, World, Worlds
from primordia.random.keys import Purpose, encrypt
from primordia.random.wide import Wide
from tests.worlds import MEADOW, law_of

W, N = 6, 128


@cache
def crowd_law() -> Law:
    """Return the law of six well-mixed worlds, whose newborn are written in batches of three.

    Children have two parents, and a note that belongs to their cell. Their weights do not change.
    """
    return law_of(
        MEADOW, cells=N, seeds=W, brain={"hidden": 2}, metabolism={"store": 10.0},
        placement={"topology": "well-mixed", "rule": "empty-only"}, recombination={"unit": "row"},
        mutation={"kind": "heritable", "belongs": "cell", "probability": 0.0, "scale": 0.0},
    )  # fmt: skip


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
    running = np.arange(law.worlds) != (-1 if stopped is None else stopped)
    (organisms, worlds), lists, newborn = _turned(
        law, world, running, Fates(cause.ravel().astype(np.int32), wants.ravel(), None, np.True_)
    )
    births, deaths = (
        columns.unpacked(np.asarray(list_.rows)[: int(list_.filled)])
        for columns, list_ in ((log.births_of(law), lists.births), (log.DEATHS, lists.deaths))
    )
    return Turned(organisms, worlds, np.asarray(newborn), births, deaths)


@partial(jax.jit, static_argnums=0)
def _turned(law: Law, world: World, running: Array, fates: Fates) -> tuple:
    keys = birth_keys(law, world.worlds)
    return turnover(law, world, log.empty(law), running, fates, keys)


def drawn(seed: object, purpose: Purpose, tick: object, cell: object, index: object = 0) -> Wide:
    """Return the words of draws, computed by NumPy; all arguments but the purpose may be arrays."""
    with np.errstate(over="ignore"):  # NumPy warns of scalars that wrap, as they must
        key = encrypt(encrypt(_whole(seed), _whole(tick)), Wide(np.uint32(purpose), np.uint32(0)))
        return encrypt(key, Wide(np.asarray(cell, np.uint32), np.asarray(index, np.uint32)))


def _whole(values: object) -> Wide:
    whole = np.asarray(values, np.uint64)
    return Wide(np.uint32(whole >> np.uint64(32)), np.uint32(whole & np.uint64(2**32 - 1)))


def numbered(genome: Genome, numbers: np.ndarray) -> dict[str, np.ndarray]:
    """Return genomes in which each weight of an organism is the organism's number."""
    return {
        name: np.broadcast_to(np.float32(numbers).reshape(-1, *[1] * (block.ndim - 1)), block.shape)
        for name, block in genome.items()
    }
