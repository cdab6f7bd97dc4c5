"""A run's directory: settings, versions, description, the genomes it starts from, and its lock."""

import fcntl
import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout
from pydantic import BaseModel, ConfigDict, Field

from primordia import device, files, interrupts, own_code
from primordia.brains import genomes
from primordia.config import Config, parsed
from primordia.errors import InputError, InUseError, Trouble
from primordia.habitats.contract import AnyHabitat
from primordia.printable import printable
from primordia.runs import checkpoint, code, kept
from primordia.runs.description import Description, from_json
from primordia.runs.manifest import INPUTS
from primordia.runs.schema import TABLES
from primordia.settings.tables import flat, from_toml

FORMAT = 2
"""format of run directories; other formats are refused"""
VERSIONS, LOCK, FAULTS = "versions.json", "lock", "faults.txt"
FOLDERS = (*TABLES, checkpoint.FOLDER)
GLANCE = 0.05
"""Seconds to wait for a lock, since `is_written` in another process may hold it briefly."""
UNBEGUN = f"{files.TEMPORARY}run"
"""The file that marks a directory in which a run is being started; other files are never removed."""
OWN = (VERSIONS, *FOLDERS, code.FOLDER, kept.FOLDER, checkpoint.ORIGIN, *INPUTS, LOCK, FAULTS)
"""The names in a new run's directory."""


@contextmanager
def create(run: Path, config: Config, fill: Callable[[], object] | None = None) -> Iterator[None]:
    """Write settings, founders, code and versions into a new or empty directory, and hold its lock.

    The versions are written last: a directory with versions is a run. If the `with` block ends by
    an error or a signal before the first checkpoint, all files are removed.

    Args:
        run: the directory.
        config: the run's settings.
        fill: a function that writes the state with which a fork begins.

    Raises:
        InputError: the directory is taken.
        Trouble: a file cannot be written.
    """
    refuse_if_taken(run)
    habitat = config.build_habitat()
    law = config.build_law(habitat)
    versions = {"format": FORMAT, **versions_here(config, habitat)}
    missing = [path for path in (run, *run.parents) if not path.exists()]
    with interrupts.undone_by(partial(remove_empty, missing)):
        files.make_folder(run)
        with locked(run), interrupts.undone_by(partial(_remove_lock, run)):
            refuse_if_taken(run)  # another process may have made the directory since
            with held(run) as check, interrupts.undone_by(partial(_remove_unbegun, run, check)):
                files.mark(run / UNBEGUN)
                make_folders(run)
                if (founders := law.heredity.ancestors) is not None:
                    genomes.write(run / genomes.FOUNDERS, law.heredity.layout, founders, {})
                    config = config.model_copy(update={"ancestors": (genomes.FOUNDERS,)})
                own = code.copy(config, run), *kept.copy(config, habitat, run)
                Description.of(law, habitat, *own).write(run)
                files.write_text(run / "config.toml", config.to_toml())
                if fill is not None:
                    fill()
                files.write_text(run / VERSIONS, json.dumps(versions, indent=1))
                files.remove(run / UNBEGUN)
                yield


def _remove_unbegun(run: Path, check: Callable[[], None]) -> None:
    """Remove the files of `create`, unless there is a checkpoint from which the run can go on."""
    if (run / VERSIONS).exists() and checkpoint.exists(run):
        return
    with suppress(Trouble):
        check()
        _remove_start(run)


def _remove_start(run: Path) -> None:
    """Remove what the start of a run has made, except the lock. The mark goes last, so that a process
    that is killed meanwhile leaves no files without a mark."""
    for path in run.iterdir():
        name = path.name.removeprefix(files.TEMPORARY)
        if name in OWN and name != LOCK:
            files.remove(path)
    if (run / UNBEGUN).exists():
        files.remove(run / UNBEGUN)


def clear_unbegun(run: Path) -> bool:
    """Remove the files of a process that was killed while it started a run. Return whether the
    directory holds no run.

    Raises:
        InputError: another process is starting a run in the directory.
    """
    files.check_name(run)
    if not run.is_dir() or (run / VERSIONS).exists():
        return not run.is_dir()
    if not (run / UNBEGUN).is_file():  # the files are the user's own
        return True
    with locked(run):
        if (run / VERSIONS).exists():
            return False
        _remove_start(run)
    return True


def _remove_lock(run: Path) -> None:
    """Remove the lock of a folder that holds nothing else."""
    with suppress(OSError):
        if os.listdir(run) == [LOCK]:
            (run / LOCK).unlink()


def remove_empty(folders: list[Path]) -> None:
    """Remove those of the folders that are empty, in this order."""
    for path in folders:
        with suppress(OSError):
            path.rmdir()


