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

CELLS = 10
SCHEMA = Schema(CELLS, mates=True, notes=("step",), rates=("hazard",), tallies=("score",))
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
    assert SCHEMA.world_of("births", rows).tolist() == [0, 2, 1]
    assert SCHEMA.within_world("births", rows)[:, 0].tolist() == [9, 2, 3]


def test_deaths_have_energy_and_food_in_points_and_signed_tallies() -> None:
    rows = SCHEMA.columns("deaths").rows(
        cell=np.array([3, 25]), id=np.array([1, BIG]), tick=np.array([5, 2 * BIG]),
        cause=np.array([1, 2]), energy=np.array([-512, 3072]), food=np.array([1536, -1024]),
        score=np.array([-9, 2**31 - 1]),
    )  # fmt: skip
    assert SCHEMA.arrow("deaths", rows).to_pydict() == {
        "world": [0, 2],
        "id": [1, BIG],
        "tick": [5, 2 * BIG],
        "cell": [3, 5],
        "cause": [Cause(1).label, Cause(2).label],
        "energy": [-0.5, 3.0],
        "food": [1.5, -1.0],
        "score": [-9, 2**31 - 1],
    }


def samples_of(**values: list[int]) -> np.ndarray:
    columns = SCHEMA.columns("metrics")
    order = {name: number for number, name in enumerate(columns.names)}
    return columns.rows(**{
        name: np.array(values.get(name, [100 + order[name], BIG + order[name]]))
        for name in columns.names
    })  # fmt: skip


def test_samples_are_totals_and_means_of_the_living() -> None:
    """The second world is extinct: its means are 0."""
    bits = np.array([0.25, 1.5], np.float32).view(np.int32).tolist()
    mean = np.array([-2.5, 0.75], np.float32).view(np.int32).tolist()
    rows = samples_of(
        world=[1, 2], population=[4, 0], age_total=[10, 0], energy_total=[-6 * 1024, 0],
        food_total=[2560, -512], hazard=bits, score_mean=mean, score_best=[-7, 8],
    )  # fmt: skip
    table = SCHEMA.arrow("metrics", rows).to_pydict()
    columns = SCHEMA.columns("metrics").names
    totals = ["tick", "births", "extinctions", "organism_ticks", "oldest_age"]
    totals += [f"deaths_{cause.name.lower()}" for cause in Cause]
    for name in totals:
        assert table.pop(name) == [100 + columns.index(name), BIG + columns.index(name)], name
    assert table == {
        "world": [1, 2],
        "population": [4, 0],
        "mean_age": [2.5, 0.0],
        "mean_energy": [-1.5, 0.0],
        "food": [2.5, -0.5],
        "hazard": [0.25, 1.5],
        "score_mean": [-2.5, 0.75],
        "score_best": [-7, 8],
    }
    assert SCHEMA.world_of("metrics", rows).tolist() == [1, 2]
    assert SCHEMA.within_world("metrics", rows)[:, 0].tolist() == [0, 0]


@pytest.mark.parametrize("population", [1, 2, 3])
def test_the_means_of_a_sample_are_over_all_its_organisms(population: int) -> None:
    rows = samples_of(population=[population, 0], age_total=[12, 0], energy_total=[18 * 1024, 0])
    table = SCHEMA.arrow("metrics", rows).to_pydict()
    assert table["mean_age"] == [12 / population, 0.0]
    assert table["mean_energy"] == [18 / population, 0.0]


def test_a_tally_may_be_called_a_mean() -> None:
    """Its best is an integer, and its mean is not."""
    schema = Schema(CELLS, mates=False, notes=(), rates=(), tallies=("score_mean", "b"))
    own = {"score_mean_best": -7, "b_best": 5}
    own |= {name: np.float32(2.5).view(np.int32).item() for name in ("score_mean_mean", "b_mean")}
    columns = schema.columns("metrics")
    rows = columns.rows(**{name: np.array([own.get(name, 0)]) for name in columns.names})
    table = schema.arrow("metrics", rows).to_pydict()
    assert [table[name] for name in ("score_mean_mean", "score_mean_best")] == [[2.5], [-7]]
    assert [table[name] for name in ("b_mean", "b_best")] == [[2.5], [5]]


