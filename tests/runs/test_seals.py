"""What seals a run: every file by its checksum, the state by the digest, inexactness for ever."""

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia import progress
from primordia.errors import InputError, Trouble
from primordia.runs import checkpoint, loop
from primordia.runs.archive import Archive
from primordia.runs.digest import digests
from primordia.runs.verify import verify
from tests.trouble import flip, newest, reseal
from tests.worlds import MILLS, Lived, config

TICKS = 120
SETTINGS: dict[str, Any] = {
    **MILLS,
    "seed": 3,
    "stop": {"ticks": TICKS},
}
UNSEALED = {"lock", "versions.json"}
"""Files without a checksum: the first is empty, the second is compared with what is installed. The source
of the user's parts, in `code`, is compared with what is there."""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a folder with a run and its fork."""
    folder = tmp_path_factory.mktemp("seals")
    loop.start(config(SETTINGS), folder / "run")
    primordia.load(folder / "run").fork(TICKS // 2, folder / "fork", seed=5)
    return folder


def files_of(run: Path) -> Iterator[str]:
    for path in sorted(run.rglob("*")):
        name = path.relative_to(run)
        if path.is_file() and path.name not in UNSEALED and name.parts[0] != "code":
            yield str(name)


@pytest.mark.parametrize("which", ["run", "fork"])
def test_a_changed_byte_in_any_file_of_a_run_is_noticed(
    made: Path, tmp_path: Path, which: str
) -> None:
    names = [*files_of(made / which)]
    assert {"config.toml", "births/000000.parquet"} < {*names}
    for name in names:
        run = Path(shutil.copytree(made / which, tmp_path / name.replace("/", "-")))
        flip(run / name)
        try:
            opened = Archive(run)
            last, faults = opened.newest
            assert opened.origin is None or last is not None
        except (InputError, Trouble) as error:
            faults = [str(error)]
        assert any(str(run / name) in fault for fault in faults), name


def test_a_damaged_checkpoint_is_removed_when_its_run_goes_on(made: Path, tmp_path: Path) -> None:
    """So it takes no whole one's place among those that are kept."""
    run = Path(shutil.copytree(made / "run", tmp_path / "run"))
    loop.resume(run, {"ticks": TICKS + 50})
    flip(newest(run) / "state.npz")
    damaged, whole = newest(run), list[int]()

    def listen(_: loop.Status) -> None:
        folders = checkpoint.numbered(run)
        assert damaged not in folders or Archive(run).newest[1] == []
        whole.append(len(folders) - len([*checkpoint.whole_checkpoints(run)]))

    loop.resume(run, {"ticks": TICKS + 100}, checkpoint_every=0.0, listen=listen)
    assert {*whole} == {0}
    assert Archive(run).newest[1] == []


@pytest.fixture(scope="module")
def lived() -> Lived:
    """Live worlds with seasons and a metabolism, so that every part of the state is in use."""
    return Lived(config(SETTINGS), 150)


def test_the_digest_of_a_world_depends_on_every_number_of_its_living(lived: Lived) -> None:
    """It depends on nothing else: not on other worlds, nor on empty cells."""
    arrays, records = lived.engine.arrays(), lived.recorder.digests()
    before, cells = lived.digests(), lived.config.cells
    alive = np.flatnonzero(arrays["world.organisms.alive"][cells : 2 * cells])
    empty = np.flatnonzero(~arrays["world.organisms.alive"][cells : 2 * cells])
    assert len(alive)
    assert len(empty)

    def now(name: str, row: int) -> list[bool]:
        array = arrays[name].copy()
        place = array[row].reshape(-1)
        place[-1:] = ~place[-1:] if array.dtype == bool else place[-1:] + 1
        array[row] = place.reshape(array[row].shape)
        after = digests(records, {**arrays, name: array}, 2, lived.config.islands)
        return [old == new for old, new in zip(before, after, strict=True)]

    for name, array in arrays.items():
        if not array[0].size:
            continue
        of_world = name.startswith("world.worlds.")
        assert now(name, 1 if of_world else cells + alive[-1]) == [True, False], name
        if not of_world and name != "world.organisms.alive":
            assert now(name, cells + empty[0]) == [True, True], name
    for name, sums in records.items():
        after = digests({**records, name: sums + np.uint64(1)}, arrays, 2, lived.config.islands)
        assert all(old != new for old, new in zip(before, after, strict=True)), name


def test_verify_compares_the_state_of_every_world(made: Path, tmp_path: Path) -> None:
    """The records hold; a number of one organism that lives in the last world does not."""
    run = Path(shutil.copytree(made / "run", tmp_path / "run"))
    heard, told = list[float](), list[tuple[str, float]]()
    with progress.shown(lambda *each: told.append(each)):
        assert verify(Archive(run), lambda status: heard.append(status.wall_s)) == []
    assert len(heard) == len(told) > 0
    assert told[-1] == ("living again", 1.0)
    path = newest(run) / "state.npz"
    with np.load(path) as stored:
        arrays = dict(stored)
    cell = np.flatnonzero(arrays["world.organisms.alive"])[-1]
    arrays["world.organisms.genome.output"][cell] += 1
    np.savez(path, allow_pickle=False, **arrays)
    reseal(path.parent)
    (fault,) = verify(Archive(run))
    assert re.fullmatch(
        r"world 1 \(seed 4\) differs: [0-9a-f]{16}\.\.\. recorded, [0-9a-f]{16}\.\.\. now", fault
    )


def test_a_checkpoint_has_a_digest_of_each_world_in_each_table(made: Path, tmp_path: Path) -> None:
    run = Path(shutil.copytree(made / "run", tmp_path / "run"))
    reseal(newest(run), lambda content: content["digests"]["deaths"].pop())
    opened = Archive(run)
    for _ in range(2):
        with pytest.raises(Trouble, match="the checkpoint has another number of worlds"):
            opened.state  # noqa: B018, which is read here
