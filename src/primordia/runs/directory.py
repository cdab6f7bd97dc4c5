"""A run's directory: settings, versions, description, the genomes it starts from, and its lock."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from primordia import device, files, own_code
from primordia.brains import genomes
from primordia.config import Config, parsed
from primordia.errors import InputError, Trouble
from primordia.habitats.contract import AnyHabitat
from primordia.runs import code
from primordia.runs.description import Description
from primordia.runs.schema import TABLES
from primordia.settings.tables import from_toml

FORMAT = 2
"""of run directories; others are refused"""


@contextmanager
def create(run: Path, config: Config) -> Iterator[None]:
    """Write settings, founders, code and versions into a new or empty directory, and hold its lock.

    The versions come last: a directory that has them is a run.

    Raises:
        InputError: the directory is taken.
        Trouble: a file cannot be written.
    """
    refuse_if_taken(run)
    make_folders(run)
    with locked(run):
        habitat = config.build_habitat()
        law, versions = (
            config.build_law(habitat),
            {"format": FORMAT, **versions_here(config, habitat)},
        )
        if (founders := law.heredity.ancestors) is not None:
            genomes.write(run / genomes.FOUNDERS, law.heredity.layout, founders, {})
            config = config.model_copy(update={"ancestors": (genomes.FOUNDERS,)})
        Description.of(law, habitat, code.copy(config, run)).write(run)
        _write_text(run / "config.toml", config.to_toml())
        _write_text(run / "versions.json", json.dumps(versions, indent=1))
        yield


def refuse_if_taken(run: Path) -> None:
    """Raise InputError unless the path is free or an empty directory."""
    if run.exists() and (not run.is_dir() or any(run.iterdir())):
        raise InputError(f"{run} exists already; choose another --out, or `primordia resume {run}`")


def make_folders(run: Path) -> None:
    """Make the missing folders of a run."""
    try:
        for name in (*TABLES, "checkpoints"):
            files.make_folder(run / name)
    except OSError as error:
        raise Trouble(f"{run} cannot be written: {error.strerror}") from None


def read_config(run: Path) -> Config:
    """Return the configuration of a run directory, which was checked as a whole when the run began.

    Raises:
        InputError: this is no run directory, or one that this version cannot read.
    """
    try:
        made_by = int(recorded_versions(run)["format"])
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError(
            f"{run} is not a run of primordia: it has no readable versions.json"
        ) from None
    if made_by > FORMAT:
        raise InputError(
            f"{run} was made by a newer primordia (format {made_by}, this one reads {FORMAT}); upgrade"
        )
    if made_by < FORMAT:
        raise InputError(
            f"{run} has format {made_by}, and this primordia reads format {FORMAT} only;"
            f" `primordia run {run / 'config.toml'}` lives it again from its beginning"
        )
    return parsed(from_toml(run / "config.toml"), source=str(run / "config.toml"))


def versions_here(config: Config, habitat: AnyHabitat) -> dict[str, str]:
    """Return the versions that a run begun here would depend on, by name."""
    packages = own_code.packages(config.own_modules.values())
    return {**device.versions(), **habitat.versions, **packages}


def recorded_versions(run: Path) -> dict[str, Any]:
    """Return the content of `versions.json`: the format, and what `versions_here` gave then."""
    recorded: dict[str, Any] = json.loads((run / "versions.json").read_text())
    return recorded


@contextmanager
def locked(run: Path) -> Iterator[None]:
    """Hold the run's lock, which admits one writer at a time and is released even by kill -9.

    Raises:
        InputError: another process holds it.
    """
    lock = FileLock(run / "lock")
    try:
        lock.acquire(timeout=0)
    except Timeout:
        raise InputError(f"{run} is being written by another process") from None
    except OSError as error:
        raise Trouble(f"{run} cannot be written: {error.strerror}") from None
    try:
        yield
    finally:
        lock.release()


def _write_text(path: Path, text: str) -> None:
    def fill(temporary: Path) -> None:
        temporary.write_text(text)

    files.write(path, fill)
