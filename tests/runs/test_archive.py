"""A run is opened once: each part of it is read, checked and built when it is first used."""

from collections import Counter
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pytest

import primordia
from primordia import files
from primordia.config import Config
from primordia.errors import Trouble
from primordia.history.foraging import foraging
from primordia.history.info import info
from primordia.history.pedigree import genomes
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import loop, recorder
from primordia.runs.archive import Archive
from tests.commands import here
from tests.trouble import flip
from tests.worlds import MILLS, config

SETTINGS = {**MILLS, "seed": 3, "stop": {"ticks": 400}}


@pytest.fixture(scope="module")
def mill(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of two worlds with seasons and a metabolism."""
    run = tmp_path_factory.mktemp("mill") / "run"
    loop.start(config(SETTINGS), run)
    return run


@pytest.fixture
def fork(mill: Path, tmp_path: Path) -> Path:
    return primordia.load(mill).fork(250, tmp_path / "fork", seed=8).path


@pytest.fixture
def checked(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Count how often each file's checksum is computed."""
    counted, seal = Counter[str](), files.seal

    def counting(path: Path) -> dict[str, object]:
        counted[str(path)] += 1
        return seal(path)

    monkeypatch.setattr(files, "seal", counting)
    return counted


def test_a_command_opens_its_run_once(fork: Path, tmp_path: Path, checked: Counter[str]) -> None:
    """This holds for settings, genomes, checkpoints, segments and the origin of a fork."""
    evaluated = "evaluate", fork, "--games", 3, "--ticks", 50
    for words in (evaluated, ("export", fork, tmp_path / "genome")):
        checked.clear()
        done = here(*words)
        assert done.returncode == 0, done.stderr
        assert {*checked.values()} == {1}
    names = {str(Path(path).relative_to(fork)) for path in checked}
    assert {"config.toml", "origin/state.npz", "births/000000.parquet"} < names


def test_a_call_from_python_opens_its_run_once(mill: Path, checked: Counter[str]) -> None:
    made = primordia.load(mill)
    checked.clear()
    oldest = made.oldest()
    oldest.genome()
    oldest.policy()
    assert {*checked.values()} == {1}
    made.info()
    assert {*checked.values()} == {2}, "each call of a run opens the run as it is then"


def test_the_law_is_built_once_and_only_for_living(
    mill: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    build = MagicMock(side_effect=Config.build_law)
    monkeypatch.setattr(Config, "build_law", lambda *given: build(*given))
    run = Archive(mill)
    foraging(run)
    genomes(run, np.array([0, len(run.lives) - 1]))
    assert build.call_count == 0
    for world in (0, 1):
        RelivedLife.of(run, 0, world)
    assert build.call_count == 1


def test_an_opened_run_does_not_see_it_grow(tmp_path: Path) -> None:
    """The checkpoint at which it was opened has been removed since."""
    path = tmp_path / "run"
    loop.start(config(SETTINGS), path)
    run = Archive(path)
    assert run.ends.tolist() == [400, 400]
    before = run.last.path
    for ticks in (450, 500, 550):
        loop.resume(path, {"ticks": ticks})
    assert not before.exists()
    assert info(run)["worlds"][1]["ticks"] == 400
    assert run.table("births")["tick"].to_numpy().max() <= 400
    assert run.lives.ended.max() == 400
    assert Archive(path).ends.tolist() == [550, 550]
    assert Archive(path).table("births").slice(0, len(run.table("births"))) == run.table("births")


def test_some_columns_are_read_from_closed_and_open_segments(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recorder, "SEGMENT_ROWS", 11)
    monkeypatch.setattr(recorder.Recorder, "finish", lambda _: None)
    loop.start(config(SETTINGS), tmp_path / "run")
    run = Archive(tmp_path / "run")
    for name, columns in {"births": ("tick", "cause"), "metrics": ("world", "hazard")}.items():
        assert len(run.state[f"tail.{name}"])
        assert run.table(name, columns) == run.table(name).select(columns)
    assert len(list(run.segments("births"))) > 2
    assert len(run.lives) == len(run.table("births"))


def test_a_fork_has_the_state_that_it_began_with(mill: Path, fork: Path) -> None:
    assert Archive(mill).origin is None
    origin, run = Archive(fork).origin, Archive(fork)
    assert origin is not None
    alive = int(origin["world.organisms.alive"].sum())
    assert alive == int((run.lives.born <= 250).sum())
    flip(fork / "origin" / "state.npz")
    assert len(run.lives)
    with pytest.raises(Trouble, match=r"origin/state\.npz was changed or damaged"):
        _ = run.origin


def test_a_fork_with_damaged_records_is_read_as_it_began(fork: Path) -> None:
    flip(fork / "births" / "000000.parquet")
    run = Archive(fork)
    _, faults = run.newest
    assert "births/000000.parquet was changed or damaged" in faults[0]
    assert run.ends.tolist() == [250, 250]
    assert (run.lives.born <= 250).all()
