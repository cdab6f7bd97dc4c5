"""What a forger makes of a bundle is refused in one line, or makes no difference."""

import hashlib
import json
import os
import struct
import tempfile
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import primordia
from primordia import files
from primordia.errors import InputError
from primordia.runs import bundle, loop, manifest
from tests.bundles import SETTINGS, temporary_files  # noqa: F401, which pytest calls
from tests.commands import complains, here
from tests.trouble import contents
from tests.worlds import config

Entry = tuple[zipfile.ZipInfo, bytes]
Change = Callable[[list[Entry]], Any]


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a bundle of a run."""
    run = tmp_path_factory.mktemp("made") / "run"
    loop.start(config(SETTINGS), run)
    return primordia.load(run).bundle(run.with_name("run.zip"))


def entries(file: Path) -> list[Entry]:
    with zipfile.ZipFile(file) as zipped:
        return [(plain(each.filename), zipped.read(each)) for each in zipped.infolist()]


def plain(name: str, mode: int = 0o100644) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, bundle.EPOCH)
    entry.create_system, entry.external_attr = 3, mode << 16
    return entry


def zipped(parts: list[Entry], path: Path) -> Path:
    with warnings.catch_warnings(), zipfile.ZipFile(path, "w") as file:
        warnings.simplefilter("ignore")  # of names that are there twice
        for entry, content in parts:
            file.writestr(entry, content)
    return path


def adding(name: str, mode: int = 0o100644) -> Change:
    return lambda parts: parts.append((plain(name, mode), b"x"))


def replacing(end: str, with_: Callable[[bytes], bytes | None]) -> Change:
    """Change the content of files whose names end in `end`; None removes them."""

    def change(parts: list[Entry]) -> None:
        new = [(e, with_(content) if e.filename.endswith(end) else content) for e, content in parts]
        parts[:] = [(entry, content) for entry, content in new if content is not None]

    return change


def dropping(end: str) -> Change:
    return replacing(end, lambda _: None)


def compressing(parts: list[Entry]) -> None:
    for entry, _ in parts:
        entry.compress_type = zipfile.ZIP_DEFLATED


def second_checkpoint(parts: list[Entry]) -> None:
    for entry, content in list(parts):
        if "checkpoints/" in entry.filename:
            parts.append((plain(entry.filename.replace("checkpoints/0", "checkpoints/9")), content))


def resealed(content: bytes, change: Callable[[dict[str, Any]], object]) -> bytes:
    """Return a changed manifest with its new checksum."""
    told = json.loads(content)
    del told["sha256"]
    change(told)
    told["sha256"] = manifest._checksum(told)
    return json.dumps(told).encode()


def contradicting(parts: list[Entry]) -> None:
    """Add an origin that names other bytes of the settings."""
    content = next(each for entry, each in parts if entry.filename.endswith("manifest.json"))
    forged = resealed(content, lambda told: told["inputs"]["config.toml"].update(bytes=1))
    parts.append((plain("run/origin/manifest.json"), forged))


def naming(*names: str) -> Change:
    """Let the manifest name empty files of the user's own code, which are there."""
    seal = {"bytes": 0, "sha256": hashlib.sha256(b"").hexdigest()}

    def change(parts: list[Entry]) -> None:
        more = dict.fromkeys(names, seal)
        replacing(
            "manifest.json", lambda content: resealed(content, lambda t: t["inputs"].update(more))
        )(parts)
        parts.extend((plain(f"run/{name}"), b"") for name in names)

    return change


