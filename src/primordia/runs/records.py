"""The records of worlds, from which all figures and numbers are made.

`archive.Archive` reads the records of one run directory. `arm.Arm` reads the records of several
runs as one.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, cached_property, partial, wraps
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
import pyarrow as pa

from primordia import device
from primordia.brains.layout import Layout
from primordia.config import Config
from primordia.habitats.contract import AnyHabitat
from primordia.law.heredity import Heredity
from primordia.law.law import Law
from primordia.runs.arrays import read_count
from primordia.runs.description import Description
from primordia.runs.lives import Lives
from primordia.runs.manifest import Progress
from primordia.runs.schema import Schema

F = TypeVar("F", bound=Callable)


class Records(ABC):
    """The records of W worlds with the same law; each part is read or built at its first use."""

    @property
    def made_on(self) -> str:
        """The kind of device on which the run began."""
        return str(self.versions.get("device", device.CPU))

    path: Path
    """the directory for figures and videos"""
    config: Config
    """the settings; `seeds` is W"""

    @property
    @abstractmethod
    def paths(self) -> tuple[Path, ...]:
        """The run directories that hold the records."""

    @abstractmethod
    def parts(self) -> "Iterator[Records]":
        """Yield the records of each run, in the order of the worlds; a run is read when it is yielded."""

    @property
    @abstractmethod
    def description(self) -> Description:
        """The description of the run's parts, written when the run began."""

    @property
    @abstractmethod
    def versions(self) -> dict[str, Any]:
        """The format, package versions and device with which the worlds began."""

    @property
    @abstractmethod
    def world_seeds(self) -> np.ndarray:
        """The seed of each world, uint64 (W,)."""

    @property
    @abstractmethod
    def progress(self) -> Progress:
        """Seconds spent, the present limits, and whether everything repeats bit for bit."""

    @property
    @abstractmethod
    def damaged(self) -> list[str]:
        """The fault of each damaged checkpoint that is newer than the state."""

    @property
    @abstractmethod
    def row_digests(self) -> dict[str, np.ndarray]:
        """The sums of row hashes of each table, uint64 (W, 2)."""

    @property
    @abstractmethod
    def state(self) -> Mapping[str, np.ndarray]:
        """The arrays of the newest state, by name; the first axis is worlds, or cells world by world."""

    @property
    @abstractmethod
    def origin(self) -> Mapping[str, np.ndarray] | None:
        """The arrays that a fork began with, as in `state`; None if this is not a fork."""

    @property
    @abstractmethod
    def lives(self) -> Lives:
        """All lives, one row each.

        Raises:
            InputError: nothing has lived yet.
            Trouble: births and deaths contradict each other.
        """

    @abstractmethod
    def segments(self, name: str, columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
        """Read a table part by part; see `table`."""

    @abstractmethod
    def admit(self, *parts: str) -> None:
        """Allow the user's own code of these parts, or of all parts, to be imported.

        Raises:
            InputError: the user has not trusted the code yet.
        """

    @property
    @abstractmethod
    def habitat(self) -> AnyHabitat:
        """The habitat, only for reading its properties; build a new one to make bodies.

        Raises:
            InputError: the user has not trusted the habitat's code yet (`law` and `heredity` also
                raise this error).
        """

    @property
    @abstractmethod
    def law(self) -> Law:
        """The law of the worlds."""

    @property
    @abstractmethod
    def heredity(self) -> Heredity:
        """The part of the law that makes genomes. Heredity needs neither habitat nor brain."""

    @cached_property
    def layout(self) -> Layout:
        """The layout of genomes."""
        return Layout(tuple(self.description.blocks.items()))

    @cached_property
    def count(self) -> Callable[[str], np.ndarray]:
        """Return the 64-bit numbers of this name in the state, as uint64; each array is read once."""
        return cache(partial(read_count, self.state))

    @cached_property
    def ends(self) -> np.ndarray:
        """Ticks that each world has lived through, int64 (W,)."""
        return self.count("world.worlds.tick").astype(np.int64)

    @cached_property
    def schema(self) -> Schema:
        """The columns of the tables."""
        return Schema.described(self.config.cells, self.description)

    def table(self, name: str, columns: Sequence[str] | None = None) -> pa.Table:
        """Read `births`, `deaths` or `metrics`, all columns or some, in the order of events."""
        return pa.concat_tables(self.segments(name, columns))

    @cached_property
    def metrics(self) -> pa.Table:
        """The table `metrics`."""
        return self.table("metrics")

    def notes_of(self, lives: Lives) -> np.ndarray:
        """Return the mutation's notes at the births of some lives, int32 (L, n)."""
        if not self.schema.notes:
            return np.zeros((len(lives), 0), np.int32)
        return np.stack(self._of_births(lives, *self.schema.notes), axis=1)

    def mates_of(self, lives: Lives) -> np.ndarray:
        """Return the birth number of the mate at the births of some lives, int64 (L,); -1 without a
        mate."""
        return self._of_births(lives, "mate")[0] if self.schema.mates else np.full(len(lives), -1)

    def _of_births(self, lives: Lives, *columns: str) -> list[np.ndarray]:
        """Return columns of the births of some lives, each (L,); -1 for a missing value."""
        births = self.table("births", ("world", "id", *columns))
        world, number = births["world"].to_numpy(), births["id"].to_numpy()
        order = np.lexsort((number, world))
        rows = order[lives.rows_in(world[order], number[order])]
        return [births[name].fill_null(-1).to_numpy()[rows] for name in columns]


def on_its_device(function: F) -> F:
    """Let a function of a run compute on the kind of device that made the run, unless one is chosen.

    The function raises InputError if JAX has no such device here.
    """

    @wraps(function)
    def call(run: Records, *given: Any, **options: Any) -> Any:
        with device.selected(None, run.made_on):
            return function(run, *given, **options)

    return cast(F, call)
