"""Islands: parts of a world's cells, each with a habitat and rates of its own.

`[[habitat.islands]]` in a task lists them. An island's settings are those of the run, with the changes
that its own table states.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np
from pydantic import Field, TypeAdapter, ValidationError

from primordia.errors import InputError
from primordia.settings.base import Settings
from primordia.settings.fields import first_fault

Values = TypeVar("Values")

ARRAYS = "island."
"""Beginning of the names of an island's arrays of bodies in a state: `island.K` or `island.K.NAME`."""
KEY = "islands"
"""The setting of a habitat's table that lists islands; `tables.habitats_of_islands` reads it too."""
MIGRATION = "placement.migration"
"""The name of a rate that only worlds with islands have."""


class Island(Settings):
    """The table of one island: its share of the cells, and the settings in which it differs."""

    name: str = Field(pattern=r"^[a-z][a-z0-9-]*$", max_length=32, description="its name")
    share: float = Field(1.0, gt=0, le=1e6, description="cells, in proportion to other islands")
    habitat: dict[str, Any] = Field({}, description="settings of its habitat, also `factors`")
    hazard: float | None = Field(None, description="chance of an accident in a tick, as in a task")
    replication: float | dict[str, Any] | None = Field(
        None, description="chance of a copy in a tick, or a table, as in a task"
    )
    metabolism: dict[str, Any] = Field({}, description="rates of the metabolism")
    mutation: dict[str, Any] = Field({}, description="rates of the mutation")
    placement: dict[str, Any] = Field({}, description="`migration` of children born here")

    @property
    def rates(self) -> dict[str, Any]:
        """The tables and settings of a task in which the island differs, without the habitat."""
        own = self.model_dump(exclude={"name", "share", "habitat"})
        return {name: value for name, value in own.items() if value not in (None, {})}


_LIST: TypeAdapter[tuple[Island, ...]] = TypeAdapter(tuple[Island, ...])


def tables_of(habitat: Mapping[str, Any]) -> tuple[Island, ...]:
    """Return the islands that a habitat's table lists; () if it lists none.

    Raises:
        InputError: a setting is wrong, or two islands have the same name.
    """
    listed = habitat.get(KEY)
    if listed is None:
        return ()
    if not isinstance(listed, list | tuple) or not listed:
        raise InputError(
            "habitat.islands: write a list of islands, such as [[habitat.islands]] in TOML"
        )
    try:
        islands = _LIST.validate_python(tuple(listed))
    except ValidationError as error:
        raise InputError(first_fault(error, Island, "habitat.islands")) from None
    names = [each.name for each in islands]
    for number, name in enumerate(names):
        if name in (*names[:number], *Island.model_fields):
            what = "is the name of a setting" if name in Island.model_fields else "is used twice"
            raise InputError(f"habitat.islands.{number}.name: {name!r} {what}; choose another")
    return islands


@dataclass(frozen=True)
class Islands:
    """The islands of a world: successive stretches of its cells. A plain world is one island."""

    names: tuple[str, ...]
    """K names; ("",) in a plain world"""
    bounds: tuple[int, ...]
    """K + 1 cells: the first cell of each island, and the number of cells of the world"""

    @classmethod
    def of(cls, tables: tuple[Island, ...], cells: int, together: int = 1) -> "Islands":
        """Return the islands of a world of N cells.

        Args:
            tables: the islands' settings; () for a plain world.
            cells: N.
            together: cells that no border divides: the columns of a torus, otherwise 1.

        Raises:
            InputError: an island has no cell.
        """
        if not tables:
            return cls(("",), (0, cells))
        shares, units = np.cumsum([0.0, *(each.share for each in tables)]), cells // together
        bounds = np.round(shares / shares[-1] * units).astype(int) * together
        for number, size in enumerate(np.diff(bounds)):
            if size == 0:
                raise InputError(
                    f"habitat.islands.{number}.share: {tables[number].name!r} gets no cell of {cells};"
                    " choose more cells or a larger share"
                )
        return cls(tuple(each.name for each in tables), tuple(bounds.tolist()))

    @property
    def count(self) -> int:
        """K, the number of islands."""
        return len(self.names)

    @cached_property
    def sizes(self) -> tuple[int, ...]:
        """Cells of each island, (K,)."""
        return tuple(np.diff(self.bounds).tolist())

    @property
    def cells(self) -> list[range]:
        """Cells of each island, [K]."""
        return [range(*pair) for pair in pairwise(self.bounds)]

    def with_rows(self, name: str) -> range:
        """Return the cells of a world for which an array of a state has rows: all, or an island's.

        `name` is the array's name in a state, such as `bodies.island.0`.
        """
        before, _, rest = name.partition(f"bodies.{ARRAYS}")
        number = rest.partition(".")[0]
        if self.count == 1 or before or not number.isdecimal():
            return range(self.bounds[-1])
        return dict(enumerate(self.cells)).get(int(number), range(0))

    def of_cells(self, cells: Any) -> np.ndarray:
        """Return the islands' numbers for cells within a world, int (n,)."""
        return np.searchsorted(self.bounds, np.asarray(cells), side="right") - 1

    def split(self, setting: str) -> tuple[str, str]:
        """Split a dotted name into an island's name and a setting; the first is "" for all islands."""
        first, _, rest = setting.partition(".")
        return (first, rest) if first in self.names else ("", setting)

    def here(self, climate: Mapping[str, Values], island: Any, where: Any) -> dict[str, Values]:
        """Return the settings in force in n places, from those of the whole world and of islands.

        A setting that differs on an island has a second name in a climate: `island.setting`.

        Args:
            climate: dotted name -> values in n places, float32 (n,).
            island: island of each place, int (n,).
            where: `where` of NumPy or of JAX.
        """
        found: dict[str, Values] = {}
        for name, values in climate.items():
            if self.split(name)[0]:
                continue
            for number, own in enumerate(self.names):
                if (local := climate.get(f"{own}.{name}")) is not None:
                    values = where(island == number, local, values)
            found[name] = values
        return found
