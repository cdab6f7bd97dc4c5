"""Forged sizes: a small file that stands for gigabytes, and numbers that no run reaches."""

import json
import tomllib
import zipfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
import tomli_w

from primordia.runs import checkpoint
from primordia.runs.arrays import _sizes
from tests.commands import complains, here
from tests.trouble import newest, recount, reseal, rewrite

READING = ["info", "plot", "report", "film", "export", "ancestors", "lineages", "track"]
QUICK = {"info", "report", "ancestors"}


def tried(command: str, run: Path, folder: Path) -> Any:
    """Execute a reading command; its output, if there is one, is below `folder`."""
    out = folder / "out"
    words: dict[str, list[object]] = {
        "plot": ["--out", out],
        "report": ["--out", out.with_suffix(".html")],
        "film": ["--out", out.with_suffix(".mp4")],
        "export": [out],
        "track": ["--tensorboard", out],
    }
    return here(command, run, *words.get(command, []))


def described(run: Path, change: Callable[[dict[str, Any]], object]) -> None:
    """Change the description of a run, and seal it again."""
    path = run / "description.json"
    content = json.loads(path.read_text())
    change(content)
    path.write_text(json.dumps(content))
    reseal(newest(run))


def test_compressed_arrays_are_not_unpacked(run: Path) -> None:
    folder = newest(run)
    with np.load(folder / "state.npz") as stored:
        np.savez_compressed(folder / "state.npz", allow_pickle=False, **stored)
    reseal(folder)
    complains(here("info", run), 1, "state.npz is damaged")


def test_arrays_are_no_larger_than_their_file() -> None:
    """Entries of a zip may overlap, so that one content is read many times."""
    entries = [zipfile.ZipInfo(f"{name}.npy") for name in "abc"]
    for each in entries:
        each.file_size = 10
    archive: Any = SimpleNamespace(infolist=lambda: entries)
    assert _sizes(archive, 30) == {"a": 10, "b": 10, "c": 10}
    with pytest.raises(ValueError, match="larger than their file"):
        _sizes(archive, 29)
    for each in entries:  # one of several is enough
        each.compress_type = zipfile.ZIP_DEFLATED
        with pytest.raises(ValueError, match="compressed"):
            _sizes(archive, 30)
        each.compress_type = zipfile.ZIP_STORED


def test_rows_are_counted_before_they_are_read(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (path,) = (run / "births").iterdir()
    rows = pq.read_metadata(path).num_rows
    table = pq.read_table(path)
    pq.write_table(table.take([0] * (rows + 1)), path)
    reseal(newest(run))

    def read(*_: object, **__: object) -> None:
        pytest.fail("rows were read")

    monkeypatch.setattr(pq.ParquetFile, "read", read)
    complains(here("plot", run), 1, f"{path} is damaged: it has {rows + 1} rows instead of {rows}")


def test_a_segment_has_no_more_rows_than_a_writer_puts_into_one(run: Path) -> None:
    def change(content: dict[str, Any]) -> None:
        content["segments"]["births"][0]["rows"] = 2**20 + 1

    for folder in checkpoint.numbered(run):
        reseal(folder, change)
    complains(here("info", run), 1, "no checkpoint of", "manifest.json is missing or damaged")


@pytest.mark.parametrize("command", ["info", "export"])
@pytest.mark.parametrize("shape", [[2**30, 2**30], [2, 4, 32]])
def test_weights_that_the_state_does_not_hold_are_refused(
    command: str, shape: list[int], run: Path, tmp_path: Path
) -> None:
    described(run, lambda content: content["blocks"].update(input=shape))
    complains(tried(command, run, tmp_path), 1, "is not a checkpoint of this run", "too small")


@pytest.mark.parametrize(
    "command",
    [each if each in QUICK else pytest.param(each, marks=pytest.mark.slow) for each in READING],
)
def test_a_last_tick_that_no_run_reaches_breaks_no_figure(
    command: str, run: Path, tmp_path: Path
) -> None:
    rewrite(newest(run), partial(recount, name="tick", number=2**53 - 1))
    done = tried(command, run, tmp_path)
    assert done.returncode == 0 or len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert "Warning" not in done.stderr


@pytest.mark.parametrize("command", ["info", "plot"])
def test_settings_whose_numbers_do_not_fit_are_refused(
    command: str, run: Path, tmp_path: Path
) -> None:
    values = tomllib.loads((run / "config.toml").read_text())
    values["placement"] |= {"topology": "torus4", "rows": 3}
    (run / "config.toml").write_text(tomli_w.dumps(values))
    reseal(newest(run))
    complains(tried(command, run, tmp_path), 2, "8 cells do not make a torus")


@pytest.mark.parametrize("rate", [5e-324, 1e308, -1.0, 0.0])
def test_a_rate_of_ticks_is_within_bounds(rate: float, run: Path) -> None:
    described(run, lambda content: content.update(rate=rate))
    complains(here("info", run), 2, "description.json is missing or damaged")


def test_a_setting_at_the_beginning_fits_float32(run: Path) -> None:
    described(run, lambda content: content["beginning"].update(replication=1e308))
    complains(here("info", run), 2, "description.json is missing or damaged")


def test_a_column_has_a_name_of_its_own(run: Path) -> None:
    """`test_tables.py` has all kinds of names."""
    described(run, lambda content: content.update(notes=["cause"]))
    complains(here("info", run), 2, "the table births would have two columns 'cause'")
