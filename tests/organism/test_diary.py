"""Files of a life tick by tick: every kind of file holds all columns of all ticks."""

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.csv as csv
import pyarrow.parquet as pq
import pytest

from primordia.law.metabolism import ONE
from primordia.organism.reliving import diary
from primordia.organism.reliving.instant import Stretch

COUNTS = ("score", "energy", "lives")
"""One of the habitat's counts has the name of a column that every life has."""


def lived(first: int, ticks: int) -> Stretch:
    """Return ticks of a life whose values are all different."""
    tick = np.arange(first, first + ticks)
    senses = np.stack([tick / 8, -tick / 4, tick + 0.5], axis=1).astype(np.float32)
    counts = np.stack([tick + 1000, tick + 2000, tick + 3000], axis=1).astype(np.int32)
    energy, eaten = (5 * ONE - 3 * tick).astype(np.int32), (7 * tick).astype(np.int32)
    action = np.stack([tick / 2, -tick], axis=1).astype(np.float32)
    return Stretch(tick, senses, action, None, energy, eaten, np.full(ticks, -1, np.int32), counts)


def columns(path: Path) -> dict[str, Any]:
    """Return the columns of a file. A vector is split into columns of single numbers."""
    if path.suffix == ".npz":
        with np.load(path) as npz:
            whole = dict(npz)
        return {
            f"{name}_{i}" if column.ndim == 2 else name: each.tolist()
            for name, column in whole.items()
            for i, each in enumerate(column.T if column.ndim == 2 else [column])
        }
    table = pq.read_table(path) if path.suffix == ".parquet" else csv.read_csv(path)
    return dict(table.to_pydict())


@pytest.mark.parametrize("suffix", diary.WRITERS)
@pytest.mark.parametrize("lengths", [(4,), (3, 1, 2)])
def test_a_file_holds_every_tick_of_every_stretch(
    suffix: str, lengths: tuple[int, ...], tmp_path: Path
) -> None:
    starts = [21 + sum(lengths[:k]) for k in range(len(lengths))]
    stretches = [lived(first, ticks) for first, ticks in zip(starts, lengths, strict=True)]
    path = tmp_path / f"life{suffix}"
    diary.write(path, iter(stretches), COUNTS)
    ticks = range(21, 21 + sum(lengths))
    expected = {
        "tick": list(ticks),
        "senses_0": [tick / 8 for tick in ticks],
        "senses_1": [-tick / 4 for tick in ticks],
        "senses_2": [tick + 0.5 for tick in ticks],
        "action_0": [tick / 2 for tick in ticks],
        "action_1": [-tick for tick in ticks],
        "energy": [5 - 3 * tick / 1024 for tick in ticks],
        "food": [7 * tick / 1024 for tick in ticks],
        "score": [tick + 1000 for tick in ticks],
        "lives": [tick + 3000 for tick in ticks],
    }
    found = columns(path)
    assert list(found) == list(expected)
    assert found == expected
