"""Odd and forged run directories: every command takes them or says in one line why it does not.

A forger can compute checksums, so most changes here are sealed again. Nothing outside the run is written,
and what cannot be read is left as it is.
"""

import json
import os
import random
import shutil
import tomllib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import tomli_w

from primordia.runs import loop
from tests.commands import here, watched
from tests.trouble import Arrays, newest, reseal, rewrite
from tests.worlds import HERD, config

COMMANDS = [
    ["info", "{run}"],
    ["info", "{run}", "--json"],
    ["plot", "{run}", "--out", "{new}"],
    ["report", "{run}", "--out", "{new}.html"],
    ["export", "{run}", "{new}"],
    ["phylogeny", "{run}", "--extant", "--out", "{new}.csv"],
    ["compare", "{run}", "{twin}", "--out", "{new}"],
    ["verify", "{run}"],
    ["resume", "{run}", "--ticks", "170", "--quiet"],
    ["fork", "{run}", "--at", "60", "--out", "{new}", "--quiet"],
    ["evaluate", "{run}", "--games", "1", "--ticks", "10"],
    ["relive", "{run}", "3", "--world", "1", "--save", "{new}.npz"],
    ["bundle", "{run}", "{new}"],
    ["film", "{run}", "--out", "{new}.mp4", "--to", "20"],
    ["ancestors", "{run}"],
    ["lineages", "{run}"],
    ["track", "{run}", "--tensorboard", "{new}"],
    ["replay", "{run}", "--to", "5", "--out", "{new}.mp4"],
    ["shadow", "{run}", "--organisms", "4", "--ticks", "20"],
    ["assay", "heredity", "{run}"],
    ["assay", "threshold", "{run}"],
    ["assay", "line", "{run}", "--ticks", "20"],
]

