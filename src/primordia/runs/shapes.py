"""The arrays that a checkpoint must hold, known from a run's settings and description alone."""

from collections.abc import Iterator, Mapping

import numpy as np

from primordia.config import Config
from primordia.law.seasons import ratchets
from primordia.law.world import BirthCause, Cause
from primordia.runs.arrays import NEVER, read_count
from primordia.runs.description import Description
from primordia.runs.schema import TABLES, Schema

Kind = tuple[str, tuple[int | None, ...]]
"""Type and shape of an array; None is a length that nothing tells."""

COUNTS = (
    *("seed", "tick", "births", "extinctions", "organism_ticks", "food"),
    *("saturated", "saturated_births", "fixed", "fixed_births"),
)
"""Numbers of 64 bits of each world."""


def expected(config: Config, about: Description) -> dict[str, Kind]:
    """Return the arrays of every state of a run, by name, without those of bodies."""
    return dict((*_of_worlds(config, about), *_of_organisms(config, about)))


def fault(arrays: Mapping[str, np.ndarray], config: Config, about: Description) -> str | None:
    """Return which array is missing or does not fit the run's settings; None if all fit."""
    cells = config.seeds * config.cells
    schema = Schema.described(config.cells, about)
    tails = {f"tail.{table}": ("uint32", (None, schema.columns(table).width)) for table in TABLES}
    for name, kind in {**expected(config, about), **tails}.items():
        if name not in arrays:
            return f"there is no array {name}"
        if not _fits(arrays[name], kind):
            return _misfit(name, arrays[name])
    for name in arrays:
        bodily = name.startswith("bodies")
        if bodily and arrays[name].shape[:1] != (cells,):
            return _misfit(name, arrays[name])
    tally = arrays.get("bodies.tally")
    if tally is not None and not _fits(tally, ("int32", (cells, len(about.tallies)))):
        return _misfit("bodies.tally", tally)
    return _odd_count(arrays) or _odd_row(arrays, config, schema)


def _odd_count(arrays: Mapping[str, np.ndarray]) -> str | None:
    """Return which number of a world no run can reach."""
    for name in set(COUNTS) - {"seed", "food"}:
        count = read_count(arrays, f"world.worlds.{name}")
        if ((count >= 2**63) & (count != NEVER)).any():
            return f"world.worlds.{name} is too large"
    return None


def _odd_row(arrays: Mapping[str, np.ndarray], config: Config, schema: Schema) -> str | None:
    """Return which open tail names a world, a cell or a cause that does not exist."""
    cells = config.seeds * config.cells
    most = {
        "births": {"cell": cells, "cause": len(BirthCause)},
        "deaths": {"cell": cells, "cause": len(Cause)},
        "metrics": {"world": config.seeds},
    }
    for table, limits in most.items():
        words = schema.columns(table).unpacked(arrays[f"tail.{table}"])
        for name, limit in limits.items():
            if (words[name] >= limit).any():
                return f"tail.{table} has a {name} that does not exist"
    return None


def _misfit(name: str, array: np.ndarray) -> str:
    return f"{name} is {array.dtype} {array.shape}, which does not fit the settings"


def _fits(array: np.ndarray, kind: Kind) -> bool:
    dtype, shape = kind
    same = (want in (None, has) for want, has in zip(shape, array.shape, strict=False))
    return array.dtype == dtype and array.ndim == len(shape) and all(same)


def _count(name: str, *shape: int) -> Iterator[tuple[str, Kind]]:
    """Yield both words of numbers of 64 bits."""
    for half in ("hi", "lo"):
        yield f"{name}.{half}", ("uint32", shape)


def _of_worlds(config: Config, about: Description) -> Iterator[tuple[str, Kind]]:
    worlds, looks = config.seeds, (config.seeds, len(ratchets(config.seasons)))
    for name in COUNTS:
        yield from _count(f"world.worlds.{name}", worlds)
    yield from _count("world.worlds.deaths", worlds, len(Cause))
    for name in ("calm", "sample_wait"):
        yield f"world.worlds.{name}", ("int32", (worlds,))
    for name in about.beginning:
        yield f"world.worlds.climate.{name}", ("float32", (worlds,))
    yield "world.worlds.looks.wait", ("int32", looks)
    for name in ("food", "organism_ticks"):
        yield from _count(f"world.worlds.looks.{name}", *looks)


def _of_organisms(config: Config, about: Description) -> Iterator[tuple[str, Kind]]:
    cells = config.seeds * config.cells
    yield "world.organisms.alive", ("bool", (cells,))
    for name, shape in about.blocks.items():
        yield f"world.organisms.genome.{name}", ("float32", (cells, *shape))
    yield "world.organisms.notes", ("int32", (cells, len(about.notes)))
    yield "world.organisms.memory", ("float32", (cells, None))
    for name in ("energy", "eaten"):
        yield f"world.organisms.{name}", ("int32", (cells,))
    for name in ("born", "number", "branch"):
        yield from _count(f"world.organisms.{name}", cells)
