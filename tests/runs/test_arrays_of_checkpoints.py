"""Arrays of checkpoints: settings give the type and shape of each, and all bits are read back."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.errors import Trouble
from primordia.runs import arrays
from primordia.runs.arrays import Arrays, read_count, world_ticks
from primordia.runs.description import Description
from primordia.runs.records import Records
from primordia.runs.schema import Schema
from primordia.runs.shapes import Expected
from tests.synthetic import worlds_of
from tests.worlds import config

SETTINGS = config("CartPole-survival", seeds=2, cells=3, brain={"hidden": 4})
ABOUT = Description(
    rate=50.0, tallies=("score",), notes=("step", "way"), mates=True, moments=2,
    beginning={"hazard": 0.5}, blocks={"input": (4, 5), "output": (2,)},
)  # fmt: skip


def fitting() -> dict[str, np.ndarray]:
    """Return the arrays of two worlds with three cells each, written out by hand."""
    counts: dict[str, tuple[int, ...]] = {f"world.worlds.{name}": (2,) for name in (
        "seed", "tick", "births", "extinctions", "organism_ticks", "food", "saturated",
        "saturated_births", "fixed", "fixed_births")}  # fmt: skip
    counts |= {"world.worlds.deaths": (2, 7)}
    counts |= {f"world.worlds.looks.{name}": (2, 0) for name in ("food", "organism_ticks")}
    counts |= {f"world.organisms.{name}": (6,) for name in ("born", "number", "branch")}
    state = {
        f"{n}.{half}": np.zeros(c, np.uint32) for n, c in counts.items() for half in ("hi", "lo")
    }
    schema = Schema.described(3, ABOUT)
    for table in ("births", "deaths", "metrics"):
        state[f"tail.{table}"] = np.zeros((1, schema.columns(table).width), np.uint32)
    return state | {
        "world.worlds.looks.wait": np.ones((2, 0), np.int32),
        "world.worlds.calm": np.zeros(2, np.int32),
        "world.worlds.sample_wait": np.ones(2, np.int32),
        "world.worlds.climate.hazard": np.zeros(2, np.float32),
        "world.organisms.alive": np.zeros(6, bool),
        "world.organisms.genome.input": np.zeros((6, 4, 5), np.float32),
        "world.organisms.genome.output": np.zeros((6, 2), np.float32),
        "world.organisms.notes": np.zeros((6, 2), np.int32),
        "world.organisms.memory": np.zeros((6, 7), np.float32),
        "world.organisms.energy": np.zeros(6, np.int32),
        "world.organisms.eaten": np.zeros(6, np.int32),
        "world.organisms.moments.senses": np.zeros((6, 2, 8), np.float32),
        "world.organisms.moments.memory": np.zeros((6, 2, 8), np.float32),
        "world.organisms.moments.known": np.zeros((6, 2), bool),
        "bodies.tally": np.zeros((6, 1), np.int32),
        "bodies.other": np.zeros((6, 9), np.float64),
    }


FREE = ("bodies.other", "organisms.memory", "moments.senses", "moments.memory")
"""Ends of the names of arrays whose last axis may have any length."""


def test_each_array_has_one_type_and_one_row_for_each_world_or_cell() -> None:
    expected = Expected(SETTINGS, ABOUT)
    for name, array in fitting().items():
        assert expected.fault_of(name, array) is None
        odd = [] if name.startswith("tail.") else [np.concatenate([array, array]), array[:0]]
        if name != "bodies.other":
            odd += [array.astype(np.float64), array[..., None], array.astype(np.int8)]
        if array.ndim > 1 and array.size and not name.endswith(FREE):
            odd.append(array[..., :-1])
        if ".moments." in name:
            odd.append(array[:, :-1])
        for each in odd:
            fault = expected.fault_of(name, each)
            assert fault == f"{name} is {each.dtype} {each.shape}, which does not fit the settings"


def test_a_wait_below_the_least_is_a_fault() -> None:
    season = {"kind": "ratchet", "setting": "hazard", "when": "mean_age", "above": 1.0,
              "factor": 2.0, "every": 10}  # fmt: skip
    values = SETTINGS.model_dump() | {"seasons": [season]}
    expected = Expected(type(SETTINGS).model_validate(values), ABOUT)
    for name, least, shape in (("sample_wait", 1, 2), ("calm", 0, 2), ("looks.wait", 1, (2, 1))):
        for array, wrong in (([least, least], False), ([9, least - 1], True)):
            given = np.array(array, np.int32).reshape(shape)
            fault = expected.fault_of(f"world.worlds.{name}", given)
            assert fault == (f"world.worlds.{name} is below {least}" if wrong else None)


class Held(dict):
    """Arrays in memory, with the sizes that they take in a file."""

    def size(self, name: str) -> int:
        return self[name].nbytes


def test_a_state_has_all_arrays_and_no_count_that_is_too_large() -> None:
    expected, good = Expected(SETTINGS, ABOUT), fitting()
    assert expected.fault(Held(good)) is None
    for name in good:
        if not name.startswith("bodies"):
            lacking = Held({each: array for each, array in good.items() if each != name})
            assert expected.fault(lacking) == f"there is no array {name}"
    assert expected.fault(Held(good, other=np.zeros(1))) == "there is an unknown array other"
    small = Held(good, **{"world.organisms.genome.output": np.zeros((5, 2), np.float32)})
    assert "genome.output is too small for 6 blocks" in str(expected.fault(small))
    for name, most in (("tick", 2**53), ("fixed", 2**53), ("organism_ticks", 2**63)):
        for count, wrong in ((most - 1, False), (most, True), (2**64 - 1, False), (0, False)):
            words = {
                f"world.worlds.{name}.hi": np.array([0, count >> 32], np.uint32),
                f"world.worlds.{name}.lo": np.array([0, count & 0xFFFFFFFF], np.uint32),
            }
            fault = expected.fault(Held(good, **words))
            assert fault == (f"world.worlds.{name} is too large" if wrong else None)


@pytest.mark.parametrize("small", [0, 2**20])
def test_arrays_of_an_open_file_can_be_read_after_its_removal(
    small: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A small file is read at once. A large one stays open."""
    monkeypatch.setattr(arrays, "SMALL", small)
    stored = {
        "rows": np.arange(6, dtype=np.int32).reshape(2, 3),
        "columns": np.asfortranarray(np.arange(6.0).reshape(2, 3)),
        "nothing": np.zeros((0, 4), np.uint32),
        "bad": np.array([True, False]),
    }
    np.savez(tmp_path / "state.npz", **stored)
    seen: list[str] = []

    def fault_of(name: str, array: np.ndarray) -> str | None:
        seen.append(name)
        return "it is bad" if name == "bad" else None

    opened = Arrays(tmp_path / "state.npz", fault_of)
    (tmp_path / "state.npz").unlink()
    assert list(opened) == list(stored)
    assert len(opened) == 4
    for name in ("rows", "columns", "nothing"):
        for _ in range(2):
            assert opened[name].dtype == stored[name].dtype
            np.testing.assert_array_equal(opened[name], stored[name])
        assert opened.size(name) >= stored[name].nbytes + 10
    assert seen == ["rows", "columns", "nothing"], "each array is read and checked once"
    with pytest.raises(Trouble, match=f"^{tmp_path} is not a checkpoint of this run: it is bad$"):
        opened["bad"]
    with pytest.raises(KeyError):
        opened["none"]
    assert "none" not in opened


