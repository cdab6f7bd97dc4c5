"""Tables of invented events: units of numbers, segments of full length, and digests."""

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from primordia.errors import InputError, Trouble
from primordia.law.events import Events, Rows
from primordia.law.world import BirthCause, Cause
from primordia.runs import digest, recorder, segment
from primordia.runs.digest import digests, row_hashes
from primordia.runs.recorder import Recorder
from primordia.runs.schema import TABLES, Schema
from tests.worlds import MEADOW, config

CELLS = 10
SCHEMA = Schema(CELLS, mates=True, notes=("step",), rates=("hazard",), tallies=("score_mean",))
BIG = 2**40 + 7
"""A number that needs both of its words."""


def births_of(worlds: list[int]) -> np.ndarray:
    """Return a birth in each of the worlds, numbered from 1, each a child of the organism before."""
    n = np.arange(1, len(worlds) + 1)
    return SCHEMA.columns("births").rows(
        cell=np.array(worlds) * CELLS + n % CELLS,
        id=BIG + n,
        parent=BIG + n - 1,
        tick=2 * BIG + n,
        cause=n % 3,
        mate=n - 3,
        step=-n,
    )


def test_births_have_world_cell_and_cause_and_minus_one_is_no_mate_or_parent() -> None:
    rows = births_of([0, 2, 1])
    rows[0] = SCHEMA.columns("births").rows(
        cell=np.array([9]), id=np.array([0]), parent=np.array([-1]), tick=np.array([0]),
        cause=np.array([0]), mate=np.array([-1]), step=np.array([0]),
    )[0]  # fmt: skip
    assert SCHEMA.arrow("births", rows).to_pydict() == {
        "world": [0, 2, 1],
        "id": [0, BIG + 2, BIG + 3],
        "parent": [None, BIG + 1, BIG + 2],
        "tick": [0, 2 * BIG + 2, 2 * BIG + 3],
        "cell": [9, 2, 3],
        "cause": [BirthCause(n).label for n in (0, 2, 0)],
        "mate": [None, None, 0],
        "step": [0, -2, -3],
    }
    assert SCHEMA.within_world("births", rows)[:, 0].tolist() == [9, 2, 3]


def test_deaths_have_energy_and_food_in_points_and_signed_tallies() -> None:
    rows = SCHEMA.columns("deaths").rows(
        cell=np.array([3, 25]), id=np.array([1, BIG]), tick=np.array([5, 2 * BIG]),
        cause=np.array([1, 2]), energy=np.array([-512, 3072]), food=np.array([1536, -1024]),
        score_mean=np.array([-9, 2**31 - 1]),
    )  # fmt: skip
    assert SCHEMA.arrow("deaths", rows).to_pydict() == {
        "world": [0, 2],
        "id": [1, BIG],
        "tick": [5, 2 * BIG],
        "cell": [3, 5],
        "cause": [Cause(1).label, Cause(2).label],
        "energy": [-0.5, 3.0],
        "food": [1.5, -1.0],
        "score_mean": [-9, 2**31 - 1],
    }


def test_samples_are_totals_and_means_of_the_living() -> None:
    """One organism lives in the second world. The third one is extinct: its means are 0."""
    columns = SCHEMA.columns("metrics")
    given: dict[str, Any] = {
        "world": [1, 2, 0], "population": [4, 1, 0], "age_total": [10, 7, 0],
        "energy_total": [-6 * 1024, 1024, 0], "food_total": [2560, -512, 0],
        "hazard": np.array([0.25, 1.5, 0], np.float32).view(np.int32),
        "score_mean_mean": np.array([-2.5, 0.75, 0], np.float32).view(np.int32),
        "score_mean_best": [-7, 8, 0],
    }  # fmt: skip
    totals = ["tick", "births", "extinctions", "organism_ticks", "oldest_age"]
    totals += [f"deaths_{cause.name.lower()}" for cause in Cause]
    expected = {name: [100 + place, BIG + place, 0] for place, name in enumerate(totals)}
    rows = columns.rows(**{name: np.array((given | expected)[name]) for name in columns.names})
    assert SCHEMA.arrow("metrics", rows).to_pydict() == expected | {
        "world": [1, 2, 0],
        "population": [4, 1, 0],
        "mean_age": [2.5, 7.0, 0.0],
        "mean_energy": [-1.5, 1.0, 0.0],
        "food": [2.5, -0.5, 0.0],
        "hazard": [0.25, 1.5, 0.0],
        "score_mean_mean": [-2.5, 0.75, 0.0],
        "score_mean_best": [-7, 8, 0],
    }
    assert SCHEMA.world_of("metrics", rows).tolist() == [1, 2, 0]
    assert SCHEMA.within_world("metrics", rows)[:, 0].tolist() == [0, 0, 0]