def refuse_if_taken(run: Path) -> None:
    """Raise InputError if the path exists; a directory with at most a lock is allowed."""
    files.check_name(run)
    if (run / VERSIONS).exists():
        raise InputError(
            f"{run} exists already; choose another --out, or continue the run with"
            f" `primordia resume {run}`"
        )
    if run.exists() and not (run.is_dir() and {each.name for each in run.iterdir()} <= {LOCK}):
        raise InputError(f"{run} exists already and is not a run; choose another --out")


def check_same_settings(config: Config, run: Path) -> None:
    """Raise InputError if a run was begun with settings other than these; limits may differ."""
    ignored: Any = {"about", "stop", "ancestors"}
    here, there = (
        flat(each.model_dump(mode="json", exclude=ignored)) for each in (config, read_config(run))
    )
    for name in here | there:
        if (ours := here.get(name)) != (theirs := there.get(name)):
            raise InputError(
                f"{run} was begun with other settings: {name} is {theirs} there, and {ours} here;"
                " choose another --out"
            )


def make_folders(run: Path) -> None:
    """Make the missing folders of a run.

    Raises:
        InputError: there is a link or a file in place of a folder.
        Trouble: a folder cannot be made.
    """
    for name in FOLDERS:
        files.own_folder(run / name)


def note_faults(run: Path, lines: list[str]) -> None:
    """Append the reasons why simulations of bodies failed, a line for each organism that died of it.

    The file is for people and not part of a run's exact records: after an interruption a line may
    appear twice.

    Raises:
        InputError: the file is a link, or no regular file. Trouble: the lines cannot be written.
    """
    if not lines:
        return
    files.check_output(run / FAULTS)
    with files.writing(run / FAULTS), (run / FAULTS).open("a", encoding="utf-8") as file:
        file.writelines(printable(line, kept="\t") + "\n" for line in lines)


def read_config(run: Path) -> Config:
    """Return the configuration of a run directory, which was checked completely when the run began.

    Raises:
        InputError: this is not a run directory, or this version cannot read it.
    """
    files.check_name(run)
    made_by = recorded_versions(run).format
    if made_by > FORMAT:
        raise InputError(
            f"{run} was made by a newer primordia (format {made_by}, this one reads {FORMAT});"
            " upgrade"
        )
    if made_by < FORMAT:
        raise InputError(
            f"{run} has format {made_by}, and this primordia reads format {FORMAT} only;"
            f" `primordia run {run / 'config.toml'}` repeats the run from its beginning"
        )
    if not (file := run / "config.toml").is_file():
        raise InputError(f"{file} is missing; put it back")
    return parsed(from_toml(file), source=str(file))


def versions_here(config: Config, habitat: AnyHabitat) -> dict[str, str]:
    """Return the versions on which a new run here would depend, by name."""
    packages = own_code.packages(config.own_modules)
    return {**device.versions(), **habitat.versions, **packages}


class Versions(BaseModel):
    """The content of `versions.json`: the format, and the result of `versions_here` at the beginning."""

    model_config = ConfigDict(extra="allow", strict=True)
    __pydantic_extra__: dict[str, str]

    format: int = Field(ge=0, lt=2**31)


def recorded_versions(run: Path) -> Versions:
    """Return the versions that a run was begun with.

    Raises:
        InputError: this is not a run directory.
    """
    otherwise = f"{run} is not a run of primordia: it has no readable {VERSIONS}"
    return from_json(run / VERSIONS, Versions, otherwise)


@contextmanager
def locked(run: Path) -> Iterator[None]:
    """Hold the run's lock. The lock admits one writer at a time, and even kill -9 releases it.

    Raises:
        InUseError: another process holds the lock.
    """
    files.check_output(run / LOCK)
    lock = FileLock(run / LOCK)
    try:
        lock.acquire(timeout=GLANCE, poll_interval=GLANCE / 4)
    except Timeout:
        raise InUseError(f"{run} is being written by another process") from None
    except OSError as error:
        raise Trouble(f"{run} cannot be written: {error.strerror}") from None
    try:
        yield
    finally:
        lock.release()


def is_written(run: Path) -> bool:
    """Return whether a process holds the run's lock; this check writes nothing and refuses no writer."""
    try:
        handle = os.open(run / LOCK, os.O_RDONLY | os.O_NONBLOCK)  # a pipe would wait for a writer
    except OSError:
        return False
    try:
        fcntl.flock(handle, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(handle)
    return False


@contextmanager
def held(run: Path) -> Iterator[Callable[[], None]]:
    """Yield a check for a writer; it raises Trouble if the directory was removed or replaced."""
    # While the directory is open, no other directory gets its inode number.
    handle = os.open(run, os.O_RDONLY)

    def check() -> None:
        try:
            same = os.path.samestat(os.fstat(handle), os.stat(run))
        except OSError:
            same = False
        if not same:
            raise Trouble(
                f"{run} was removed or replaced while the run went on; the run has stopped"
            )

    try:
        yield check
    finally:
        os.close(handle)
