"""A record that was changed, in a file or in memory, does not agree with the life lived again."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from primordia.errors import Trouble
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.reliving.compare import relive
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.archive import Archive
from primordia.runs.lives import ALIVE
from tests.commands import complains, here
from tests.trouble import newest, reseal

Row = dict[str, Any]


def later(row: Row) -> None:
    row["tick"] += 1


def earlier(row: Row) -> None:
    row["tick"] -= 1


def replaced(row: Row) -> None:
    row["cause"] = "replaced" if row["cause"] != "replaced" else "hazard"


def richer(row: Row) -> None:
    row["energy"] += 1 / ONE


FORGERIES: list[tuple[Callable[[Row], None], set[str]]] = [
    (later, {"tick"}),
    (earlier, {"tick", "cause"}),
    (replaced, {"cause"}),
    (richer, {"energy"}),
]
"""Changes of the row of a death, and what then differs at least."""
ENDS = (Cause.STARVED, Cause.HAZARD, Cause.REPLACED)


@pytest.mark.parametrize(("change", "respects"), FORGERIES)
def test_a_forged_death_is_noticed(
    chain: list[Path], tmp_path: Path, change: Callable[[Row], None], respects: set[str]
) -> None:
    """The forger has changed one number of a closed segment, and computed all checksums again.

    An organism that dies by itself dies in the same tick again. Other lives go on to the recorded end.
    """
    run = Path(shutil.copytree(chain[0], tmp_path / "run"))
    lives = Archive(run).lives.of_world(0)
    likely = (lives.lifespan > 3) & (lives.ended < 149)
    chosen = [int(lives.id[likely & (lives.cause == cause)][0]) for cause in ENDS]
    for path in run.glob("deaths/*.parquet"):
        before = pq.read_table(path)
        rows = before.to_pylist()
        for row in rows:
            if row["world"] == 0 and row["id"] in chosen:
                change(row)
        pq.write_table(pa.Table.from_pylist(rows, schema=before.schema), path)
    reseal(newest(run))
    for number, cause in zip(chosen, ENDS, strict=True):
        done = here("relive", run, number, "--json")
        complains(done, 1, f"organism {number} of world 0, lived again, differs from its record")
        found = json.loads(done.stdout)
        assert not found["agrees"]
        recorded = found["respects"][0]["recorded"]
        true_end = lives.ended[lives.id == number]
        assert recorded == true_end + (change is later) - (change is earlier)
        dies_before = change is later and cause is not Cause.REPLACED
        assert found["ends"] == recorded - dies_before
        assert {row["name"] for row in found["respects"] if not row["agrees"]} >= respects


@pytest.mark.parametrize("name", ["energy", "eaten", "memory"])
def test_a_forged_state_of_the_living_is_noticed(
    chain: list[Path], tmp_path: Path, name: str
) -> None:
    run = Path(shutil.copytree(chain[0], tmp_path / "run"))
    lives = Archive(run).lives.of_world(0)
    row = int(np.flatnonzero(~lives.died & (lives.lifespan > 3))[0])
    with np.load(newest(run) / "state.npz") as stored:
        arrays = dict(stored)
    array = arrays[f"world.organisms.{name}"]
    array[lives.cell[row]] += array.dtype.type(1)
    np.savez(newest(run) / "state.npz", allow_pickle=False, **arrays)
    reseal(newest(run))
    respect = {"energy": "energy", "eaten": "food", "memory": "memory"}[name]
    found = relive(Archive(run), int(lives.id[row]))
    assert [each.name for each in found.respects if not each.agrees] == [respect]


Change = Callable[[RelivedLife], None]


def shifted(by: int) -> Change:
    def shift(life: RelivedLife) -> None:
        life.record.ended[0] += by

    return shift


def caused(cause: int) -> Change:
    def change(life: RelivedLife) -> None:
        life.record.cause[0] = cause if life.record.cause[0] != cause else Cause.STARVED

    return change


def left(energy: int, food: int) -> Change:
    def change(life: RelivedLife) -> None:
        before = life.at_death
        life.__dict__["at_death"] = before[0] + energy, before[1] + food

    return change


CHANGES = {
    "died a tick later": shifted(1),
    "died a tick earlier": shifted(-1),
    "was struck by accident": caused(Cause.HAZARD),
    "lives": caused(ALIVE),
    "had more energy": left(1, 0),
    "ate less": left(0, -1),
}


def repeats(life: RelivedLife) -> bool:
    """Return whether a life is lived again as its record says."""
    try:
        return len([*life.stretches()]) > 0
    except Trouble as error:
        if "did not repeat as recorded" not in str(error):
            raise
        return False


@pytest.mark.parametrize("cause", [Cause.STARVED, Cause.FATAL, Cause.HAZARD])
def test_a_record_that_differs_from_the_life_is_noticed(chain: list[Path], cause: Cause) -> None:
    """The record says that the organism died otherwise than it does. Unchanged, it agrees."""
    run = Archive(chain[0])
    lives = run.lives
    row = int(np.flatnonzero((lives.cause == cause) & (lives.lifespan > 4))[0])
    who = int(lives.id[row]), int(lives.world[row])
    assert repeats(RelivedLife.of(run, *who))
    for said, change in CHANGES.items():
        change(life := RelivedLife.of(run, *who))
        assert not repeats(life), said
