"""The arrays that a checkpoint must hold, according to a run's settings and description."""

from functools import lru_cache
from math import prod

import numpy as np

from primordia.config import Config
from primordia.law.act import Acts
from primordia.law.seasons import ratchets
from primordia.law.world import BirthCause, Cause
from primordia.runs.arrays import NEVER, Arrays, read_count
from primordia.runs.description import Description
from primordia.runs.schema import TABLES, Schema
from primordia.settings.base import UNREACHED

Kind = tuple[str, tuple[int | None, ...]]
"""Type and shape of an array; None is an unknown length."""

Blocks = tuple[tuple[str, tuple[int, ...]], ...]

COUNTS = (
    *("seed", "tick", "births", "extinctions", "organism_ticks", "food"),
    *("saturated", "saturated_births", "fixed", "fixed_births"),
)
"""Names of the 64-bit values of each world."""
LEAST = {"world.worlds.sample_wait": 1, "world.worlds.looks.wait": 1, "world.worlds.calm": 0}
"""Least values of counts of ticks: from a smaller one, a world would count for ever."""
GENOME = "world.organisms.genome."
"""Prefix of the names of the arrays of weights."""
BODIES = "bodies"
"""Prefix of the names of a habitat's arrays, which have a row for each cell, of an island or of all."""


class Expected:
    """The arrays of every checkpoint of a run."""

    def __init__(self, config: Config, about: Description) -> None:
        self._schema = Schema.described(config.cells, about)
        self._worlds, self._cells = config.seeds, config.seeds * config.cells
        looks = len(ratchets(config.seasons))
        self._blocks = tuple(about.blocks.items())
        self._kinds = _kinds(self._schema, self._blocks, about.moments, config.seeds, looks)
        self._tally: Kind = "int32", (self._cells, len(about.tallies))
        self._islands = config.islands

    def fault(self, arrays: Arrays) -> str | None:
        """Return a fault: an array is missing, unknown or too small, or a count of a world is
        impossible. Return None if there is no fault.

        Only the counts of each world are read; `fault_of` checks every other array when it is read.
        """
        for name in self._kinds:
            if name not in arrays:
                return f"there is no array {name}"
        for block, shape in self._blocks:  # before a command makes room for such genomes
            if arrays.size(name := f"{GENOME}{block}") < self._cells * prod(shape) * 4:
                return f"{name} is too small for {self._cells} blocks of weights of shape {shape}"
        for name in arrays:
            if name not in self._kinds and not name.startswith(BODIES):
                return f"there is an unknown array {name}"
        for name in set(COUNTS) - {"seed", "food"}:
            count = read_count(arrays, f"world.worlds.{name}")
            most = 2**63 if name == "organism_ticks" else UNREACHED
            if ((count >= most) & (count != NEVER)).any():
                return f"world.worlds.{name} is too large"
        return None

    def fault_of(self, name: str, array: np.ndarray) -> str | None:
        """Return the fault of an array (type, shape, or a row); None if it fits the settings."""
        kind = self._tally if name == f"{BODIES}.tally" else self._kinds.get(name)
        if not (array.shape[:1] == (self._rows(name),) if kind is None else _fits(array, kind)):
            return f"{name} is {array.dtype} {array.shape}, which does not fit the settings"
        if (least := LEAST.get(name)) is not None and (array < least).any():
            return f"{name} is below {least}"
        folder, _, table = name.partition(".")
        return self._odd_row(table, array) if folder == "tail" else None

    def _rows(self, name: str) -> int:
        """Return the number of rows of a habitat's array."""
        return self._worlds * len(self._islands.with_rows(name))

    def _odd_row(self, table: str, tail: np.ndarray) -> str | None:
        """Return the fault of an open tail that names a missing world, cell or cause, or None."""
        most = {
            "births": {"cell": self._cells, "cause": len(BirthCause)},
            "deaths": {"cell": self._cells, "cause": len(Cause)},
            "metrics": {"world": self._worlds},
        }
        words = self._schema.columns(table).unpacked(tail)
        for name, limit in most[table].items():
            if (words[name] >= limit).any():
                return f"tail.{table} names a {name} that does not exist"
        return None


def _fits(array: np.ndarray, kind: Kind) -> bool:
    dtype, shape = kind
    same = (want in (None, has) for want, has in zip(shape, array.shape, strict=False))
    return array.dtype == dtype and array.ndim == len(shape) and all(same)


@lru_cache(maxsize=64)
def _kinds(
    schema: Schema, blocks: Blocks, moments: int, worlds: int, looks: int
) -> dict[str, Kind]:
    """Return the kind of each array except the habitat's, by name; runs of one arm share the
    result.

    Args:
        schema: the columns of the tables.
        blocks: name and shape of each block of weights in a genome.
        moments: number of moments that an organism remembers.
        worlds: number of worlds.
        looks: number of ratchets.
    """
    cells = worlds * schema.cells
    kinds: dict[str, Kind] = {
        "world.organisms.alive": ("bool", (cells,)),
        "world.organisms.notes": ("int32", (cells, len(schema.notes))),
        "world.organisms.memory": ("float32", (cells, None)),
        "world.organisms.energy": ("int32", (cells,)),
        "world.organisms.eaten": ("int32", (cells,)),
        "world.worlds.calm": ("int32", (worlds,)),
        "world.worlds.sample_wait": ("int32", (worlds,)),
        "world.worlds.looks.wait": ("int32", (worlds, looks)),
    }
    kinds |= {f"{GENOME}{name}": ("float32", (cells, *shape)) for name, shape in blocks}
    kinds |= {f"world.worlds.climate.{rate}": ("float32", (worlds,)) for rate in schema.rates}
    kinds |= {f"tail.{name}": ("uint32", (None, schema.columns(name).width)) for name in TABLES}
    for name, shape in _counts(schema, worlds, looks).items():
        kinds |= {f"world.{name}.hi": ("uint32", shape), f"world.{name}.lo": ("uint32", shape)}
    if moments:
        of_moments = "world.organisms.moments."
        kinds[f"{of_moments}senses"] = kinds[f"{of_moments}memory"] = (
            "float32",
            (cells, moments, None),
        )
        kinds[f"{of_moments}known"] = ("bool", (cells, moments))
    return kinds


def _counts(schema: Schema, worlds: int, looks: int) -> dict[str, tuple[int, ...]]:
    """Return the shape of each 64-bit value of worlds and organisms, by name."""
    return {
        **{f"worlds.{name}": (worlds,) for name in COUNTS},
        **{f"worlds.acts.{name}": (worlds,) for name in Acts._fields if schema.endowed},
        **{f"worlds.looks.{name}": (worlds, looks) for name in ("food", "organism_ticks")},
        "worlds.deaths": (worlds, len(Cause)),
        **{f"organisms.{n}": (worlds * schema.cells,) for n in ("born", "number", "branch")},
    }