@pytest.mark.parametrize(
    ("names", "table", "column"),
    [
        ({"notes": ("mate",)}, "births", "mate"),
        ({"notes": ("a", "b", "a")}, "births", "a"),
        ({"tallies": ("cause",)}, "deaths", "cause"),
        ({"rates": ("score_best",), "tallies": ("score",)}, "metrics", "score_best"),
        ({"notes": ("food",), "rates": ("hazard",), "tallies": ("hazard", "deaths")}, None, None),
    ],
)
def test_no_table_has_two_columns_of_a_name(
    names: dict[str, Any], table: str | None, column: str | None
) -> None:
    """The same name in two tables, or of a rate and a tally whose columns differ, is allowed."""
    given: dict[str, Any] = {"notes": (), "rates": (), "tallies": (), **names}
    if table is None:
        Schema(CELLS, mates=False, **given)
        return
    with pytest.raises(InputError, match=f"the table {table} would have two columns '{column}'"):
        Schema(CELLS, mates=False, **given)


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A run's folders, with segments of at most five rows."""
    monkeypatch.setattr(recorder, "SEGMENT_ROWS", 5)
    for name in TABLES:
        (tmp_path / name).mkdir()
    return tmp_path


@pytest.mark.parametrize("parts", [[4], [5, 5], [4, 2], [2, 14, 1]])
def test_a_segment_is_closed_once_it_is_full(run: Path, parts: list[int]) -> None:
    """Parts of rows have any size. A part may fill several segments, or one exactly."""
    recorder, rows = Recorder(run, 3, SCHEMA), births_of([n % 3 for n in range(sum(parts))])
    for end, count in zip(np.cumsum(parts), parts, strict=True):
        recorder.add("births", rows[end - count : end])
        assert len(recorder.tables[0].segments) == end // 5
        assert len(recorder.tails()["tail.births"]) == end % 5
    full, rest = divmod(sum(parts), 5)
    for _ in range(2):  # the second time the tail is empty and needs no segment
        recorder.finish()
    segments = recorder.tables[0].segments
    assert [each.rows for each in segments] == [5] * full + [rest] * (rest > 0)
    files = [run / "births" / f"{number:06d}.parquet" for number in range(len(segments))]
    assert [each.name for each in segments] == [file.name for file in files]
    assert [each.bytes for each in segments] == [file.stat().st_size for file in files]
    stored = [pq.read_table(file) for file in files]
    assert [each.num_rows for each in stored] == [each.rows for each in segments]
    assert pa.concat_tables(stored).equals(SCHEMA.arrow("births", rows))
    assert not [*(run / "deaths").iterdir(), *(run / "metrics").iterdir()]
    assert not any(map(len, recorder.tails().values()))


def test_birth_numbers_and_ticks_are_stored_as_differences(run: Path) -> None:
    recorder = Recorder(run, 1, SCHEMA)
    recorder.add("births", births_of([0] * 5))
    stored = pq.ParquetFile(run / "births" / "000000.parquet").metadata.row_group(0)
    encodings = {
        column.path_in_schema: set(column.encodings)
        for column in map(stored.column, range(stored.num_columns))
    }
    for name in ("id", "parent", "tick"):
        assert "DELTA_BINARY_PACKED" in encodings[name]
    for name in ("world", "cell", "cause"):
        assert "RLE_DICTIONARY" in encodings[name]


def test_a_resumed_recorder_goes_on_with_the_tail_and_the_next_number(run: Path) -> None:
    rows = births_of([n % 3 for n in range(13)])
    through, first = Recorder(run, 3, SCHEMA), Recorder(None, 3, SCHEMA)
    first.add("births", rows)
    through.add("births", rows[:7])
    segments = {table.name: list(table.segments) for table in through.tables}
    before = {name: sums.copy() for name, sums in through.digests().items()}
    again = Recorder(run, 3, SCHEMA)
    again.resume(segments, before, through.tails())
    again.add("births", rows[7:])
    assert [each.name for each in again.tables[0].segments] == ["000000.parquet", "000001.parquet"]
    assert [each.rows for each in segments["births"]] == [5], "a checkpoint's list does not grow"
    np.testing.assert_array_equal(again.tails()["tail.births"], rows[10:])
    for name in TABLES:
        np.testing.assert_array_equal(again.digests()[name], first.digests()[name])


