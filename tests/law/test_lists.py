"""Lists of events, their columns, and the state of worlds before the first organism."""

from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.law import events as log
from primordia.law.columns import Columns
from primordia.law.events import Events, Rows
from primordia.law.genesis import begin, birth_words, body_words
from primordia.law.world import BirthCause, Cause, ages, ages_total
from primordia.random.keys import Purpose, bits, stream
from primordia.random.wide import to_host, wide
from tests.worlds import MEADOW, config

COLUMNS = Columns(("cell", "id", "energy"), frozenset({"id"})).plus("mate", "note", pairs=("mate",))
VALUES = {
    "cell": np.array([0, 3, 2**32 - 1], np.int64),
    "id": np.array([1, 2**32 + 5, 2**40 - 1], np.int64),
    "energy": np.array([0, -1, -(2**31)], np.int64),
    "mate": np.array([2**63 - 1, -1, 2**31], np.int64),
    "note": np.array([7, -3, 0], np.int64),
}
"""A mate of -1 is 2^64 - 1, which stands for no mate."""


def test_values_come_back_from_rows_by_name() -> None:
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
    given: dict[str, Any] = {name: wide(VALUES[name]) for name in ("id", "mate")}
    given |= {
        name: jnp.asarray(VALUES[name].astype(np.int32)) for name in ("cell", "energy", "note")
    }
    np.testing.assert_array_equal(COLUMNS.words(**given), COLUMNS.rows(**VALUES))


def test_floats_keep_their_bits() -> None:
    numbers = np.array([0.1, -2.5, np.inf], np.float32)
    rows = Columns(("rate",)).words(rate=jnp.asarray(numbers))
    np.testing.assert_array_equal(np.asarray(rows)[:, 0].view(np.float32), numbers)


@pytest.mark.parametrize(
    ("cells", "most"),
    [(1, 1), (511, 1), (512, 2), (256 * 1023, 1023), (256 * 1024, 1024), (2**22, 1024)],
)
def test_large_worlds_write_more_events_at_once(cells: int, most: int) -> None:
    assert log.batch(cells) == most


