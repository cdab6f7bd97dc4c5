"""The records of worlds, from which all figures and numbers are made: those of one run or of several.

`archive.Archive` is one run. Several runs are read as one arm; they may be jobs that ran on any
machine and in any order. The worlds of the first run come first. Worlds keep their seeds. So a world
has the same record and digest in a separate run and beside other worlds.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, cached_property, partial, wraps
from pathlib import Path
from typing import Any, Literal, TypeVar, cast

import numpy as np
import pyarrow as pa

from primordia import device
from primordia.brains.layout import Layout
from primordia.config import Config
from primordia.habitats.contract import AnyHabitat
from primordia.law.heredity import Heredity
from primordia.law.law import Law
from primordia.law.metabolism import ONE
from primordia.runs.arrays import WORLDS, read_count
from primordia.runs.description import Description
from primordia.runs.lives import Lives, find_rows, joined
from primordia.runs.manifest import Progress
from primordia.runs.schema import Schema
from primordia.settings.limits import Stop

F = TypeVar("F", bound=Callable)


class Records:
    """The records of W worlds with the same law; each part is read or built at its first use.

    This class joins the records of runs. `archive.Archive` reads those of one run.
    """

    path: Path
    """the directory for figures and videos"""
    config: Config
    """the settings; `seeds` is W"""

    def __init__(self, path: Path, runs: Sequence["Records"]) -> None:
        """Join one run or more, with the same settings except those of `arm.OWN`; see `arm.arm`."""
        self.path, self._runs = path, tuple(runs)
        self.config = runs[0].config.model_copy(update={"seeds": sum(r.config.seeds for r in runs)})

    @property
    def runs(self) -> tuple["Records", ...]:
        """The runs; those of one run are the run itself."""
        return self._runs

    @cached_property
    def firsts(self) -> np.ndarray:
        """Number of each run's first world, int64 (R,)."""
        return np.cumsum([0, *(run.config.seeds for run in self.runs[:-1])])

    @property
    def paths(self) -> tuple[Path, ...]:
        """The directories of all runs."""
        return tuple(run.path for run in self.runs)

    def parts(self) -> Iterator["Records"]:
        """Yield each run in the order of the worlds, and release its arrays and lives afterwards."""
        for number, run in enumerate(self.runs):
            yield run
            self._states.keep(number)
            run.release()

    def release(self) -> None:
        """Release arrays and lives, which are read again at their next use."""
        for run in self.runs:
            run.release()

    @cached_property
    def description(self) -> Description:
        """The description of the runs' parts, written when they began and the same in all."""
        return self.runs[0].description

    @cached_property
    def versions(self) -> dict[str, Any]:
        """The format, package versions and device with which the worlds began; different versions of
        several runs are separated by commas."""
        names = dict.fromkeys(name for run in self.runs for name in run.versions)
        return {name: self._one_or_all(name) for name in names}

    def _one_or_all(self, name: str) -> Any:
        found = list(dict.fromkeys(run.versions.get(name, "none") for run in self.runs))
        return found[0] if len(found) == 1 else ", ".join(map(str, found))

    @property
    def made_on(self) -> str:
        """The kind of device on which the run began."""
        return str(self.versions.get("device", device.CPU))

    @cached_property
    def world_seeds(self) -> np.ndarray:
        """The seed of each world, uint64 (W,)."""
        return np.concatenate([run.config.world_seeds for run in self.runs])

    @property
    def progress(self) -> Progress:
        """The seconds spent, the present limits that all runs share, and whether everything repeats
        bit for bit."""
        each = [run.progress for run in self.runs]
        common = set.intersection(*(set(one.limits) for one in each))
        return Progress(
            limits=Stop(**dict(common)),
            wall_s=sum(one.wall_s for one in each),
            exact=all(one.exact for one in each),
            restarts=sum(one.restarts for one in each),
        )

    @property
    def damaged(self) -> list[str]:
        """The fault of each damaged checkpoint that is newer than the state of its run."""
        return [fault for run in self.runs for fault in run.damaged]

    @property
    def row_digests(self) -> dict[str, np.ndarray]:
        """The sums of row hashes of each table, uint64 (W, 2)."""
        tables = [run.row_digests for run in self.runs]
        return {name: np.concatenate([each[name] for each in tables]) for name in tables[0]}

    @property
    def state(self) -> Mapping[str, np.ndarray]:
        """The arrays of the newest state, by name; the first axis is worlds, or cells world by world."""
        return self._states

    @cached_property
    def _states(self) -> "_Joined":
        return _Joined(self.runs, self.firsts, "state")

    @cached_property
    def origin(self) -> Mapping[str, np.ndarray] | None:
        """The arrays that a fork began with, as in `state`; None if this is not a fork."""
        return None if self.config.fork is None else _Joined(self.runs, self.firsts, "origin")

    @cached_property
    def lives(self) -> Lives:
        """All lives, one row each.

        Raises:
            InputError: nothing has lived yet.
            Trouble: births and deaths contradict each other.
        """
        return joined([run.lives for run in self.parts()], self.firsts)

    def segments(self, name: str, columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
        """Read a table part by part; see `table`."""
        for first, run in zip(self.firsts.tolist(), self.parts(), strict=True):
            for part in run.segments(name, columns):
                yield _shifted(part, first)

    def admit(self, *parts: str) -> None:
        """Allow the user's own code of these parts, or of all parts, to be imported.

        Raises:
            InputError: the user has not trusted the code yet.
        """
        self.runs[0].admit(*parts)

    @cached_property
    def habitat(self) -> AnyHabitat:
        """The habitat, only for reading its properties; build a new one to make bodies.

        Raises:
            InputError: the user has not trusted the habitat's code yet (`law` and `heredity` also
                raise this error).
        """
        return self.runs[0].habitat

    @cached_property
    def law(self) -> Law:
        """The law of the worlds."""
        return self.runs[0].law

    @cached_property
    def heredity(self) -> Heredity:
        """The part of the law that makes genomes. Heredity needs neither habitat nor brain."""
        return self.runs[0].heredity

    @cached_property
    def layout(self) -> Layout:
        """The layout of genomes."""
        traits = self.config.traits
        genes = len(traits.names) if traits else 0
        return Layout(tuple(self.description.blocks.items()), genes)

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
        """Read `births`, `deaths` or `metrics`, all columns or some, in the order of events.

        Raises:
            InputError: there is no such table.
        """
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

    def endowments_of(self, lives: Lives) -> np.ndarray:
        """Return the energy with which some lives began, int32 (L,), fixed point, if replication is an
        act."""
        return np.round(self._of_births(lives, "endowment")[0] * ONE).astype(np.int32)

    def _of_births(self, lives: Lives, *columns: str) -> list[np.ndarray]:
        """Return columns of the births of some lives, each (L,); -1 for a missing value."""
        births = self.table("births", ("world", "id", *columns))
        world, number = births["world"].to_numpy(), births["id"].to_numpy()
        order = np.lexsort((number, world))
        rows = order[find_rows(world[order], number[order], lives.world, lives.id)]
        return [births[name].fill_null(-1).to_numpy()[rows] for name in columns]


class _Joined(Mapping[str, np.ndarray]):
    """The arrays of several states by name, joined along their first axis.

    Arrays of worlds are small and are copied when a run is first opened. Other arrays are read at
    each use.
    """

    def __init__(
        self, runs: Sequence[Records], firsts: np.ndarray, which: Literal["state", "origin"]
    ) -> None:
        self._runs, self._firsts, self._which = runs, firsts, which
        self._names = [name for name in self._of(runs[0]) if not name.startswith("tail.")]
        self._read: dict[str, np.ndarray] = {}
        self._worlds: dict[str, np.ndarray] = {}
        self._kept, self._count = np.zeros(len(runs), bool), sum(run.config.seeds for run in runs)

    def keep(self, number: int) -> None:
        """Copy the arrays of the worlds of one run; `number` is the run's index in the arm."""
        if self._kept[number]:
            return
        stored, first = self._of(self._runs[number]), self._firsts[number]
        for name in self._names:
            if name.startswith(WORLDS):
                own = stored[name]
                if name not in self._worlds:
                    self._worlds[name] = np.empty((self._count, *own.shape[1:]), own.dtype)
                self._worlds[name][first : first + len(own)] = own
        self._kept[number] = True

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._names:
            raise KeyError(name)
        if name.startswith(WORLDS):
            for number in np.flatnonzero(~self._kept).tolist():
                self.keep(number)
                self._runs[number].release()
            return self._worlds[name]
        if name not in self._read:
            self._read[name] = np.concatenate([self._one(run, name) for run in self._runs])
        return self._read[name]

    def _one(self, run: Records, name: str) -> np.ndarray:
        array = self._of(run)[name]
        run.release()
        return array

    def _of(self, run: Records) -> Mapping[str, np.ndarray]:
        return cast(Mapping[str, np.ndarray], getattr(run, self._which))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def _shifted(part: pa.Table, first: int) -> pa.Table:
    """Return rows with worlds numbered from `first`."""
    place = part.schema.get_field_index("world")
    if place < 0 or first == 0:
        return part
    world = part["world"].to_numpy() + np.int32(first)
    return part.set_column(place, part.schema.field(place), pa.array(world))


def on_its_device(function: F) -> F:
    """Let a function of a run compute on the kind of device that made the run, unless one is chosen.

    The function raises InputError if JAX has no such device here.
    """

    @wraps(function)
    def call(run: Records, *given: Any, **options: Any) -> Any:
        with device.selected(None, run.made_on):
            return function(run, *given, **options)

    return cast(F, call)