@pytest.mark.parametrize(
    ("names", "table", "column"),
    [
        ({"notes": ("mate",)}, "births", "mate"),
        ({"notes": ("a", "b", "a")}, "births", "a"),
        ({"tallies": ("cause",)}, "deaths", "cause"),
        ({"tallies": ("energy_total", "deaths")}, None, None),
        ({"rates": ("mean_age",)}, "metrics", "mean_age"),
        ({"rates": ("score_best",), "tallies": ("score",)}, "metrics", "score_best"),
        ({"notes": ("food",), "tallies": ("parent",)}, None, None),
        ({"rates": ("hazard",), "tallies": ("hazard",)}, None, None),
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


@pytest.mark.parametrize("parts", [[4], [5], [6], [3, 2], [4, 2], [10], [11], [2, 14, 1], [5, 5]])
def test_a_segment_is_closed_once_it_is_full(run: Path, parts: list[int]) -> None:
    """Parts of rows have any size. A part may fill several segments, or one exactly."""
    recorder, rows = Recorder(run, 3, SCHEMA), births_of([n % 3 for n in range(sum(parts))])
    for end, count in zip(np.cumsum(parts), parts, strict=True):
        recorder.add("births", rows[end - count : end])
        assert len(recorder.tables[0].segments) == end // 5
        assert len(recorder.tails()["tail.births"]) == end % 5
    full, rest = divmod(sum(parts), 5)
    recorder.finish()
    table = recorder.tables[0]
    assert [each.rows for each in table.segments] == [5] * full + [rest] * (rest > 0)
    assert [each.name for each in table.segments] == [
        f"{number:06d}.parquet" for number in range(len(table.segments))
    ]
    stored = [pq.read_table(run / "births" / each.name) for each in table.segments]
    assert pa.concat_tables(stored).equals(SCHEMA.arrow("births", rows))
    for each, sealed in zip(stored, table.segments, strict=True):
        assert each.num_rows == sealed.rows
        assert (run / "births" / sealed.name).stat().st_size == sealed.bytes
    recorder.finish()
    assert len(table.segments) == len(stored), "an empty tail needs no segment"
    assert not [*(run / "deaths").iterdir(), *(run / "metrics").iterdir()]
    assert {name: len(tail) for name, tail in recorder.tails().items()} == {
        f"tail.{name}": 0 for name in TABLES
    }


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


@pytest.mark.parametrize("block", [1, 2, 3, 4, 5, 7])
def test_the_digest_of_a_state_does_not_depend_on_blocks(
    monkeypatch: pytest.MonkeyPatch, block: int
) -> None:
    alive = np.array([1, 0, 1, 1, 0, 0, 0, 1, 1, 1], bool)
    arrays = {"world.organisms.alive": alive, "world.organisms.energy": np.arange(10) * 3,
              "world.worlds.tick.lo": np.array([4, 5]), "tail.births": np.zeros((1, 2))}  # fmt: skip
    records = {name: np.arange(4, dtype=np.uint64).reshape(2, 2) for name in TABLES}
    whole = digests(records, arrays, 2)
    monkeypatch.setattr(digest, "BLOCK", block)
    assert digests(records, arrays, 2) == whole
    assert digests(records, {**arrays, "tail.births": np.ones((2, 2))}, 2) == whole


DEATHS = pa.schema([("world", pa.int32()), ("id", pa.int64()), ("mate", pa.int64())])


@pytest.mark.parametrize(
    ("columns", "fault"),
    [
        ({"world": [0, 1], "id": [1, 2]}, "its columns are not those of this table"),
        ({"world": [0, 1], "id": [1.0, 2.0], "mate": [1, 2]}, "its columns are not those"),
        ({"world": [0, 1], "id": [1, 2], "mate": [1, 2], "x": [1, 2]}, "its columns are not those"),
        ({"world": [0], "id": [1], "mate": [1]}, "it has 1 rows instead of 2"),
        ({"world": [0, 1, 2], "id": [1, 2, 3], "mate": [1, 2, 3]}, "it has 3 rows instead of 2"),
        ({"world": [0, None], "id": [1, 2], "mate": [1, 2]}, "values are missing"),
        ({"world": [0, 1], "id": [None, 2], "mate": [1, 2]}, "values are missing"),
        ({"world": [0, 1], "id": [1, 2], "mate": [None, None]}, None),
    ],
)
def test_a_segment_has_the_columns_rows_and_values_of_its_table(
    columns: dict[str, list], fault: str | None, tmp_path: Path
) -> None:
    """Only a parent and a mate may be missing."""
    path = tmp_path / "a.parquet"
    table = pa.table({
        name: pa.array(values, pa.int32() if name == "world" else None if name == "id" else pa.int64())
        for name, values in columns.items()
    })  # fmt: skip
    pq.write_table(table, path)
    if fault is None:
        assert segment.read(path, 2, DEATHS, None).to_pydict() == columns
        for some in (["mate", "world"], ["world", "mate"]):
            assert segment.read(path, 2, DEATHS, some).column_names == some
        assert segment.read(path, 2, DEATHS, ["mate", "world"]).to_pydict() == {
            "mate": [None, None], "world": [0, 1]
        }  # fmt: skip
        return
    with pytest.raises(Trouble, match=f"^{path} is damaged: {fault}"):
        segment.read(path, 2, DEATHS, None)


def test_a_column_that_occurs_twice_is_damage(tmp_path: Path) -> None:
    path, numbers = tmp_path / "a.parquet", pa.array([1, 2])
    arrays = [pa.array([0, 1], pa.int32()), numbers, numbers, numbers]
    pq.write_table(pa.Table.from_arrays(arrays, names=["world", "id", "mate", "mate"]), path)
    with pytest.raises(Trouble, match="its columns are not those of this table"):
        segment.read(path, 2, DEATHS, None)


@pytest.mark.parametrize("table", TABLES)
def test_only_a_parent_and_a_mate_may_be_missing(table: str, tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    whole = SCHEMA.arrow(table, np.ones((2, SCHEMA.columns(table).width), np.uint32))
    for number, field in enumerate(whole.schema):
        missing = pa.array([None, whole[field.name][1].as_py()], field.type)
        pq.write_table(whole.set_column(number, field, missing), path)
        if field.name in ("parent", "mate"):
            assert segment.read(path, 2, whole.schema, None)[field.name].null_count == 1
        else:
            with pytest.raises(Trouble, match="values are missing"):
                segment.read(path, 2, whole.schema, None)