@pytest.mark.parametrize("share", [0.0, 0.02, 1.0])
def test_each_true_cell_is_visited_once_in_order(share: float) -> None:
    """1,301 cells are visited five at a time; the rest of the last batch is not valid."""
    mask = np.random.default_rng(3).random(1301) < share
    mask[-1] = share > 0
    where = np.flatnonzero(mask)

    def act(cells: Array, valid: Array, carry: tuple[Rows, Array]) -> tuple[Rows, Array]:
        block = jnp.stack([cells, cells + 1], axis=1).astype(jnp.uint32)
        return log.append(carry[0], block, valid), carry[1] + 1

    begun = Rows(jnp.full((1311, 2), 9, jnp.uint32), jnp.int32(3))
    listed, calls = log.for_each(jnp.asarray(mask), (begun, jnp.int32(0)), act)
    filled = int(listed.filled)
    assert filled == 3 + len(where)
    assert int(calls) == -(-len(where) // 5)
    assert (np.asarray(listed.rows[:3]) == 9).all()
    np.testing.assert_array_equal(listed.rows[3:filled], np.stack([where, where + 1], 1))


def test_emptied_lists_begin_at_the_first_row() -> None:
    lists = Events(*(Rows(jnp.ones((4, 2), jnp.uint32), jnp.int32(n)) for n in (1, 2, 3)))
    for list_, before in zip(log.emptied(lists), lists, strict=True):
        assert int(list_.filled) == 0
        assert list_.rows is before.rows


RATCHETS = [
    {"kind": "ratchet", "setting": "replication", "when": "food", "above": 0.1, "factor": 0.5,
     "every": every}
    for every in (7, 10, 1)
]  # fmt: skip


@pytest.mark.parametrize(("tick", "births"), [(0, 0), (33, 5), (30, 2**33), (2**33, 1)])
def test_worlds_begin_at_their_tick_with_waits_until_the_next_multiples(
    tick: int, births: int
) -> None:
    at = {"kind": "schedule", "setting": "hazard", "at": 50, "value": 0.5}
    seasons = [RATCHETS[0], at, *RATCHETS[1:]]
    made = config(MEADOW, cells=4, seeds=2, sample_every=15, seasons=seasons, hazard=0.125)
    law = made.build_law(made.build_habitat())
    organisms, worlds = begin(law, np.array([8, 2**63], np.uint64), tick, births)
    assert to_host(worlds.seed).tolist() == [8, 2**63]
    assert to_host(worlds.tick).tolist() == [tick] * 2
    assert to_host(worlds.births).tolist() == [births] * 2
    assert worlds.sample_wait.tolist() == [15 - tick % 15] * 2
    assert worlds.looks.wait.tolist() == [[7 - tick % 7, 10 - tick % 10, 1]] * 2
    assert worlds.climate["hazard"].tolist() == [0.125] * 2
    for name in ("saturated", "saturated_births", "fixed", "fixed_births"):
        assert to_host(getattr(worlds, name)).tolist() == [2**64 - 1] * 2, name
    for name in ("deaths", "extinctions", "organism_ticks", "food"):
        assert not to_host(getattr(worlds, name)).any(), name
    assert not organisms.alive.any()
    assert len(organisms.alive) == 8


@pytest.mark.parametrize("words", [0, 1, 2, 3, 6])
def test_bodies_get_the_words_of_their_world_tick_and_cell(words: int) -> None:
    """First the high words of the draws in turn, then their low words; an odd last word is left out."""
    made = config(MEADOW, cells=3, seeds=2)
    law = made.build_law(made.build_habitat())
    worlds = begin(law, np.array([8, 2**63], np.uint64), tick=9).worlds
    found = np.asarray(birth_words(law, worlds, jnp.bool_(True), words))
    assert found.shape == (6, words)
    assert found.dtype == np.uint32
    draws = -(-words // 2)
    for cell in range(6):
        key = stream(wide([8, 2**63]), Purpose.BODY, wide([9, 9])).take(cell // 3)
        pairs = [bits(key, jnp.uint32(cell % 3), draw) for draw in range(draws)]
        flat = [int(pair.hi) for pair in pairs] + [int(pair.lo) for pair in pairs]
        assert found[cell].tolist() == flat[:words]
    assert not np.asarray(birth_words(law, worlds, jnp.bool_(False), words)).any()
    key = stream(wide([8, 2**63]), Purpose.BODY, wide([9, 9]))
    some = body_words(key, jnp.array([2, 0]), words)
    np.testing.assert_array_equal(some, found[[2, 3]])


def test_ages_are_those_of_the_living_and_add_up_by_world() -> None:
    made = config(MEADOW, cells=3, seeds=2)
    law = made.build_law(made.build_habitat())
    world = begin(law, np.array([1, 2], np.uint64), tick=2**32 + 10)
    alive = jnp.array([True, False, True, True, True, False])
    born = wide([0, 0, 2**32 + 10, 2**32 + 9, 2**32 - 5, 3])
    tick = wide([2**32 + 10, 2**32 + 20])
    world = world._replace(
        organisms=world.organisms._replace(alive=alive, born=born),
        worlds=world.worlds._replace(tick=tick),
    )
    expected = [2**32 + 10, 0, 0, 11, 25, 0]
    assert to_host(ages(world)).tolist() == expected
    assert to_host(ages_total(world)).tolist() == [2**32 + 10, 36]


def test_causes_are_told_in_words() -> None:
    """The numbers are part of the format of records."""
    assert [(cause.value, cause.label) for cause in Cause] == [
        (0, "fatal"), (1, "starved"), (2, "hazard"), (3, "replaced"), (4, "fault"), (5, "time-limit"),
        (6, "restart"),
    ]  # fmt: skip
    assert [(c.value, c.label) for c in BirthCause] == [(0, "founder"), (1, "copy"), (2, "mutant")]


def test_columns_of_births_follow_mates_and_notes() -> None:
    common = ("cell", "id", "parent", "tick", "cause")
    assert log.birth_columns(False, ()) == log.BIRTHS
    assert log.birth_columns(True, ("quarters", "size")).names == (
        *common,
        "mate",
        "quarters",
        "size",
    )
    assert log.birth_columns(True, ("quarters",)).pairs == {"id", "parent", "tick", "mate"}
    assert log.birth_columns(False, ("quarters",)).names == (*common, "quarters")