def test_the_digest_of_a_table_sums_its_rows_of_each_world() -> None:
    """Each row counts as of world 0, so a world has the same digest in every run."""
    worlds = [2, 0, 2, 2]
    rows, recorder = births_of(worlds), Recorder(None, 3, SCHEMA)
    filled = np.concatenate([rows, births_of([1, 1])])
    nothing = [Rows(np.zeros((3, SCHEMA.columns(name).width), np.uint32), 0) for name in TABLES[1:]]
    recorder.append(Events(Rows(filled, 4), *nothing))
    expected = np.zeros((3, 2), np.uint64)
    for world, row in zip(worlds, rows, strict=True):
        own = row.copy()
        own[0] %= CELLS
        expected[world] += row_hashes(own[None])[0]
    np.testing.assert_array_equal(recorder.digests()["births"], expected)
    assert not recorder.digests()["deaths"].any()
    assert not len(recorder.tails()["tail.births"]), "only digests are kept without a directory"


@pytest.mark.parametrize("block", [1, 3, 5])
def test_the_digest_of_a_state_does_not_depend_on_blocks_or_tails(
    monkeypatch: pytest.MonkeyPatch, block: int
) -> None:
    alive = np.array([1, 0, 1, 1, 0, 0, 0, 1, 1, 1], bool)
    arrays = {"world.organisms.alive": alive, "world.organisms.energy": np.arange(10) * 3,
              "world.worlds.tick.lo": np.array([4, 5]), "tail.births": np.zeros((1, 2))}  # fmt: skip
    records = {name: np.arange(4, dtype=np.uint64).reshape(2, 2) for name in TABLES}
    islands = config(MEADOW, cells=5).islands
    whole = digests(records, arrays, 2, islands)
    monkeypatch.setattr(digest, "BLOCK", block)
    assert digests(records, {**arrays, "tail.births": np.ones((2, 2))}, 2, islands) == whole


DEATHS = pa.schema([("world", pa.int32()), ("id", pa.int64()), ("mate", pa.int64())])
OTHER = "its columns are not those of this table"


@pytest.mark.parametrize(
    ("names", "columns", "fault"),
    [
        (["world", "id"], [[0, 1], [1, 2]], OTHER),
        (["world", "id", "mate"], [[0, 1], [1.0, 2.0], [1, 2]], OTHER),
        (["world", "id", "mate", "x"], [[0, 1], [1, 2], [1, 2], [1, 2]], OTHER),
        (["world", "id", "mate", "mate"], [[0, 1], [1, 2], [1, 2], [1, 2]], OTHER),
        (["world", "id", "mate"], [[0], [1], [1]], "it has 1 rows instead of 2"),
        (["world", "id", "mate"], [[0, 1, 2], [1, 2, 3], [1, 2, 3]], "it has 3 rows instead of 2"),
    ],
)
def test_a_segment_with_other_columns_or_rows_is_damage(
    names: list[str], columns: list[list], fault: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.parquet"
    arrays = [pa.array(columns[0], pa.int32()), *map(pa.array, columns[1:])]
    pq.write_table(pa.Table.from_arrays(arrays, names=names), path)
    with pytest.raises(Trouble, match=f"^{path} is damaged: {fault}"):
        segment.read(path, 2, DEATHS, None)


@pytest.mark.parametrize("table", TABLES)
def test_only_a_parent_and_a_mate_may_be_missing(table: str, tmp_path: Path) -> None:
    """Columns are read in the wanted order."""
    path = tmp_path / "a.parquet"
    whole = SCHEMA.arrow(table, np.ones((2, SCHEMA.columns(table).width), np.uint32))
    for number, field in enumerate(whole.schema):
        missing = pa.array([None, whole[field.name][1].as_py()], field.type)
        pq.write_table(whole.set_column(number, field, missing), path)
        if field.name in ("parent", "mate"):
            assert segment.read(path, 2, whole.schema, None)[field.name].null_count == 1
            for some in ([field.name, "world"], ["world", field.name]):
                assert segment.read(path, 2, whole.schema, some).column_names == some
        else:
            with pytest.raises(Trouble, match="values are missing"):
                segment.read(path, 2, whole.schema, None)