def test_counts_have_a_high_and_a_low_word() -> None:
    words = {"world.worlds.tick.hi": np.array([0, 1, 2**32 - 1], np.uint32),
             "world.worlds.tick.lo": np.array([5, 2**32 - 1, 2**32 - 1], np.uint32)}  # fmt: skip
    assert world_ticks(words).tolist() == [5, 2**33 - 1, 2**64 - 1]
    assert read_count(words, "world.worlds.tick").dtype == np.uint64


def test_notes_of_a_life_are_those_of_its_birth() -> None:
    """Births of two worlds are recorded in order of events. One life is left out."""
    births = pa.table({
        "world": pa.array([1, 0, 1, 0, 0], pa.int32()), "id": [0, 0, 1, 1, 2],
        "step": pa.array([10, 0, 11, 1, 2]), "way": pa.array([-10, -1, -11, -2, -3]),
    })  # fmt: skip
    run: Any = SimpleNamespace(schema=SimpleNamespace(notes=("step", "way")))
    run.table = lambda _, columns: births.select(columns)
    run._of_births = lambda *given: Records._of_births(run, *given)
    lives = worlds_of([(0, 9, True)] * 3, [(0, 9, True)] * 2, until=40).take(np.array([0, 2, 3, 4]))
    assert Records.notes_of(run, lives).tolist() == [[0, -1], [2, -3], [10, -10], [11, -11]]
