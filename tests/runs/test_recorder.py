"""Records: every event is in exactly one segment or tail, in tables that any reader can open."""

import signal
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

import primordia
from primordia.law.world import Cause
from primordia.runs import loop, recorder
from primordia.runs.archive import Archive
from primordia.runs.digest import row_hashes
from primordia.runs.schema import TABLES
from tests.worlds import MILLS, Lived, config

TICKS = 900
WORDS = st.integers(0, 2**32 - 1)


@pytest.fixture(scope="module")
def lived() -> Lived:
    """Live the same worlds in memory, with the events as the law gave them."""
    return Lived(config(MILLS), TICKS)


def recorded(run: Path, interrupted_after: int = TICKS) -> primordia.Run:
    """Live a run to the same tick, or interrupt it after another one."""

    def press(status: loop.Status) -> None:
        status.engine.longest = 100  # however fast the machine is
        if int(status.engine.state.world.worlds.tick.lo[0]) > interrupted_after:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt) if interrupted_after < TICKS else nullcontext():
        loop.start(config(MILLS, stop={"ticks": TICKS}), run, listen=press)
    return primordia.Run(run)


def assert_all_rows(run: primordia.Run, lived: Lived) -> None:
    for name in TABLES:
        expected, actual = lived.table(name), run.table(name)
        assert actual.num_rows > 0
        for column, values in expected.items():
            got = actual[column].to_numpy(zero_copy_only=False)
            np.testing.assert_array_equal(got, values, err_msg=f"{name}.{column}")
    assert [world["digest"] for world in run.info()["worlds"]] == lived.digests()


def segments(run: Path, name: str) -> list[int]:
    """Return the number of rows of each segment on disk, in order."""
    return [pq.read_metadata(path).num_rows for path in sorted((run / name).iterdir())]


@pytest.mark.parametrize("size", [50, 2**20])
def test_tails_and_segments_together_hold_every_row(
    lived: Lived, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    monkeypatch.setattr(recorder, "SEGMENT_ROWS", size)
    run = recorded(tmp_path / "run", interrupted_after=TICKS // 3)
    arrays = Archive(run.path).state
    for name in TABLES:
        tail, closed = len(arrays[f"tail.{name}"]), segments(run.path, name)
        assert run.table(name).num_rows == sum(closed) + tail
        assert tail < size
    assert bool(segments(run.path, "births")) == (size == 50)
    assert len(arrays["tail.births"]) > 0
    some = run.table("births")
    assert run.resume() == []
    assert_all_rows(run, lived)
    assert run.table("births").slice(0, some.num_rows).equals(some)


CLIMATE = [
    "replication", "hazard",
    *(f"mutation.blocks.{block}.{each}" for each in ("probability", "scale")
      for block in ("input", "recurrent", "output")),
    *(f"metabolism.{name}" for name in ("store", "drain", "gain", "effort_cost", "cap")),
]  # fmt: skip
WORD = pa.dictionary(pa.int8(), pa.string())
SCHEMAS = {
    "births": {
        "world": pa.int32(), "id": pa.int64(), "parent": pa.int64(), "tick": pa.int64(),
        "cell": pa.int32(), "cause": WORD,
    },
    "deaths": {
        "world": pa.int32(), "id": pa.int64(), "tick": pa.int64(), "cell": pa.int32(),
        "cause": WORD, "energy": pa.float64(), "food": pa.float64(),
    },
    "metrics": {
        "world": pa.int32(), "tick": pa.int64(), "population": pa.int32(), "births": pa.int64(),
        **{f"deaths_{cause.name.lower()}": pa.int64() for cause in Cause},
        "extinctions": pa.int64(), "organism_ticks": pa.int64(), "oldest_age": pa.int64(),
        "mean_age": pa.float64(), "mean_energy": pa.float64(), "food": pa.float64(),
        **dict.fromkeys(CLIMATE, pa.float32()),
    },
}  # fmt: skip


def test_files_are_plain_parquet(lived: Lived, tmp_path: Path) -> None:
    run = recorded(tmp_path / "run")
    assert_all_rows(run, lived)
    for name, columns in SCHEMAS.items():
        files = sorted((run.path / name).iterdir())
        assert [file.name for file in files] == ["000000.parquet"]
        schema = pq.read_schema(files[0])
        assert dict(zip(schema.names, schema.types, strict=True)) == columns
        assert run.table(name).schema.equals(schema)
    births, deaths = (pq.read_table(run.path / name)["cause"] for name in ("births", "deaths"))
    assert {*births.to_pylist()} == {"founder", "copy", "mutant"}
    assert {*deaths.to_pylist()} <= {"fatal", "starved", "hazard", "replaced"}


@given(st.integers(0, 5), st.integers(0, 2), WORDS, st.integers(1, 2**32 - 1))
def test_any_changed_word_changes_its_rows_hash_and_no_other(
    row: int, field: int, word: int, change: int
) -> None:
    before = np.full((6, 3), word, np.uint32)
    after = before.copy()
    after[row, field] ^= np.uint32(change)
    differs = row_hashes(before) != row_hashes(after)
    assert differs[row].all(), "in both of its words"
    assert differs.sum() == 2


def test_swapped_words_and_rows_have_other_hashes() -> None:
    row = np.array([[1, 2, 3]], np.uint32)
    assert (row_hashes(row) != row_hashes(row[:, ::-1])).all()
    assert (row_hashes(row) != row_hashes(row[:, :2])).all()
    many = np.arange(300_000, dtype=np.uint32).reshape(-1, 3)
    assert len(np.unique(row_hashes(many), axis=0)) == len(many)
