"""The gallery: its commands are well-formed, and live the worlds again that it states."""

import tomllib
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from primordia import device
from tests.commands import HERE, here, well_formed

HOME = HERE / "docs" / "gallery"


@pytest.fixture(name="make")
def _make(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(HOME))
    return import_module("make")


ENTRIES: list[dict[str, Any]] = tomllib.loads((HOME / "gallery.toml").read_text("utf-8"))["entries"]


def test_the_page_is_made_of_the_table(make: ModuleType) -> None:
    assert (HOME / "README.md").read_text(encoding="utf-8") == make.page()
    assert {entry["name"] for entry in ENTRIES} == set(make.found()) - {"instruction set"}


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry["name"])
def test_the_commands_of_an_entry_are_well_formed(
    entry: dict[str, Any], make: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(HERE)
    for words in make.commands(entry):
        chosen = well_formed(*words)
        if words[0] == "run":
            assert chosen is not None
            assert chosen.stop.ticks is not None or chosen.stop.until is not None
        for flag, file in pairwise(words):
            assert flag != "--ancestor" or Path(file).exists()


@pytest.mark.slow
@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry["name"])
def test_an_entry_lives_as_it_did(
    entry: dict[str, Any], make: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if make.found()["instruction set"] != device.instruction_set():
        pytest.skip(f"the digests are of {make.found()['instruction set']}")
    monkeypatch.chdir(HERE)  # ancestors are named from there
    words = make.commands(entry)[0]
    done = here(*words[:-1], tmp_path / "run", "--quiet")
    assert done.returncode == 0, done.stderr
    assert make.outcome(tmp_path / "run", entry) == make.found()[entry["name"]]


def test_pictures_are_small(make: ModuleType) -> None:
    sizes = [(HOME / f"{entry['name']}.gif").stat().st_size for entry in ENTRIES]
    widths = [make.small(entry)["width"] for entry in ENTRIES]
    assert all(size < 1000 * width for size, width in zip(sizes, widths, strict=True))
    assert sum(sizes) < 3_500_000
