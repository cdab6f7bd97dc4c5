"""What dashboards read: event files of TensorBoard, and offline runs of Weights & Biases."""

import json
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

BLOCK, HEADER = 2**15, 7
"""Bytes of a block of a W&B file, and of the header of the file and of each part of a record."""
FULL, LAST = 1, 4
"""Kinds of parts of a record: the whole of it, and its end."""

Row = dict[str, Any]


def event_rows(folder: Path) -> list[Row]:
    """Return tick and values of each event in the one event file of a folder, in their order."""
    return [
        {"tick": event.step, **{each.tag: each.simple_value for each in event.summary.value}}
        for event in events(folder)
    ]


def events(folder: Path) -> list[Any]:
    """Return the events with values in the one event file of a folder, in their order.

    A file is a sequence of records: length (8 bytes), checksum (4), content, checksum (4).
    """
    from tensorboardX.proto.event_pb2 import Event

    (file,) = folder.glob("*tfevents*")
    content, place, found = file.read_bytes(), 0, []
    while place < len(content):
        (length,) = struct.unpack_from("<Q", content, place)
        found.append(Event.FromString(content[place + 12 : place + 12 + length]))
        place += 12 + length + 4
    return [event for event in found if event.summary.value]


def offline_runs(folder: Path) -> dict[str, tuple[Any, list[Row]]]:
    """Return the offline runs below a folder by name: what W&B knows of each, and its rows."""
    runs = {}
    for records in offline_records(folder):
        (about,) = (each.run for each in records if each.HasField("run"))
        assert about.display_name not in runs
        rows = [_row(each.history) for each in records if each.HasField("history")]
        runs[about.display_name] = (about, rows)
    return runs


def offline_records(folder: Path) -> Iterator[list[Any]]:
    """Yield all records of each offline run below a folder."""
    from wandb.proto.wandb_internal_pb2 import Record  # type: ignore[attr-defined]

    for file in sorted(folder.glob("wandb/offline-run-*/*.wandb")):
        yield [Record.FromString(each) for each in _records(file.read_bytes())]


def _row(history: Any) -> Row:
    items = {item.key or item.nested_key[0]: json.loads(item.value_json) for item in history.item}
    return {name: value for name, value in items.items() if not name.startswith("_")}


def _records(content: bytes) -> Iterator[bytes]:
    """Yield the records of a file in the format of LevelDB's log: parts within blocks."""
    assert content[:4] == b":W&B"
    place, record = HEADER, b""
    while place < len(content):
        if BLOCK - place % BLOCK < HEADER:
            place += BLOCK - place % BLOCK
            continue
        _, length, kind = struct.unpack_from("<IHB", content, place)
        record += content[place + HEADER : place + HEADER + length]
        place += HEADER + length
        if kind in (FULL, LAST):
            yield record
            record = b""