HOSTILE: dict[str, tuple[Change, str]] = {
    "outside": (adding("evil"), "'evil' is not the path of a file in a run"),
    "above, late": (adding("run/code/../../../evil"), "not the path of a file"),
    "a link": (adding("run/code/evil.py", 0o120777), "code/evil.py is a symbolic link"),
    "a pipe": (adding("run/code/evil.py", 0o010666), "code/evil.py is a pipe"),
    "two of a name": (lambda parts: parts.append(parts[0]), "occurs twice"),
    "names that differ by case": (adding("run/CONFIG.toml"), "differ only in case"),
    "names that differ by form": (adding("run/\uff43onfig.toml"), "differ only in case"),
    "more than is named": (adding("run/code/evil.py"), "code/evil.py is not named by any manifest"),
    "less than is named": (dropping("000000.parquet"), "births/000000.parquet is missing"),
    "no versions": (dropping("versions.json"), "versions.json is missing"),
    "no manifest": (dropping("manifest.json"), "it has no checkpoints instead of one"),
    "two checkpoints": (second_checkpoint, "it has 2 checkpoints instead of one"),
    "manifests at odds": (contradicting, "contradict each other about config.toml"),
    "another size": (replacing("config.toml", lambda content: content + b"\n"), "another size"),
    "another content": (
        replacing("config.toml", lambda content: b"#" + content[1:]),
        "the checksum of config.toml differs",
    ),
    "a changed manifest": (
        replacing("t.json", lambda content: content.replace(b": 0", b": 1")),
        "was changed",
    ),
    "no JSON": (replacing("manifest.json", lambda content: b"\xff" + content), "cannot be read"),
    "deep JSON": (replacing("manifest.json", lambda _: b"[" * 10**5), "cannot be read"),
    "compressed": (compressing, "is compressed"),
    "deep folders": (naming(f"code/{'d/' * 1000}x.py"), "not that of a run"),
    "many folders": (naming(*(f"code/{each}/x.py" for each in range(5000))), "not that of a run"),
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_bundle_is_refused_in_one_line(file: Path, tmp_path: Path, kind: str) -> None:
    change, words = HOSTILE[kind]
    parts = entries(file)
    change(parts)
    (folder := tmp_path / "folder").mkdir()
    forged, before = zipped(parts, folder / "forged.zip"), os.listdir(tempfile.gettempdir())
    for command in (["info"], ["unbundle", str(folder / "new")]):
        complains(here(command[0], forged, *command[1:]), 2, words)
    assert os.listdir(tempfile.gettempdir()) == before
    assert (os.listdir(tmp_path), os.listdir(folder)) == (["folder"], ["forged.zip"])


CENTRAL, LOCAL = b"PK\x01\x02", b"PK\x03\x04"
"""Signatures of what a zip says of a file at its end, and before the file."""


@pytest.mark.parametrize(
    ("signature", "offset", "value", "says"),
    [
        (CENTRAL, 8, b"\x01", "is encrypted"),
        (CENTRAL, 24, struct.pack("<I", 1), "is compressed"),  # less than the stored bytes
        (CENTRAL, 42, struct.pack("<I", 0), "is not a valid bundle"),  # it lies upon another
        (CENTRAL, 46 + 8, b"\0", "not the path of a file"),
        (LOCAL, 30, b"RUN", "is not a valid bundle"),  # it has two names
    ],
)
def test_an_odd_header_of_the_last_file_is_refused(
    file: Path, tmp_path: Path, signature: bytes, offset: int, value: bytes, says: str
) -> None:
    content = bytearray(file.read_bytes())
    at = content.rindex(signature) + offset
    content[at : at + len(value)] = value
    (tmp_path / "odd.zip").write_bytes(content)
    complains(here("info", tmp_path / "odd.zip"), 2, says)


def test_half_a_bundle_is_refused(file: Path, tmp_path: Path) -> None:
    content, says = file.read_bytes(), "is neither a run of primordia nor a bundle of one"
    middle = len(content) // 2
    for half, words in ((content[:middle], says), (content[middle:], "is not a valid bundle")):
        (tmp_path / "half.zip").write_bytes(half)
        complains(here("info", tmp_path / "half.zip"), 2, words)


def test_files_that_together_are_larger_than_their_bundle_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Entries of a zip may overlap, so that the same bytes are unpacked many times."""
    file = zipped([(plain("run/a"), b"x" * 100)], tmp_path / "a.zip")
    held = {name: plain(f"run/{name}") for name in "ab"}
    for each in held.values():
        each.file_size = file.stat().st_size // 2 + 1
    monkeypatch.setattr(bundle, "_entries", lambda _: held)
    with pytest.raises(InputError, match="its files are larger than the bundle"):
        bundle.unbundle(file, tmp_path / "run")


def test_a_large_file_of_those_that_are_read_whole_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "READABLE", 3)
    names = ("versions.json", "origin/manifest.json", "checkpoints/000001/manifest.json")
    for name in names:
        parts = [(plain(f"run/{each}"), bytes(4 if each == name else 3)) for each in names]
        forged = zipped(parts, tmp_path / "a.zip")
        with pytest.raises(InputError, match=f"is not a valid bundle: {name} is too large$"):
            bundle.unbundle(forged, tmp_path / "run")


@pytest.mark.parametrize("part", ["", ".", "..", *'\\:*?"<>|', "\n", "\x1b", "\u202e"])
def test_a_name_that_some_system_does_not_allow_is_refused(part: str, tmp_path: Path) -> None:
    """Some programs store no mode of a file, and such a file is accepted."""
    names = (part, f"a{part}b") if part.strip(".") else (part,)
    for name, says in (("x", "has no checkpoints"), *((each, "not the path") for each in names)):
        forged = zipped([(plain(f"run/code/{name}/x.py", 0), b"")], tmp_path / "a.zip")
        with pytest.raises(InputError, match=says):
            bundle.unbundle(forged, tmp_path / "run")


CHANGES = st.lists(
    st.tuples(st.floats(0, 1, exclude_max=True), st.integers(0, 255)), min_size=1, max_size=4
)


@settings(max_examples=60)
@given(CHANGES, st.booleans())
def test_any_change_of_bytes_is_refused_or_makes_no_difference(
    file: Path, changes: list[tuple[float, int]], late: bool
) -> None:
    """Whatever is read of a changed bundle has the content of the bundle, since checksums hold."""
    content = bytearray(file.read_bytes())
    # Headers at the end are a small share of a bundle.
    first = content.index(CENTRAL) if late else 0
    for share, value in changes:
        content[first + int(share * (len(content) - first))] = value
    with tempfile.TemporaryDirectory() as folder:
        changed, out = Path(folder, "changed.zip"), Path(folder, "run")
        changed.write_bytes(content)
        try:
            bundle.unbundle(changed, out)
        except InputError:
            assert os.listdir(folder) == ["changed.zip"]
            return
        (out / "versions.json").unlink()  # it has no checksum
        held = {f"run/{Path(path).relative_to(out)}": each for path, each in contents(out).items()}
        whole = {entry.filename: each for entry, each in entries(file)}
        del whole["run/versions.json"]
        assert held == whole
