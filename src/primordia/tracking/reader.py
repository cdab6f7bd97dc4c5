"""The metrics of several runs, read at intervals while the runs go on. Each row is given once."""

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pyarrow.compute as pc

from primordia import files
from primordia.brains.genomes import FOUNDERS
from primordia.errors import Trouble
from primordia.runs import checkpoint
from primordia.runs.archive import Archive

Row = dict[str, Any]
"""A row of metrics: `tick`, and the values of all other columns by name."""
Version = tuple[str, int] | None
"""Name and time of the newest checkpoint of a run; None without a checkpoint."""


@dataclass(frozen=True)
class World:
    """A world with its names in dashboards."""

    name: str
    """such as `seed-3`, or `heredity/seed-3` in one of several arms"""
    identity: str
    """16 hexadecimal digits, a hash of all inputs of the world"""
    group: str
    """the group of all worlds that are shown together"""
    settings: dict[str, Any]


class Reader:
    """The rows of metrics of several runs."""

    def __init__(self, group: str) -> None:
        """Prepare to read; all worlds belong to the group."""
        self._group = group
        self._given: dict[str, int] = {}
        """for each world, the tick of the last row that was given"""
        self._seen: dict[Path, Version] = {}
        """newest checkpoint of each run when it was last read"""
        self._fault_in = cache(files.fault_in)
        """results of checked files: no file is read twice, since segments never change"""

    def new(
        self, runs: Mapping[str, Sequence[Path]], patient: bool
    ) -> Iterator[tuple[World, list[Row]]]:
        """Read the runs at their newest checkpoints. Return each world that has new rows, with the
        rows.

        A resumed run writes the rows after its last checkpoint again, bit for bit; these rows are
        not new.

        Args:
            runs: directories of runs by arm; "" is the name of a single arm.
            patient: skip a run that has no whole checkpoint this time, since its writer may have
                removed the files.

        Raises:
            InputError: a directory holds no run.
            Trouble: a run is damaged.
        """
        for arm, paths in runs.items():
            for path in paths:
                try:
                    version = newest_version(path)
                    if (patient or path in self._seen) and version == self._seen.get(path):
                        continue  # the run has no checkpoint yet, or no new one
                    found = list(self._of_run(arm, path))
                except (Trouble, OSError):
                    if not patient:
                        raise
                    continue
                self._seen[path] = version
                for world, rows in found:
                    self._given[world.identity] = rows[-1]["tick"]
                    yield world, rows

    def _of_run(self, arm: str, path: Path) -> Iterator[tuple[World, list[Row]]]:
        run = Archive(path)
        run.fault_in = self._fault_in
        metrics, identity = run.metrics, _identity(run, arm)
        for number, seed in enumerate(run.world_seeds.tolist()):
            world = self._world(run, arm, seed, identity)
            after = self._given.get(world.identity, -1)
            fresh = (pc.field("world") == number) & (pc.field("tick") > after)
            if rows := metrics.filter(fresh).drop_columns("world").to_pylist():
                yield world, rows

    def _world(self, run: Archive, arm: str, seed: int, identity: str) -> World:
        return World(
            name=f"{arm}/seed-{seed}" if arm else f"seed-{seed}",
            identity=hashlib.sha256(f"{identity} {seed}".encode()).hexdigest()[:16],
            group=self._group,
            settings={**_settings(run), "seed": seed},
        )


def newest_version(path: Path) -> Version:
    """Return name and time of the newest checkpoint of a run; None without a checkpoint."""
    folders = checkpoint.numbered(path)
    return (folders[-1].name, folders[-1].stat().st_mtime_ns) if folders else None


def _settings(run: Archive) -> dict[str, Any]:
    """Return the settings that a run shares with all worlds of its arm."""
    return run.config.model_dump(mode="json", exclude={"seed", "seeds"})


def _identity(run: Archive, arm: str) -> str:
    """Return a text that identifies a run's worlds on any machine; limits do not count."""
    settings = {name: value for name, value in _settings(run).items() if name != "stop"}
    begun = (run.path / FOUNDERS, run.path / checkpoint.ORIGIN / checkpoint.MANIFEST)
    seals = [files.sha256(path) for path in begun if path.exists()]
    return json.dumps([arm, settings, run.description.model_dump(mode="json"), seals])
