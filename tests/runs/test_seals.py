"""What seals a run: every file by its checksum, the state by the digest, inexactness for ever."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia import progress
from primordia.errors import InputError, Trouble
from primordia.history.info import info
from primordia.random.wide import wide
from primordia.runs import checkpoint, loop
from primordia.runs import verify as verification
from primordia.runs.archive import Archive
from primordia.runs.digest import digests
from primordia.runs.verify import verify
from tests.trouble import flip, newest, reseal
from tests.worlds import MILL, Lived, config

TICKS = 120
SETTINGS: dict[str, Any] = {**MILL, "brain": {"hidden": 4}, "seeds": 2, "stop": {"ticks": TICKS}}
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


def test_a_run_once_inexact_stays_inexact(made: Path, tmp_path: Path) -> None:
    """It stays so when the versions are again those that it was begun with."""
    run = Path(shutil.copytree(made / "run", tmp_path / "run"))
    text = (run / "versions.json").read_text()
    assert info(Archive(run))["exact"]
    (run / "versions.json").write_text(json.dumps(json.loads(text) | {"jax": "0.0.1"}))
    loop.resume(run, {"ticks": TICKS + 20}, inexact=True)
    (run / "versions.json").write_text(text)
    for ticks in (TICKS + 20, TICKS + 40, TICKS + 60):
        assert not info(Archive(run))["exact"]
        with pytest.raises(InputError, match="not exact"):
            verify(Archive(run))
        loop.resume(run, {"ticks": ticks})
    assert not info(Archive(run))["exact"]


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
        after = digests(records, {**arrays, name: array}, 2)
        return [old == new for old, new in zip(before, after, strict=True)]

    for name, array in arrays.items():
        if not array[0].size:
            continue
        of_world = name.startswith("world.worlds.")
        assert now(name, 1 if of_world else cells + alive[-1]) == [True, False], name
        if not of_world and name != "world.organisms.alive":
            assert now(name, cells + empty[0]) == [True, True], name
    for name, sums in records.items():
        after = digests({**records, name: sums + np.uint64(1)}, arrays, 2)
        assert all(old != new for old, new in zip(before, after, strict=True)), name


@pytest.mark.parametrize("name", ["energy", "genome.output"])
def test_verify_compares_the_state_of_every_world(made: Path, tmp_path: Path, name: str) -> None:
    """The records hold; a number of one organism that lives in the last world does not."""
    run = Path(shutil.copytree(made / "run", tmp_path / "run"))
    assert verify(Archive(run)) == []
    path = newest(run) / "state.npz"
    with np.load(path) as stored:
        arrays = dict(stored)
    cell = np.flatnonzero(arrays["world.organisms.alive"])[-1]
    arrays[f"world.organisms.{name}"][cell] += 1
    np.savez(path, allow_pickle=False, **arrays)
    reseal(path.parent)
    (fault,) = verify(Archive(run))
    assert fault.startswith("world 1 (seed 1) differs")


@pytest.mark.parametrize("versions", [[], ["jax 1 then, 2 now", "numpy 3 then, 4 now"]])
def test_verify_names_each_world_that_differs_with_its_own_seed(
    monkeypatch: pytest.MonkeyPatch, versions: list[str]
) -> None:
    """Three invented worlds are lived again in two chunks. The second repeats as recorded."""
    ends, heard = {"recorded": ["a" * 64, "b" * 64, "c" * 64]}, list[Any]()
    ends["now"] = ["d" * 64, "b" * 64, "e" * 64]
    running, ticks = iter([True, True, False]), np.array([2, 4, 6])
    worlds = SimpleNamespace(tick=wide([1, 2, 3]))
    engine = SimpleNamespace(
        limits=lambda _, ticks: ticks, any_running=lambda _: next(running),
        advance=lambda limits: limits, arrays=lambda: "now",
        state=SimpleNamespace(world=SimpleNamespace(worlds=worlds)),
    )  # fmt: skip
    recorder = SimpleNamespace(append=heard.append, digests=dict)
    for name, value in (
        ("Engine", lambda _: engine), ("recorder_for", lambda *_: recorder),
        ("world_ticks", lambda _: ticks), ("digests", lambda _, which, *__: ends[which]),
    ):  # fmt: skip
        monkeypatch.setattr(verification, name, value)
    monkeypatch.setattr(checkpoint, "origin", lambda *_: None)
    last = SimpleNamespace(
        digests={}, manifest=SimpleNamespace(progress=SimpleNamespace(exact=True))
    )
    run: Any = SimpleNamespace(
        config=SimpleNamespace(seed=40, seeds=3, islands=None),
        newest=(last, []), state="recorded", path=Path("run"),
        fault_in=None, admit=lambda: None, other_versions=versions,
    )  # fmt: skip
    reasons = "".join(f"; {each}" for each in versions)
    told = list[tuple[str, float]]()
    with progress.shown(lambda *each: told.append(each)):
        found = verify(run, heard.append)
    assert told == [("living again", 0.5)] * 2, "half of all ticks, in both chunks"
    assert found == [
        f"world 0 (seed 40) differs: {'a' * 16}... recorded, {'d' * 16}... now{reasons}",
        f"world 2 (seed 42) differs: {'c' * 16}... recorded, {'e' * 16}... now{reasons}",
    ]
    assert all(each is ticks for each in heard[::2])
    assert [status.engine for status in heard[1::2]] == [engine, engine]
