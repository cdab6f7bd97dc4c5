"""Paths that a user names: which runs are there, in which order, and messages if none is there."""

from glob import glob
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.errors import InputError
from primordia.runs import opening
from primordia.runs.archive import run_of
from primordia.runs.arm import _refuse_twice
from primordia.runs.manifest import Progress
from primordia.runs.opening import arm_paths, only, run_paths
from primordia.runs.records import Records, _Joined, _shifted
from primordia.settings.limits import Stop
from tests.synthetic import worlds_of


def begun(path: Path, *, checkpoint: str | None = "checkpoints/000000") -> Path:
    """Make a folder that is found as a run."""
    path.mkdir(parents=True)
    (path / "versions.json").write_text("{}")
    if checkpoint is not None:
        (path / checkpoint).mkdir(parents=True)
    return path


def test_a_folder_of_runs_gives_those_with_a_checkpoint_in_order_of_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The origin of a fork counts as a checkpoint. The path of a run, or of nothing, gives itself."""
    # A file system may give names in any order.
    monkeypatch.setattr(opening, "glob", lambda place: sorted(glob(place), reverse=True))
    b, c = begun(tmp_path / "arm" / "b"), begun(tmp_path / "arm" / "c", checkpoint="origin")
    a = begun(tmp_path / "arm" / "a")
    begun(tmp_path / "arm" / "d", checkpoint=None)
    (tmp_path / "arm" / "mine").mkdir()
    assert run_paths(tmp_path / "arm") == [a, b, c]
    assert run_paths(a) == [a]
    assert run_paths(tmp_path / "arm" / "d") == [tmp_path / "arm" / "d"]
    assert run_paths(tmp_path / "nothing") == [tmp_path / "nothing"]
    other = begun(tmp_path / "arm2" / "z")
    assert run_paths(tmp_path / "arm*") == [a, b, c, other]
    assert run_paths(tmp_path / "arm" / "[bc]") == [b, c]
    with pytest.raises(InputError, match=r"^there is no run "):
        run_paths(tmp_path / "x*")
    begun(tmp_path / "new" / "a", checkpoint=None)
    with pytest.raises(InputError, match="new has no checkpoint of any of its runs yet"):
        run_paths(tmp_path / "new")
    with pytest.raises(
        InputError, match=f"^{tmp_path / 'arm'} is an arm of 3 runs, .* such as {a}$"
    ):
        only([tmp_path / "arm"])


def test_an_experiment_names_its_arms(tmp_path: Path) -> None:
    (tmp_path / "experiment.toml").touch()
    (tmp_path / "notes").mkdir()
    with pytest.raises(InputError, match=r"is an experiment; .*: none has begun yet$"):
        run_paths(tmp_path)
    for arm in ("mild", "harsh"):
        begun(tmp_path / arm / "1", checkpoint=None)
    assert arm_paths(tmp_path) == [tmp_path / "harsh", tmp_path / "mild"]
    with pytest.raises(InputError, match=f"arms: {tmp_path / 'harsh'}, {tmp_path / 'mild'}$"):
        run_paths(tmp_path)


def test_runs_of_an_arm_are_in_order_of_seeds_and_the_arm_has_a_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seeds = {"a": 9, "b": 2, "c": 5}
    paths = [begun(tmp_path / "arm" / name) for name in seeds]

    def archive(path: Path) -> Any:
        return SimpleNamespace(config=SimpleNamespace(seed=seeds[path.name]), path=path)

    monkeypatch.setattr(opening, "archive", archive)
    monkeypatch.setattr(opening, "arm", lambda path, runs: (path, [run.path.name for run in runs]))
    order = ["b", "c", "a"]
    assert opening.opened([tmp_path / "arm"]) == (tmp_path / "arm", order)
    assert opening.opened(paths) == (paths[0], order)
    assert opening.opened(paths, "mine") == (Path("mine"), order)
    assert opening.opened(paths[:1], "mine") == (Path("mine"), ["a"])
    assert opening.opened(paths[:1]).path == paths[0]


def invented(path: str, worlds: int, start: int) -> Any:
    """Return a run of some worlds with two cells each, with arrays and no records."""
    limits = Stop(ticks=9, births=start or None, until=None)
    state: dict[str, np.ndarray] = {
        "world.worlds.calm": np.arange(start, start + worlds, dtype=np.int32),
        "world.organisms.energy": np.arange(2 * start, 2 * (start + worlds)),
        "tail.births": np.zeros((worlds, 3), np.uint32),
    }
    return SimpleNamespace(
        path=Path(path), config=SimpleNamespace(seeds=worlds), state=state,
        origin={name: -array for name, array in state.items()}, release=lambda: None,
        progress=Progress(limits=limits, wall_s=2, exact=path != "b", restarts=1),
        versions={"jax": "1", path: "2"}, damaged=[f"{path} 1", f"{path} 2"],
        row_digests={"births": np.full((worlds, 2), start)},
        lives=worlds_of(*[[(0, 9, True)]] * worlds, until=9),
        segments=lambda *_: [pa.table({"world": pa.array(range(worlds), pa.int32())})],
    )  # fmt: skip


RUNS = [invented("a", 2, 0), invented("b", 3, 2), invented("c", 1, 5)]
"""Runs with unequal numbers of worlds."""
FIRSTS = np.array([0, 2, 5])


@pytest.mark.parametrize(("which", "kept"), [("state", [1, 1, 0]), ("origin", [])])
def test_arrays_of_unequal_runs_are_joined_world_by_world(which: Any, kept: list[int]) -> None:
    """The runs that were read before, and their order, make no difference."""
    joined, sign = _Joined(RUNS, FIRSTS, which), 1 if which == "state" else -1
    for number in kept:
        joined.keep(number)
    assert joined["world.worlds.calm"].tolist() == [sign * n for n in range(6)]
    assert joined["world.worlds.calm"].dtype == np.int32
    assert joined["world.organisms.energy"].tolist() == [sign * n for n in range(12)]
    assert list(joined) == ["world.worlds.calm", "world.organisms.energy"]
    assert len(joined) == 2
    for name in ("tail.births", "other"):
        with pytest.raises(KeyError):
            joined[name]


def test_an_arm_has_the_versions_damage_rows_and_lives_of_all_its_runs() -> None:
    arm: Any = Records.__new__(Records)
    arm.path, arm._runs, arm.firsts = Path("arm"), (*RUNS,), FIRSTS
    assert arm.versions == {"jax": "1", "a": "2, none", "b": "none, 2", "c": "none, 2"}
    limits = Stop(ticks=9, births=None, until=None)  # those that all runs share
    assert arm.progress == Progress(limits=limits, wall_s=6, exact=False, restarts=3)
    assert arm.damaged == ["a 1", "a 2", "b 1", "b 2", "c 1", "c 2"]
    assert arm.row_digests["births"][:, 1].tolist() == [0, 0, 2, 2, 2, 5]
    assert arm.paths == (Path("a"), Path("b"), Path("c"))
    assert arm.table("births")["world"].to_pylist() == arm.lives.world.tolist() == [*range(6)]
    found = [run_of(arm, world) for world in range(6)]
    assert [run.path.name for run, _ in found] == ["a", "a", "b", "b", "b", "c"]
    assert [world for _, world in found] == [0, 1, 0, 1, 2, 0]


def test_rows_of_a_later_run_have_later_worlds() -> None:
    part = pa.table({"id": [4, 5], "world": pa.array([0, 1], pa.int32())})
    assert _shifted(part, 0) is part
    moved = _shifted(part, 3)
    assert moved.schema == part.schema
    assert moved.to_pydict() == {"id": [4, 5], "world": [3, 4]}
    assert _shifted(part.select(["id"]), 3).to_pydict() == {"id": [4, 5]}


def test_an_arm_has_no_more_worlds_than_its_arrays_can_number(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("primordia.runs.arm.MOST", 6)
    _refuse_twice(RUNS, np.arange(6, dtype=np.uint64))
    monkeypatch.setattr("primordia.runs.arm.MOST", 5)
    with pytest.raises(InputError, match=r"^an arm has at most 5 worlds, not 6$"):
        _refuse_twice(RUNS, np.arange(6, dtype=np.uint64))
