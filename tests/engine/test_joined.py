"""The events of several devices in one list."""

from types import SimpleNamespace
from typing import Any

import jax
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from primordia.engine.sharded import ShardedChunks, _joined
from primordia.law.columns import Columns
from primordia.law.events import BIRTHS, DEATHS, Events, sample_columns

SHARE = 500
"""Cells of a device."""


@given(st.lists(st.lists(st.integers(1, 3), max_size=200), min_size=1, max_size=3))
def test_events_of_a_tick_keep_their_order_and_devices_follow_each_other(
    ticks: list[list[int]],
) -> None:
    """Within a tick a world's births are in the order of their numbers."""
    place = BIRTHS.unpacked(np.arange(BIRTHS.width)[None].astype(np.uint32))["tick"].item()
    low = place & 0xFFFFFFFF
    rows = np.zeros((len(ticks), 200, BIRTHS.width), np.uint32)
    rows[:, :, 0] = np.arange(200)
    for device, each in enumerate(ticks):
        rows[device, : len(each), low] = sorted(each)
    shards = [SimpleNamespace(data=part[None]) for part in rows]
    lists: Any = SimpleNamespace(
        rows=SimpleNamespace(shape=rows.shape, addressable_shards=shards),
        filled=[len(each) for each in ticks],
    )
    joined = np.asarray(_joined(lists, BIRTHS, SHARE).rows)
    expected = sorted(
        (tick, SHARE * device + row)
        for device, each in enumerate(ticks)
        for row, tick in enumerate(sorted(each))
    )
    assert list(zip(joined[:, low].tolist(), joined[:, 0].tolist(), strict=True)) == expected


def of_two_devices(columns: Columns, *ticks: list[int]) -> Any:
    """Return lists with a row for each tick, numbered in its first column, and with unused rows."""
    rows = np.zeros((2, 4, columns.width + 1), np.uint32)
    for part, each in zip(rows, ticks, strict=True):
        values = {name: np.zeros(len(each), np.int64) for name in columns.names}
        values |= {columns.names[0]: np.arange(len(each)), "tick": np.array(each, np.int64)}
        part[: len(each), :-1] = columns.rows(**values)
        part[:, -1] = 9
    shards = [SimpleNamespace(data=part[None]) for part in rows]
    each_rows = SimpleNamespace(shape=rows.shape, addressable_shards=shards)
    return SimpleNamespace(rows=each_rows, filled=[len(each) for each in ticks])


def test_cells_of_births_and_deaths_and_worlds_of_samples_are_those_of_the_whole_run() -> None:
    """Each device has 3 worlds of 7 cells. A further column, such as a note, stays in its row."""
    chunks: Any = object.__new__(ShardedChunks)
    chunks._share = SimpleNamespace(worlds=3, cells=7)
    samples = sample_columns(())
    chunks._lists = Events(
        of_two_devices(BIRTHS, [1, 2**32], [2**32, 2**32 + 1, 2**33]),
        of_two_devices(DEATHS, [], [4, 4]),
        of_two_devices(samples, [10, 10, 20], [10]),
    )
    births, deaths, sampled = joined = chunks._joined()
    rows = np.asarray(births.rows)
    assert rows[:, 0].tolist() == [0, 1, 21, 22, 23]
    assert BIRTHS.unpacked(rows)["tick"].tolist() == [1, 2**32, 2**32, 2**32 + 1, 2**33]
    assert np.asarray(deaths.rows)[:, 0].tolist() == [21, 22]
    worlds, ticks = (samples.unpacked(np.asarray(sampled.rows))[name] for name in ("world", "tick"))
    assert (worlds.tolist(), ticks.tolist()) == ([0, 1, 3, 2], [10, 10, 10, 20])
    assert [int(each.filled) for each in joined] == [5, 2, 4]
    assert all((np.asarray(each.rows)[:, -1] == 9).all() for each in joined)


def test_a_chunk_has_advanced_by_the_ticks_of_the_device_that_advanced_most() -> None:
    """Each device gets the state, the lists and the limits. The events are those of this chunk."""
    chunks: Any = object.__new__(ShardedChunks)
    chunks._share, chunks._split = SimpleNamespace(worlds=3, cells=7), jax.devices()[0]
    columns = BIRTHS, DEATHS, sample_columns(())
    chunks._lists = lists = Events(*(of_two_devices(each, [], []) for each in columns))
    after = lists._replace(deaths=of_two_devices(DEATHS, [], [8]))

    def advance(state: Any, given: Any, limits: str, ticks: np.int32) -> tuple:
        assert (given is lists, limits, int(ticks)) == (True, "limits", 9)
        return state, after, np.array([3, 7, 5])

    chunks._advance = advance
    state, done = chunks.advance({"a": np.ones(2)}, "limits", 9)
    assert (state["a"].tolist(), done, chunks._lists is after) == ([1, 1], 7, True)
    assert np.asarray(chunks.events.deaths.rows)[:, 0].tolist() == [21]
