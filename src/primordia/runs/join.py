"""The births and deaths of a run, checked and joined into lives."""

from collections.abc import Iterable

import numpy as np
import pyarrow as pa

from primordia.law.world import BirthCause, Cause, Named
from primordia.runs.lives import ALIVE, Lives, alive_at_fork, find_rows

BORN = {
    "world": np.int32,
    "id": np.int64,
    "parent": np.int64,
    "tick": np.int64,
    "cell": np.int32,
    "cause": np.int8,
}
"""Columns of births that lives need, with their types; a parent of -1 is none."""
DIED = "world", "id", "tick", "cause"
"""Columns of deaths that lives need."""


def join(
    births: Iterable[pa.Table],
    deaths: Iterable[pa.Table],
    count: int,
    ends: np.ndarray,
    begins: int,
    cells: int,
) -> Lives:
    """Join the births and deaths of a run; each segment is released once it is read.

    Args:
        births: segments with the columns BORN, in the order of events; the births of each world are
            in the order of their numbers.
        deaths: segments with the columns DIED.
        count: number of births in all segments.
        ends: last tick of each world so far, int64 (W,).
        begins: tick of the fork at whose end the records begin; 0 if the run is no fork.
        cells: number of cells of one world.

    Raises:
        ValueError: births and deaths contradict each other; the message says where.
    """
    born = _in_order(_born(births, count, ends, cells), worlds=len(ends))
    ended, cause = ends[born["world"]], np.full(count, ALIVE, np.int8)
    died = 0
    for dead in (_columns(segment, Cause) for segment in deaths):
        _check_worlds(dead, ends)
        rows = find_rows(born["world"], born["id"], dead["world"], dead["id"])
        _check_deaths(dead, rows, born["tick"], ended)
        ended[rows], cause[rows] = dead["tick"], dead["cause"]
        died += len(rows)
    if np.count_nonzero(cause != ALIVE) != died:
        raise ValueError("an organism dies twice")
    pa.default_memory_pool().release_unused()  # 100 MB after 5 million births
    return Lives(
        world=born["world"],
        id=born["id"],
        parent=born["parent"],
        cell=born["cell"],
        birth_cause=born["cause"],
        born=born["tick"],
        seen=np.maximum(born["tick"], begins) if begins else born["tick"],
        inherited=alive_at_fork(born["tick"], begins),
        ended=ended,
        cause=cause,
    )


def _born(
    births: Iterable[pa.Table], count: int, ends: np.ndarray, cells: int
) -> dict[str, np.ndarray]:
    """Return the columns of all births, in the order of the segments, each checked."""
    born = {name: np.empty(count, dtype) for name, dtype in BORN.items()}
    first = 0
    for segment in births:
        part = _columns(segment, BirthCause)
        _check_worlds(part, ends)
        _check_births(part, ends, cells)
        for name, column in part.items():
            born[name][first : first + len(column)] = column
        first += len(segment)
    return born


def _in_order(born: dict[str, np.ndarray], worlds: int) -> dict[str, np.ndarray]:
    """Return births sorted by world; raise ValueError unless those of a world are in order of birth."""
    if worlds > 1:  # NumPy sorts numbers of 16 bits in linear time
        order = np.argsort(born["world"].astype(np.uint16), kind="stable")
        born = {name: array[order] for name, array in born.items()}
    world, number = born["world"], born["id"]
    ascending = (number[1:] > number[:-1]) | (world[1:] > world[:-1])
    if not ascending.all():
        raise ValueError(f"organism {number[1:][~ascending][0]} is not recorded in order of birth")
    return born


def _check_worlds(events: dict[str, np.ndarray], ends: np.ndarray) -> None:
    if not ((events["world"] >= 0) & (events["world"] < len(ends))).all():
        raise ValueError("an organism lives in a world that does not exist")


def _check_births(born: dict[str, np.ndarray], ends: np.ndarray, cells: int) -> None:
    number = born["id"]
    faults = {
        "lives in a cell that does not exist": (born["cell"] < 0) | (born["cell"] >= cells),
        "has a birth number below 0": number < 0,
        "is born before the first tick, or after the last": (born["tick"] < 0)
        | (born["tick"] > ends[born["world"]]),
        "is not younger than its parent": born["parent"] >= number,
        "has no parent and is no founder": (born["parent"] < 0)
        & (born["cause"] != BirthCause.FOUNDER),
    }
    for fault, where in faults.items():
        if where.any():
            raise ValueError(f"organism {number[where.argmax()]} {fault}")


def _check_deaths(
    dead: dict[str, np.ndarray],
    rows: np.ndarray,
    born: np.ndarray,
    ended: np.ndarray,
) -> None:
    """Check deaths and the rows of the dead; `born` and `ended` have a value for every organism."""
    if len(rows) and rows.min() < 0:
        raise ValueError(f"organism {dead['id'][rows.argmin()]} dies without having been born")
    early = (dead["tick"] < born[rows]) | (dead["tick"] > ended[rows])
    if early.any():
        number = dead["id"][early.argmax()]
        raise ValueError(f"organism {number} dies before its birth, or after the last tick")


def _columns(segment: pa.Table, kind: type[Named]) -> dict[str, np.ndarray]:
    """Return the columns of births or deaths as arrays; -1 for no parent, causes by number of `kind`."""
    arrays = {
        name: segment[name].fill_null(-1).to_numpy()
        for name in segment.column_names
        if name != "cause"
    }
    causes = segment["cause"].combine_chunks()
    codes = {each.label: each for each in kind}
    words = causes.dictionary.to_pylist()
    if not set(words) <= set(codes):
        raise ValueError(f"{min(set(words) - set(codes), key=str)!r} is not a cause")
    code_of_word = np.array([codes[word] for word in words], np.int8)
    return {**arrays, "cause": code_of_word[causes.indices.to_numpy()]}
