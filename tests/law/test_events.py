"""Lists of events, and the columns of their rows."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.law import events as log
from primordia.law.columns import Columns
from primordia.law.events import Rows
from primordia.law.world import BirthCause, Cause
from primordia.random.wide import wide

COLUMNS = Columns(("cell", "id", "energy"), frozenset({"id"})).plus("mate", "note", pairs=("mate",))
VALUES = {
    "cell": np.array([0, 3, 2**32 - 1], np.int64),
    "id": np.array([1, 2**32 + 5, 2**40 - 1], np.int64),
    "energy": np.array([0, -1, -(2**31)], np.int64),
    "mate": np.array([2**63 - 1, -1, 2**31], np.int64),
    "note": np.array([7, -3, 0], np.int64),
}
"""A mate of -1 is 2^64 - 1, which stands for no mate."""


def test_values_are_unpacked_from_rows_by_name() -> None:
    assert COLUMNS.names == ("cell", "id", "energy", "mate", "note")
    assert COLUMNS.width == 7
    rows = COLUMNS.rows(**VALUES)
    assert rows.dtype == np.uint32
    assert rows.shape == (3, 7)
    for row in range(3):
        words = []
        for name in COLUMNS.names:
            value = int(VALUES[name][row])
            words += [value >> 32 & 0xFFFFFFFF] if name in ("id", "mate") else []
            words += [value & 0xFFFFFFFF]
        assert rows[row].tolist() == words
    for name, column in COLUMNS.unpacked(rows).items():
        wide_ = name in ("id", "mate")
        assert column.dtype == (np.int64 if wide_ else np.uint32)
        assert column.tolist() == [v if wide_ else v % 2**32 for v in VALUES[name].tolist()]


def test_rows_of_the_device_have_the_words_of_the_host() -> None:
    """Floats keep their bits."""
    given: dict[str, Any] = {name: wide(VALUES[name]) for name in ("id", "mate")}
    given |= {name: VALUES[name].astype(np.int32) for name in ("cell", "energy", "note")}
    rows, rates = (jax.jit(columns.words) for columns in (COLUMNS, Columns(("rate",))))
    np.testing.assert_array_equal(rows(**given), COLUMNS.rows(**VALUES))
    numbers = np.array([0.1, -2.5, np.inf], np.float32)
    np.testing.assert_array_equal(np.asarray(rates(rate=numbers))[:, 0], numbers.view(np.uint32))


@pytest.mark.parametrize(
    ("cells", "most"), [(1, 1), (511, 1), (512, 2), (256 * 1024, 1024), (2**22, 1024)]
)
def test_large_worlds_write_more_events_at_once(cells: int, most: int) -> None:
    assert log.batch(cells) == most


@jax.jit
def visited(mask: Array) -> tuple:
    """Append the cells of a mask to three rows; return the rows, and the number of batches."""

    def act(cells: Array, valid: Array, carry: tuple[Rows, Array]) -> tuple[Rows, Array]:
        block = jnp.stack([cells, cells + 1], axis=1).astype(jnp.uint32)
        return log.append(carry[0], block, valid), carry[1] + 1

    begun = Rows(jnp.full((1311, 2), 9, jnp.uint32), jnp.int32(3))
    return log.for_each(mask, (begun, jnp.int32(0)), act)


@pytest.mark.parametrize("share", [0.0, 0.02, 1.0])
def test_each_true_cell_is_visited_once_in_order(share: float) -> None:
    """1,301 cells are visited five at a time; the rest of the last batch is not valid."""
    mask = np.random.default_rng(3).random(1301) < share
    mask[-1] = share > 0
    where = np.flatnonzero(mask)
    listed, calls = visited(mask)
    filled = int(listed.filled)
    assert filled == 3 + len(where)
    assert int(calls) == -(-len(where) // 5)
    assert (np.asarray(listed.rows[:3]) == 9).all()
    np.testing.assert_array_equal(listed.rows[3:filled], np.stack([where, where + 1], 1))


def test_each_cause_has_a_number_and_a_word() -> None:
    """The numbers are part of the format of records."""
    assert [(cause.value, cause.label) for cause in Cause] == [
        (0, "fatal"), (1, "starved"), (2, "hazard"), (3, "replaced"), (4, "fault"), (5, "time-limit"),
        (6, "restart"),
    ]  # fmt: skip
    assert [(c.value, c.label) for c in BirthCause] == [(0, "founder"), (1, "copy"), (2, "mutant")]


def test_columns_of_births_follow_mates_and_notes() -> None:
    common = ("cell", "id", "parent", "tick", "cause")
    assert log.birth_columns(False, ()) == log.BIRTHS
    names = log.birth_columns(True, ("quarters", "size")).names
    assert names == (*common, "mate", "quarters", "size")
    assert log.birth_columns(True, ("quarters",)).pairs == {"id", "parent", "tick", "mate"}
    assert log.birth_columns(False, ("quarters",)).names == (*common, "quarters")
