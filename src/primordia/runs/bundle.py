"""Bundles: a run in one file. A bundle is a zip of the files that the newest checkpoint names.

    run/versions.json  config.toml  description.json  ...
    run/births/*.parquet  deaths/*.parquet  metrics/*.parquet
    run/checkpoints/000012/  origin/

Equal runs give bundles with equal bytes. A bundle may come from a stranger and is not trusted:
a manifest must name each file, with its size and checksum; only `versions.json` and the manifests
themselves are exempt. Nothing is compressed, so unpacking cannot take more space than the bundle.
Nothing in a bundle is executed.
"""

import atexit
import os
import re
import shutil
import stat
import unicodedata
import zipfile
from collections.abc import Mapping
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import IO

from primordia import files, interrupts
from primordia.errors import InputError, Trouble
from primordia.runs import checkpoint, directory, manifest
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import FOLDER, MANIFEST, NUMBER, ORIGIN, STATE
from primordia.runs.directory import LOCK, VERSIONS
from primordia.runs.manifest import Manifest, Seal

TOP = "run/"
"""The folder in a bundle that holds the run."""
EPOCH = (1980, 1, 1, 0, 0, 0)
"""The time of all files in a bundle, the earliest that a zip can hold."""
PIECE = 2**20
"""Number of bytes that are copied at once."""
TRIES = 3
"""Number of attempts to read a run that goes on meanwhile."""
MANIFESTS = re.compile(rf"({ORIGIN}|{FOLDER}/{NUMBER.pattern})/{re.escape(MANIFEST)}")
"""Pattern of a manifest's path in a run; its group is the folder."""
Seals = dict[str, Seal | None]
"""Size and checksum of files by their path below the run; None for manifests and versions."""
Entries = dict[str, zipfile.ZipInfo]
"""The entries of a zip, by the path of a file below the run."""
_copies: dict[tuple, Path] = {}
"""The copy that `opened` made of each bundle, by path, size and time of the bundle."""
_bundles: dict[Path, Path] = {}
"""The bundle of each copy."""


def write(run: Path, file: Path) -> Archive:
    """Write a run at its newest whole checkpoint into a file. Return the run that was written.

    Raises:
        InputError: the run has no checkpoint yet, or the path exists and is not a file.
        Trouble: the run is damaged, or the file cannot be written.
    """
    files.check_output(file)
    with ExitStack() as stack:
        for _ in range(TRIES):
            archive = Archive(run)
            names = sorted(_named(archive))
            try:
                sources = {name: stack.enter_context((run / name).open("rb")) for name in names}
            except FileNotFoundError:  # the run has gone on and removed this checkpoint
                continue
            files.make_folder(file.parent)
            files.write(file, partial(_fill, sources))
            return archive
    raise Trouble(f"{run} changes faster than it can be read; stop it first")


def _named(run: Archive) -> Seals:
    """Return the files of a run at its newest whole checkpoint."""
    kept = [run.last, checkpoint.origin(run.path, run.fault_in)]
    manifests = {each.path: each.manifest for each in kept if each is not None}
    return _sealed({path.relative_to(run.path).as_posix(): manifests[path] for path in manifests})


def _sealed(manifests: dict[str, Manifest]) -> Seals:
    """Return the files that manifests name, given by their folders.

    Raises:
        ValueError: two manifests contradict each other.
    """
    seals: Seals = {VERSIONS: None}
    for folder, each in manifests.items():
        named: Seals = {
            f"{folder}/{MANIFEST}": None,
            f"{folder}/{STATE}": each.state,
            **each.inputs,
        }
        for table, segments in each.segments.items():
            named |= {f"{table}/{one.name}": Seal(one.bytes, one.sha256) for one in segments}
        for name, seal in named.items():
            if seals.setdefault(name, seal) != seal:
                raise ValueError(f"its manifests contradict each other about {name}")
    return seals


def _fill(sources: Mapping[str, IO[bytes]], path: Path) -> None:
    """Write a zip without compression, whose bytes depend only on names and contents."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as bundle:
        for name, source in sources.items():
            entry = zipfile.ZipInfo(TOP + name, EPOCH)
            entry.create_system, entry.external_attr = 3, (stat.S_IFREG | 0o644) << 16
            entry.file_size = os.fstat(source.fileno()).st_size
            with bundle.open(entry, "w") as to:
                shutil.copyfileobj(source, to, PIECE)


def opened(file: Path) -> Path:
    """Return a directory with the run of a bundle; the directory is removed when this process ends.

    Raises:
        InputError: the file is not a bundle, or differs from its manifests. Trouble: the directory
            cannot be written.
    """
    about = file.stat()
    key = file.resolve(), about.st_ino, about.st_size, about.st_mtime_ns
    if key not in _copies:
        temporary = TemporaryDirectory(prefix="primordia-")
        atexit.register(temporary.cleanup)
        copy = Path(temporary.name) / (file.name.partition(".")[0] or "run")
        with interrupts.undone_by(temporary.cleanup):
            _extract(file, copy)
        _copies[key], _bundles[copy] = copy, file
    return _copies[key]


def origin_of(path: Path) -> Path:
    """If `path` is a copy that `opened` made, return the copy's bundle; otherwise return `path`."""
    return _bundles.get(path, path)