ODD: list[Any] = [
    *(0, -1, 2**30, 2**31, 2**53 - 1, 2**62, 2**63, 2**64, 10**400),
    *(0.5, -0.0, 5e-324, 1e308, float("nan"), float("inf")),
    *(None, True, "", "x", "\x1b[31m\0", "²", [], {}, [[]], {"a": 1}, ["x"] * 3),
]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a folder with a run of closed segments and an open tail, its fork, and a twin."""
    folder = tmp_path_factory.mktemp("forged")
    settings = config(HERD, replication=0.2, hazard=0.05, stop={"ticks": 120})
    for name in ("run", "twin"):
        loop.start(settings, folder / name)
    done = here("fork", folder / "run", "--at", 50, "--out", folder / "fork", "--quiet")
    assert done.returncode == 0, done.stderr
    return folder


Change = Callable[[random.Random, Path], None]


def some_file(draw: random.Random, run: Path) -> Path:
    return draw.choice(sorted(path for path in run.rglob("*") if path.is_file()))


def bytes_changed(draw: random.Random, run: Path) -> None:
    path = some_file(draw, run)
    data = bytearray(path.read_bytes())
    for _ in range(draw.randint(1, 3)):
        start = draw.randrange(len(data) + 1)
        data[start : start + draw.randint(0, 9)] = draw.randbytes(draw.randint(0, 9))
    path.write_bytes(data[: draw.choice([len(data), draw.randint(0, len(data))])])


def replaced(draw: random.Random, run: Path) -> None:
    """A file or folder becomes something else of the same name, or goes."""
    path = draw.choice(sorted(path for path in run.rglob("*")))
    outside = run.parent / "outside"
    shutil.rmtree(path) if path.is_dir() else path.unlink()
    kind = draw.choice(["nothing", "folder", "pipe", "loop", "link", "empty"])
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "loop":
        path.symlink_to(path.name)
    elif kind == "link":
        path.symlink_to(outside)
    elif kind == "empty":
        path.write_bytes(b"")


def renamed(draw: random.Random, run: Path) -> None:
    """A file or folder has another name, or one more has an odd name."""
    path = draw.choice(sorted(path for path in run.rglob("*")))
    name = draw.choice(["²", "٣", "000099", "-1", "0" * 200, "1e5", "000000.parquet", "\x1b[2J"])
    if draw.random() < 0.5:
        path.rename(path.with_name(name))
    elif not path.with_name(name).exists():
        copy = shutil.copytree if path.is_dir() else shutil.copy
        copy(path, path.with_name(name))


def nested(draw: random.Random, tree: Any) -> None:
    """Change one value somewhere in nested tables and lists, its kind included."""
    while True:
        keys = list(tree) if isinstance(tree, dict) else list(range(len(tree)))
        if not keys:
            return
        key = draw.choice(keys)
        if not isinstance(tree[key], dict | list) or draw.random() < 0.2:
            break
        tree = tree[key]
    how = draw.random()
    if how < 0.2:
        del tree[key]
    elif how < 0.3 and isinstance(tree, dict):
        tree[draw.choice(["x", "²", "name"])] = tree.pop(key)
    elif how < 0.35:
        tree[key] = json.loads("[" * 60 + "]" * 60)
    else:
        tree[key] = draw.choice(ODD)


def values_changed(draw: random.Random, run: Path) -> None:
    path = run / draw.choice(["versions.json", "description.json", "config.toml"])
    toml, text = path.suffix == ".toml", path.read_text()
    values = tomllib.loads(text) if toml else json.loads(text)
    nested(draw, values)
    path.write_text(tomli_w.dumps(values) if toml else json.dumps(values))
    reseal(newest(run))


def manifest_changed(draw: random.Random, run: Path) -> None:
    reseal(newest(run), lambda content: nested(draw, content))


def arrays_changed(draw: random.Random, run: Path) -> None:
    def change(arrays: Arrays) -> None:
        name = draw.choice(sorted(arrays))
        array = arrays.pop(name)
        most = np.iinfo(array.dtype).max if array.dtype.kind in "iu" else 1
        changed = draw.choice([
            array[:-1],
            array[None],
            array.astype(np.float64),
            array.astype(np.int8),
            np.zeros((0,), array.dtype),
            np.array("text"),
            np.full_like(array, most),
            draw_bits(draw, array),
        ])  # fmt: skip
        if draw.random() < 0.85:
            arrays[name if draw.random() < 0.9 else "other"] = changed

    rewrite(draw.choice([newest(run), *run.glob("origin")]), change)


def draw_bits(draw: random.Random, array: np.ndarray) -> np.ndarray:
    if array.dtype == bool:
        return ~array
    return np.frombuffer(draw.randbytes(array.nbytes), array.dtype).reshape(array.shape)


def table_changed(draw: random.Random, run: Path) -> None:
    path = draw.choice(sorted(run.glob("*/*.parquet")))
    table = pq.read_table(path)
    name = draw.choice(table.column_names)
    at = table.column_names.index(name)
    column = table[name].to_pylist()
    how = draw.randrange(6)
    if how == 0:
        table = table.remove_column(at)
    elif how == 1:
        table = table.slice(draw.randint(0, 3))
    elif how == 2:
        table = table.rename_columns(
            ["other" if each == name else each for each in table.column_names]
        )
    elif how == 3 and column:
        table = table.set_column(at, name, pa.array([str(each) for each in column]))
    elif column and not isinstance(column[0], str):
        column[draw.randrange(len(column))] = draw.choice([None, 0, -1, 3, 2**31 - 1, -(2**31)])
        changed = pa.array(column, table.schema.field(name).type, from_pandas=True)
        table = table.set_column(at, name, changed)
    pq.write_table(table, path)
    reseal(newest(run))


CHANGES: list[Change] = [
    bytes_changed,
    replaced,
    renamed,
    values_changed,
    manifest_changed,
    arrays_changed,
    table_changed,
]


def forged(made: Path, folder: Path, seed: int) -> tuple[Path, list[str]]:
    """Return a changed run, and the words of a command."""
    draw = random.Random(seed)
    run = folder / "run"
    shutil.copytree(made / draw.choice(["run", "run", "fork"]), run)
    (folder / "outside").mkdir()
    (folder / "outside" / "precious").write_text("kept")
    change = CHANGES[seed % len(CHANGES)]
    for _ in range(draw.choice([1, 1, 1, 2])):
        # The second change may meet what the first has broken, or a number that its column cannot hold.
        with suppress(AttributeError, KeyError, OSError, TypeError, ValueError):
            change(draw, run)
    command = draw.choice(COMMANDS)
    places = {"run": run, "twin": made / "twin", "new": folder / "new"}
    return run, [word.format(**places) for word in command]


def tried(made: Path, folder: Path, seed: int) -> int:
    """Change a run, execute a command on it -> its exit status."""
    _, words = forged(made, folder, seed)
    with watched():
        done = here(*words)
    about = f"seed {seed}, {' '.join(words)}: {done.stderr}"
    assert done.returncode in (0, 1, 2), about
    assert "Traceback" not in done.stderr, about
    if done.returncode:
        assert len(done.stderr.strip().splitlines()) == 1, about
        assert done.stderr.startswith("primordia: "), about
    assert (folder / "outside" / "precious").read_text() == "kept", about
    assert os.listdir(folder / "outside") == ["precious"], about
    return done.returncode


SEEDS = (35, 1, 23, 10, 18, 5, 34)
"""Seeds of one run for each kind of change, with commands that compile nothing."""


@pytest.mark.parametrize("seed", SEEDS)
def test_a_forged_run_is_read_or_refused(made: Path, tmp_path: Path, seed: int) -> None:
    tried(made, tmp_path, seed)


@pytest.mark.slow
def test_two_thousand_forged_runs_are_read_or_refused(made: Path, tmp_path: Path) -> None:
    statuses = set()
    for seed in range(2000):
        (tmp_path / str(seed)).mkdir()
        statuses.add(tried(made, tmp_path / str(seed), seed))
        shutil.rmtree(tmp_path / str(seed))
    assert statuses == {0, 1, 2}
