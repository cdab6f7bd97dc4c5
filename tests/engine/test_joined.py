"""The events of several devices in one list."""

from types import SimpleNamespace
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from primordia.engine.sharded import _joined
from primordia.law.events import BIRTHS

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
