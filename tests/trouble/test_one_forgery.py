"""One forgery at a time: what is sealed again is noticed by the part of the run that it contradicts."""

import errno
import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

import primordia
from primordia.errors import Trouble
from primordia.history.info import info
from primordia.law.world import BirthCause, Cause
from primordia.runs import checkpoint, manifest
from primordia.runs.archive import Archive
from primordia.runs.schema import TABLES
from tests.commands import complains, here
from tests.trouble import TICKS, Arrays, contents, newest, recount, reseal, rewrite

CELLS = 8
"""Cells of the run, which has one world."""


@pytest.mark.parametrize(
    ("table", "column", "value"),
    [
        ("births", "cell", CELLS),
        ("births", "cause", len(BirthCause)),
        ("deaths", "cell", CELLS),
        ("deaths", "cause", len(Cause)),
        ("metrics", "world", 1),
    ],
)
def test_an_open_tail_names_no_world_cell_or_cause_that_does_not_exist(
    run: Path, table: str, column: str, value: int
) -> None:
    columns = Archive(run).schema.columns(table)
    row = columns.rows(**{name: np.array([value * (name == column)]) for name in columns.names})

    def change(arrays: Arrays) -> None:
        arrays[f"tail.{table}"] = np.concatenate([arrays[f"tail.{table}"], row])

    rewrite(newest(run), change)
    with pytest.raises(Trouble, match=f"tail.{table} names a {column} that does not exist"):
        Archive(run).table(table)


@pytest.mark.parametrize("name", ["organism_ticks", "tick", "births", "saturated"])
def test_a_world_has_no_count_that_no_run_can_reach(run: Path, name: str) -> None:
    rewrite(newest(run), partial(recount, name=name, number=2**63))
    with pytest.raises(Trouble, match=f"world.worlds.{name} is too large"):
        info(Archive(run))


@pytest.mark.parametrize(("name", "value"), [("sample_wait", 0), ("calm", -1)])
def test_a_world_does_not_wait_for_ever(run: Path, name: str, value: int) -> None:
    rewrite(newest(run), lambda arrays: arrays[f"world.worlds.{name}"].fill(value))
    for command in ("resume", "verify"):
        complains(here(command, run), 1, f"world.worlds.{name} is below")


def test_columns_in_another_order_are_the_same_columns(run: Path) -> None:
    """Another program may have written the segment."""
    before = Archive(run)
    for table in TABLES:
        for path in (run / table).iterdir():
            stored = pq.read_table(path)
            pq.write_table(stored.select(stored.column_names[::-1]), path)
    reseal(newest(run))
    after = Archive(run)
    for table in TABLES:
        assert after.table(table) == before.table(table)
    assert after.table("births", ("tick", "world")) == before.table("births", ("tick", "world"))
    assert len(after.lives) == len(before.lives)


@pytest.mark.parametrize("part", ["segments", "digests"])
def test_a_manifest_names_all_tables(run: Path, part: str) -> None:
    def change(content: dict[str, Any]) -> None:
        del content[part]["deaths"]

    for folder in checkpoint.numbered(run):
        reseal(folder, change)
    file = newest(run) / "manifest.json"
    for command in ("info", "resume"):
        complains(here(command, run), 1, "no checkpoint of", f"{file} is missing or damaged")


@pytest.mark.parametrize("name", ["checkpoints", "checkpoints/000001/manifest.json"])
def test_what_the_user_may_not_read_is_not_damaged(
    name: str, run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A test may run as root, who may read everything, so the refusal is made here."""
    before = contents(run)

    def refuse(function: Callable[..., Any]) -> Callable[..., Any]:
        def refusing(path: Any, *rest: Any) -> Any:
            if Path(path) == run / name:
                raise PermissionError(errno.EACCES, "Permission denied", str(path))
            return function(path, *rest)

        return refusing

    monkeypatch.setattr(os, "listdir", refuse(os.listdir))
    monkeypatch.setattr(manifest, "read", refuse(manifest.read))
    for command in ("info", "resume", "export"):
        words = [run / "genome"] if command == "export" else []
        complains(here(command, run, *words), 1, f"{run / name} cannot be read: Permission denied")
    assert contents(run) == before


def test_the_last_number_of_a_checkpoint_has_none_after_it(run: Path) -> None:
    last = newest(run).rename(run / "checkpoints" / "999999999")
    done = here("resume", run, "--ticks", TICKS, "--quiet")
    complains(done, 1, f"{last.parent} has no free number for another checkpoint")
    assert newest(run) == last


def test_an_organism_that_lived_at_a_fork_is_in_its_origin(run: Path, tmp_path: Path) -> None:
    fork = primordia.load(run).fork(1_000, tmp_path / "fork").path
    oldest = int(np.argmax(Archive(fork).lives.lifespan))
    number, cell = Archive(fork).lives.id[oldest], Archive(fork).lives.cell[oldest]
    assert len(primordia.load(fork).organism(int(number)).genome())

    def change(arrays: Arrays) -> None:
        arrays["world.organisms.alive"][cell] = False

    rewrite(fork / "origin", change)
    done = here("export", fork, tmp_path / "genome", "--organism", number)
    complains(
        done, 1, f"organism {number} of world 0 is missing in the state of a tick at which it lived"
    )


def test_an_array_is_read_and_checked_when_it_is_needed(run: Path) -> None:
    """So a table of a run with large bodies is read without them; only weights' sizes are compared."""
    births, large = Archive(run).table("births"), list[str]()
    names = ("bodies", "world.organisms.memory", "world.organisms.energy", "world.organisms.born")

    def change(arrays: Arrays) -> None:
        large.extend(name for name in arrays if name.startswith(names))
        for name in large:
            arrays[name] = arrays[name][:-1]

    rewrite(newest(run), change)
    assert large
    assert Archive(run).table("births") == births
    for command in ("info", "resume", "verify"):
        complains(
            here(command, run), 1, f"{newest(run)} is not a checkpoint of this run", "not fit"
        )


@pytest.mark.parametrize("name", ["world.organisms.wings", "tail.marriages", "other"])
def test_an_array_that_no_run_has_is_refused(run: Path, name: str) -> None:
    rewrite(newest(run), lambda arrays: arrays.update({name: np.zeros((CELLS, 2), np.float32)}))
    complains(here("info", run), 1, f"there is an unknown array {name}")


class _Pickled:
    """What executes code where it is unpickled."""

    def __reduce__(self) -> tuple[Any, ...]:
        return Path.touch, (Path("executed"),)


def test_a_pickled_array_is_damage_and_is_not_executed(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    pickled = np.array([_Pickled()], object)
    rewrite(newest(run), lambda arrays: arrays.update({"world.worlds.tick.hi": pickled}))
    with pytest.raises(Trouble, match="damaged"):
        Archive(run).count("world.worlds.tick")
    assert not Path("executed").exists()
