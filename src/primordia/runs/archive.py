"""A run directory opened for reading."""

from collections.abc import Iterator, Sequence
from functools import cache, cached_property
from pathlib import Path
from typing import Any, cast

import numpy as np
import pyarrow as pa

from primordia import files
from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.habitats.contract import AnyHabitat
from primordia.law.heredity import Heredity
from primordia.law.law import Law
from primordia.law.metabolism import Metabolism
from primordia.runs import checkpoint, code, description, directory, kept, segment
from primordia.runs.arrays import Arrays
from primordia.runs.checkpoint import Checkpoint
from primordia.runs.code import Code
from primordia.runs.description import Description
from primordia.runs.join import BORN, DIED, join
from primordia.runs.lives import Lives
from primordia.runs.manifest import Progress
from primordia.runs.records import Records
from primordia.runs.schema import TABLES
from primordia.runs.shapes import Expected
from primordia.settings.fields import rates_of
from primordia.settings.tables import PARTS, files_in


class Archive(Records):
    """A run directory opened for reading; each part is read, checked or built once, at its first use.

    Only the settings are read at opening. The archive shows the run at the checkpoint that was
    newest at the first use; open a run again to see newer ones. All files of that checkpoint,
    segments of the tables included, are checked against their checksums before anything of the
    checkpoint is read.
    """

    def __init__(self, path: str | Path, edited: bool = False) -> None:
        """Open a run by its directory.

        Args:
            path: the directory.
            edited: use the present version of the user's own code and files, not the run's copy.

        Raises:
            InputError: the directory holds no run, or a run that this version cannot read.
        """
        self.path, self.edited = Path(path), edited
        self.config: Config = directory.read_config(self.path)
        self.fault_in = cache(files.fault_in)
        """`files.fault_in` with a memory of results, so that no file is read twice"""
        if files_in(self.config.habitat):
            self.config = kept.keeping(self.config, self.path, self.description, edited)
        self._fitting: set[Path] = set()  # the checkpoints whose arrays fit the settings

    @property
    def runs(self) -> tuple[Records, ...]:
        """This run alone."""
        return (self,)

    def parts(self) -> "Iterator[Archive]":
        """Yield this run, and nothing else."""
        yield self

    @cached_property
    def description(self) -> Description:
        """The description of the run's parts, written when the run began."""
        about = description.read(self.path)
        rates = {*rates_of(self.config), *rates_of(Metabolism(), "metabolism.")}
        if not rates <= set(about.beginning):
            raise InputError(f"{self.path / description.FILE} does not describe this run")
        return about

    def code(self, *parts: str) -> Code:
        """Return the code that these parts, or all parts, would execute here."""
        wanted = parts or tuple(PARTS)
        return code.of_run(self.path, self.config, self.description, wanted, self.edited)

    def admit(self, *parts: str) -> None:
        """Allow the code of these parts, or of all parts, to be imported.

        Raises:
            InputError: the user has not trusted the code yet.
        """
        code.admit(self.path, self.code(*parts))
        if "habitat" in (parts or PARTS):
            kept.check(self.config, self.path, self.description)

    @cached_property
    def habitat(self) -> AnyHabitat:
        """The habitat, only for reading its properties; build a new one to make bodies.

        Raises:
            InputError: the user has not trusted the habitat's code yet (`law` and `heredity` also
                raise this error).
        """
        self.admit("habitat")
        return self.config.build_habitat()

    @cached_property
    def law(self) -> Law:
        """The law of the run's worlds."""
        self.admit()
        law = self.config.build_law(self.habitat)
        if law.heredity.layout != self.layout:
            raise Trouble(f"{self.path / description.FILE} does not describe this run's brain")
        return law

    @cached_property
    def heredity(self) -> Heredity:
        """The part of the law that makes genomes. Heredity needs neither habitat nor brain."""
        self.admit("mutation")
        heredity, about = self.config.build_heredity(self.layout), self.description
        rates = {f"mutation.{name}" for name in heredity.mutation.rates(self.layout)}
        if heredity.mutation.notes != about.notes or not rates <= set(about.beginning):
            raise Trouble(f"{self.path / description.FILE} does not describe this run's mutation")
        return heredity

    @cached_property
    def versions(self) -> dict[str, Any]:
        """The format, package versions and device that the run was begun with."""
        return directory.recorded_versions(self.path).model_dump()

    @cached_property
    def other_versions(self) -> list[str]:
        """Versions that have changed since the run began; without changes the run goes on bit for bit."""
        versions = [
            f"{name} {self.versions.get(name)} then, {now} now"
            for name, now in directory.versions_here(self.config, self.habitat).items()
            if self.versions.get(name) != now
        ]
        return versions + self.changed_code

    @property
    def changed_code(self) -> list[str]:
        """A line for each of the user's own files, of code or named by settings, that has changed since
        the run began."""
        about = self.description
        return code.changes(self.config, about.code) + kept.changes(about)

    @cached_property
    def newest(self) -> tuple[Checkpoint | None, list[str]]:
        """The newest whole checkpoint or None, and the fault of each newer checkpoint."""
        return checkpoint.newest(self.path, self.fault_in)

    @property
    def damaged(self) -> list[str]:
        """The fault of each damaged checkpoint that is newer than `last`."""
        return self.newest[1]

    @property
    def last(self) -> Checkpoint:
        """The newest whole checkpoint.

        Raises:
            InputError: the run has no checkpoint yet.
            Trouble: no checkpoint of the run is whole.
        """
        last, faults = self.newest
        if last is None and faults:
            raise checkpoint.no_whole_checkpoint(self.path, faults)
        if last is None:
            raise InputError(
                f"{self.path} has no checkpoint yet; `primordia resume {self.path}` goes on with it"
            )
        return last

    @property
    def progress(self) -> Progress:
        """The progress that the newest whole checkpoint holds."""
        return self.last.manifest.progress

    @property
    def row_digests(self) -> dict[str, np.ndarray]:
        """The sums of row hashes that the newest whole checkpoint holds."""
        return self.last.digests

    @cached_property
    def state(self) -> Arrays:
        """The arrays of the newest whole checkpoint.

        Raises:
            Trouble: the arrays do not fit the settings.
        """
        return self.arrays_of(self.last)

    @cached_property
    def origin(self) -> Arrays | None:
        """The arrays of the state that a fork began with; None if the run is not a fork.

        Raises:
            Trouble: the arrays are damaged.
        """
        return None if self._first is None else self.arrays_of(self._first)

    @cached_property
    def _first(self) -> Checkpoint | None:
        """The checkpoint that a fork began with."""
        return checkpoint.origin(self.path, self.fault_in)

    def release(self) -> None:
        """Release the arrays and the lives, which are read again at their next use.

        The newest checkpoint is remembered and not checked again. The results of other file checks
        are forgotten.
        """
        self.fault_in.cache_clear()
        for name in ("state", "origin", "lives", "count", "ends", "metrics"):
            self.__dict__.pop(name, None)

    def arrays_of(self, stored: Checkpoint) -> Arrays:
        """Open the arrays of a checkpoint of this run; each array is checked when it is first read.

        Raises:
            Trouble: the arrays do not fit the settings.
        """
        expected = Expected(self.config, self.description)
        arrays = stored.arrays(expected.fault_of)
        if stored.path not in self._fitting:
            if fault := expected.fault(arrays):
                raise arrays.unfit(fault)
            if any(len(each) != self.config.seeds for each in stored.digests.values()):
                raise arrays.unfit("the checkpoint has another number of worlds")
            self._fitting.add(stored.path)
        return arrays

    def segments(self, name: str, columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
        """Read a table segment by segment, the open tail last; see `table`."""
        if name not in TABLES:
            raise InputError(f"a run has no table {name!r}; its tables are {', '.join(TABLES)}")
        wanted, tail = columns and list(columns), self.state[f"tail.{name}"]
        closed = self.last.manifest.segments[name]
        empty = self.schema.arrow(name, tail[:0])
        for each in closed:
            yield segment.read(self.path / name / each.name, each.rows, empty.schema, wanted)
        if len(tail) or not closed:
            rows = self.schema.arrow(name, tail)
            yield rows.select(wanted) if wanted else rows

    @cached_property
    def lives(self) -> Lives:
        """All lives of the run, one row each.

        Raises:
            InputError: nothing has lived in the run yet.
            Trouble: births and deaths contradict each other.
        """
        closed, tail = self.last.manifest.segments["births"], self.state["tail.births"]
        count = sum(each.rows for each in closed) + len(tail)
        births, deaths = self.segments("births", tuple(BORN)), self.segments("deaths", DIED)
        try:
            lives = join(births, deaths, count, self.ends, self.config.begins, self.config.cells)
        except ValueError as error:
            raise Trouble(f"the records of {self.path} contradict themselves: {error}") from None
        if not len(lives):
            raise InputError(f"{self.path} is empty: nothing has lived in it yet")
        return lives


def run_of(records: Records, world: int) -> tuple[Archive, int]:
    """Return the run that holds a world, and the number of the world in that run."""
    number = int(np.searchsorted(records.firsts, world, side="right")) - 1
    return cast(Archive, records.runs[number]), world - int(records.firsts[number])