def unbundle(file: Path, folder: Path) -> None:
    """Make a run's directory from a bundle.

    Raises:
        InputError: the file is not a bundle, or differs from its manifests; or the folder is taken,
            or another process unpacks a bundle into it.
        Trouble: the directory cannot be written.
    """
    files.check_name(folder)
    if not file.is_file():
        raise InputError(f"there is no bundle {file}")
    empty = folder.is_dir() and not folder.is_symlink() and not any(folder.iterdir())
    if os.path.lexists(folder) and not empty:
        raise InputError(f"{folder} exists already; name another folder")
    missing = [path for path in folder.parents if not path.exists()]
    temporary = folder.with_name(files.TEMPORARY + folder.name)
    with interrupts.undone_by(partial(directory.remove_empty, missing)):
        files.own_folder(temporary)
        discard = partial(shutil.rmtree, temporary, ignore_errors=True)
        with directory.locked(temporary), interrupts.undone_by(discard):
            left = set(temporary.iterdir()) - {temporary / LOCK}  # by a process that was killed
            for each in left:
                files.remove(each)
            _extract(file, temporary)
            with files.writing(folder):
                for each in (*temporary.rglob("*"), temporary):
                    files.sync(each)
                temporary.rename(folder)
                files.sync(folder.parent)


def refuse_changes(path: Path) -> None:
    """Raise InputError if a path is a bundle, or a copy that `opened` made of a bundle."""
    if path.is_file() or path in _bundles:
        file = origin_of(path)
        raise InputError(
            f"{file} is a bundle and cannot be changed; `primordia unbundle {file} FOLDER` makes a "
            "run from the bundle. For figures, films and pages of a bundle, give --out"
        )


def _extract(file: Path, folder: Path) -> None:
    """Write the files that a bundle must hold into a new folder."""
    if not zipfile.is_zipfile(file):
        raise InputError(f"{file} is neither a run of primordia nor a bundle of one")
    try:
        with zipfile.ZipFile(file) as bundle:
            entries = _entries(bundle)
            if sum(each.file_size for each in entries.values()) > file.stat().st_size:
                raise ValueError("its files are larger than the bundle")
            seals = _seals(bundle, entries)
            for name in sorted(entries.keys() ^ seals.keys()):
                held = "is not named by any manifest" if name in entries else "is missing"
                raise ValueError(f"{name} {held}")
            for name, seal in seals.items():
                if seal is not None and seal.bytes != entries[name].file_size:
                    raise ValueError(f"{name} has another size than the manifest says")
            directory.make_folders(folder)
            for name, seal in seals.items():
                with bundle.open(entries[name]) as source:
                    _copy(source, folder / name, seal)
    except (InputError, Trouble):
        raise
    except Exception as error:  # zipfile raises errors of many kinds for other files
        raise InputError(f"{file} is not a valid bundle: {error}") from None


def _entries(bundle: zipfile.ZipFile) -> Entries:
    """Return the entries of a zip.

    Raises:
        ValueError: the zip holds something that no bundle holds.
    """
    entries: Entries = {}
    for entry in bundle.infolist():
        name, kind = entry.orig_filename.removeprefix(TOP), stat.S_IFMT(entry.external_attr >> 16)
        parts = name.split("/")
        if not entry.orig_filename.startswith(TOP) or not all(map(files.is_plain, parts)):
            raise ValueError(f"{entry.orig_filename!r} is not the path of a file in a run")
        if kind not in (0, stat.S_IFREG):
            raise ValueError(f"{name} is {files.KINDS.get(kind, 'no file')}")
        if entry.flag_bits & 1:
            raise ValueError(f"{name} is encrypted")
        if entry.compress_type != zipfile.ZIP_STORED or entry.compress_size != entry.file_size:
            raise ValueError(f"{name} is compressed, but files in a bundle are never compressed")
        if name in entries:
            raise ValueError(f"{name} occurs twice")
        entries[name] = entry
    folded = {unicodedata.normalize("NFKC", name).casefold() for name in entries}
    if len(folded) != len(entries):
        raise ValueError("two of its files have names that differ only in case")
    return entries


def _seals(bundle: zipfile.ZipFile, entries: Entries) -> Seals:
    """Return the files that a bundle must hold: the files that its manifests name.

    Raises:
        ValueError: the bundle has no manifest or several, or a manifest was changed.
    """
    found = [match for match in map(MANIFESTS.fullmatch, entries) if match]
    for name in (VERSIONS, *(match[0] for match in found)):
        if name in entries and entries[name].file_size > files.READABLE:
            raise ValueError(f"{name} is too large")
    manifests = {match[1]: manifest.parsed(bundle.read(entries[match[0]])) for match in found}
    if len(manifests.keys() - {ORIGIN}) > 1 or not manifests:
        raise ValueError(f"it has {len(manifests) or 'no'} checkpoints instead of one")
    return _sealed(manifests)


def _copy(source: IO[bytes], path: Path, seal: Seal | None) -> None:
    """Write a new file; raise ValueError if its checksum is wrong."""
    files.make_folder(path.parent)
    with files.writing(path), path.open("xb") as file:
        shutil.copyfileobj(source, file, PIECE)
    if seal is not None and files.sha256(path) != seal.sha256:
        raise ValueError(f"the checksum of {path.name} differs")
