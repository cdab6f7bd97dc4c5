"""Arms: several runs read as one. The runs may be jobs that ran on any machine and in any order.

The worlds of the first run come first. Worlds keep their seeds. So a world has the same record and
digest in a separate run and beside other worlds.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pyarrow as pa

from primordia import files
from primordia.brains.genomes import FOUNDERS
from primordia.config import Config
from primordia.errors import InputError
from primordia.habitats.contract import AnyHabitat
from primordia.law.heredity import Heredity
from primordia.law.law import Law
from primordia.runs.archive import Archive
from primordia.runs.arrays import WORLDS
from primordia.runs.description import Description
from primordia.runs.lives import Lives, joined
from primordia.runs.manifest import Progress
from primordia.runs.records import Records
from primordia.settings.limits import Stop
from primordia.settings.tables import flat

OWN = ("about", "seed", "seeds", "stop", "fork")
"""The settings in which the runs of an arm may differ; forks must begin at the same tick."""
MOST = 2**16
"""Largest number of worlds of an arm."""


class Arm(Records):
    """The worlds of several runs with the same settings, but different seeds and perhaps limits."""

    def __init__(self, path: Path, runs: Sequence[Archive]) -> None:
        """Open runs as one arm.

        Args:
            path: the arm's folder, or any name.
            runs: one run or more, with the same settings except `seed`, `seeds` and `stop`.

        Raises:
            InputError: settings differ, or a world is given twice.
        """
        self.path, self.runs = path, tuple(runs)
        _refuse_others(self.runs)
        counts = [run.config.seeds for run in runs]
        self.firsts = np.concatenate([[0], np.cumsum(counts)[:-1]])
        """number of each run's first world in the arm, int64 (R,)"""
        self.config: Config = runs[0].config.model_copy(update={"seeds": sum(counts)})
        _refuse_twice(self.runs, self.world_seeds)

    @property
    def paths(self) -> tuple[Path, ...]:
        """The directories of all runs."""
        return tuple(run.path for run in self.runs)

    def parts(self) -> Iterator[Archive]:
        """Yield each run, and release its arrays and lives afterwards."""
        for number, run in enumerate(self.runs):
            yield run
            self.state.keep(number)
            run.release()

    @property
    def description(self) -> Description:
        """The description of the parts, the same in all runs."""
        return self.runs[0].description

    @cached_property
    def versions(self) -> dict[str, Any]:
        """The versions of all runs; different versions are separated by commas."""
        names = dict.fromkeys(name for run in self.runs for name in run.versions)
        return {name: self._one_or_all(name) for name in names}

    def _one_or_all(self, name: str) -> Any:
        found = list(dict.fromkeys(run.versions.get(name, "none") for run in self.runs))
        return found[0] if len(found) == 1 else ", ".join(map(str, found))

    @cached_property
    def world_seeds(self) -> np.ndarray:
        """The seed of each world, uint64 (W,)."""
        return np.concatenate([run.world_seeds for run in self.runs])

    @cached_property
    def progress(self) -> Progress:
        """The total seconds of all runs, and the limits that all runs share."""
        each = [run.progress for run in self.runs]
        wall_s, exact = sum(one.wall_s for one in each), all(one.exact for one in each)
        common = set.intersection(*(set(one.limits) for one in each))
        return Progress(
            limits=Stop(**dict(common)),
            wall_s=wall_s,
            exact=exact,
            restarts=sum(one.restarts for one in each),
        )

    @property
    def damaged(self) -> list[str]:
        """The fault of each damaged checkpoint that is newer than the state of its run."""
        return [fault for run in self.runs for fault in run.damaged]

    @cached_property
    def row_digests(self) -> dict[str, np.ndarray]:
        """The sums of row hashes of each table, uint64 (W, 2)."""
        tables = [run.row_digests for run in self.runs]
        return {name: np.concatenate([each[name] for each in tables]) for name in tables[0]}

    @cached_property
    def state(self) -> "_Joined":
        """The arrays of all states, joined, without the open tails."""
        return _Joined(self.runs, self.firsts, "state")

    @cached_property
    def origin(self) -> Mapping[str, np.ndarray] | None:
        """The arrays that the forks began with, joined; None if the runs are not forks."""
        return None if self.config.fork is None else _Joined(self.runs, self.firsts, "origin")

    @cached_property
    def lives(self) -> Lives:
        """All lives of all runs."""
        return joined([run.lives for run in self.parts()], self.firsts)

    def segments(self, name: str, columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
        """Read a table run by run; see `Records.table`."""
        for first, run in zip(self.firsts.tolist(), self.parts(), strict=True):
            for part in run.segments(name, columns):
                yield _shifted(part, first)

    def admit(self, *parts: str) -> None:
        """Allow the user's own code, which is the same in all runs, to be imported."""
        self.runs[0].admit(*parts)

    @property
    def habitat(self) -> AnyHabitat:
        """The habitat, for reading its properties."""
        return self.runs[0].habitat

    @property
    def law(self) -> Law:
        """The law of the worlds."""
        return self.runs[0].law

    @property
    def heredity(self) -> Heredity:
        """The part of the law that makes genomes."""
        return self.runs[0].heredity


def run_of(records: Records, world: int) -> tuple[Archive, int]:
    """Return the run that holds a world, and the number of the world in that run."""
    if isinstance(records, Archive):
        return records, world
    assert isinstance(records, Arm)
    number = int(np.searchsorted(records.firsts, world, side="right")) - 1
    return records.runs[number], world - int(records.firsts[number])


class _Joined(Mapping[str, np.ndarray]):
    """The arrays of several states by name, joined along their first axis.

    Arrays of worlds are small and are copied when a run is first opened. Other arrays are read at
    each use.
    """

    def __init__(
        self, runs: Sequence[Archive], firsts: np.ndarray, which: Literal["state", "origin"]
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

    def _one(self, run: Archive, name: str) -> np.ndarray:
        array = self._of(run)[name]
        run.release()
        return array

    def _of(self, run: Archive) -> Mapping[str, np.ndarray]:
        stored = run.state if self._which == "state" else run.origin
        assert stored is not None
        return stored

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


def _refuse_others(runs: Sequence[Archive]) -> None:
    """Raise InputError unless all runs have the settings, the code and the founders of the first."""
    first, *others = runs
    compared: dict[str, Callable[[Archive], Any]] = {
        "settings": _settings,
        "description": lambda run: flat(run.description.model_dump(exclude={"files_from"})),
        "ancestors": lambda run: {"genomes": run.config.ancestors and _founders(run)},
    }
    for run in others:
        for values in compared.values():
            own, reference = values(run), values(first)
            names = own | reference
            if differing := [name for name in names if own.get(name) != reference.get(name)]:
                raise InputError(
                    f"{run.path} and {first.path} do not belong to one arm: they differ in"
                    f" {differing[0]}"
                )
        own = {name: getattr(run.config, name) for name in OWN}
        run.config = first.config.model_copy(update=own)  # stored once, and the description too
        run.description = first.description


def _settings(run: Archive) -> dict[str, Any]:
    """Return the settings that must be equal, by dotted name."""
    ignored: Any = {**dict.fromkeys(OWN, True), "fork": {"run"}}
    return flat(run.config.model_dump(mode="json", exclude=ignored))


def _founders(run: Archive) -> str:
    return str(files.seal(run.path / FOUNDERS)["sha256"])


def _refuse_twice(runs: Sequence[Archive], seeds: np.ndarray) -> None:
    if len(seeds) > MOST:
        raise InputError(f"an arm has at most {MOST:,} worlds, not {len(seeds):,}")
    run_of = np.repeat(np.arange(len(runs)), [run.config.seeds for run in runs])
    order = np.argsort(seeds, kind="stable")
    twice = np.flatnonzero(seeds[order][1:] == seeds[order][:-1])
    if len(twice):
        one, other = (runs[run_of[row]].path for row in order[twice[0] : twice[0] + 2])
        raise InputError(f"{one} and {other} both hold the world of seed {seeds[order[twice[0]]]}")
