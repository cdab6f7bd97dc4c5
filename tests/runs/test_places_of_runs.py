"""Paths that a user names: which runs are there, in which order, and messages if none is there.

Runs of an arm must have the same settings, description and founders, but other worlds.
"""

from glob import glob
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.brains.genomes import FOUNDERS
from primordia.errors import InputError
from primordia.runs import opening
from primordia.runs.archive import run_of
from primordia.runs.arm import _refuse_twice, arm
from primordia.runs.description import Description
from primordia.runs.manifest import Progress
from primordia.runs.opening import arm_paths, only, run_paths
from primordia.runs.records import Records, _Joined
from primordia.settings.limits import Stop
from tests.synthetic import worlds_of
from tests.worlds import MEADOW, config


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
    for name in ("mild", "harsh"):
        begun(tmp_path / name / "1", checkpoint=None)
    assert arm_paths(tmp_path) == [tmp_path / "harsh", tmp_path / "mild"]
    with pytest.raises(InputError, match=f"arms: {tmp_path / 'harsh'}, {tmp_path / 'mild'}$"):
        run_paths(tmp_path)


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
    several: Any = Records.__new__(Records)
    several.path, several._runs, several.firsts = Path("arm"), (*RUNS,), FIRSTS
    assert several.versions == {"jax": "1", "a": "2, none", "b": "none, 2", "c": "none, 2"}
    limits = Stop(ticks=9, births=None, until=None)  # those that all runs share
    assert several.progress == Progress(limits=limits, wall_s=6, exact=False, restarts=3)
    assert several.damaged == ["a 1", "a 2", "b 1", "b 2", "c 1", "c 2"]
    assert several.row_digests["births"][:, 1].tolist() == [0, 0, 2, 2, 2, 5]
    assert several.paths == (Path("a"), Path("b"), Path("c"))
    assert (
        several.table("births")["world"].to_pylist() == several.lives.world.tolist() == [*range(6)]
    )
    assert several.lives.world.dtype == np.int32
    found = [run_of(several, world) for world in range(6)]
    assert [run.path.name for run, _ in found] == ["a", "a", "b", "b", "b", "c"]
    assert [world for _, world in found] == [0, 1, 0, 1, 2, 0]


def test_an_arm_has_no_more_worlds_than_its_arrays_can_number(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("primordia.runs.arm.MOST", 6)
    _refuse_twice(RUNS, np.arange(6, dtype=np.uint64))
    monkeypatch.setattr("primordia.runs.arm.MOST", 5)
    with pytest.raises(InputError, match=r"^an arm has at most 5 worlds, not 6$"):
        _refuse_twice(RUNS, np.arange(6, dtype=np.uint64))


def meadow_at(path: Path, changes: dict[str, Any], about: dict[str, Any], seed: int = 3) -> Any:
    """Return a run of the meadow without records, with changed settings and a changed description."""
    settings = config(MEADOW, **{"seed": seed, **changes})
    described: dict[str, Any] = {
        "rate": 50.0, "tallies": ("score",), "notes": (), "beginning": {"hazard": 0.0},
        "blocks": {"input": (4, 5)}, "code": {"pond.py": "1"}, **about,
    }  # fmt: skip
    return SimpleNamespace(
        path=path, config=settings, description=Description(**described),
        world_seeds=settings.world_seeds,
    )  # fmt: skip


FORKED = {"run": "source", "tick": 9}


@pytest.mark.parametrize(
    ("changes", "about", "differs"),
    [
        ({}, {}, None),
        ({"about": "another", "stop": {"ticks": 5, "births": 7}, "seeds": 3}, {}, None),
        ({"hazard": 0.5, "replication": 0.5}, {}, "replication"),
        ({"mutation": {"blocks": {"input": {"scale": 0.5}}}}, {}, "mutation.blocks.input.scale"),
        ({}, {"blocks": {"input": (4, 5), "output": (2,)}}, "blocks.output"),
        ({}, {"code": {"pond.py": "2"}}, "code.pond.py"),
    ],
)
@pytest.mark.parametrize("turned", [False, True])
def test_the_first_setting_in_which_runs_differ_is_named(
    changes: dict[str, Any], about: dict[str, Any], differs: str | None, turned: bool
) -> None:
    """A setting may be missing in the first runs, or in the last one."""
    none: dict[str, Any] = {}
    first, last = ((changes, about), (none, none))[:: 1 if turned else -1]
    runs = [meadow_at(Path("a"), *first), meadow_at(Path("b"), *first, seed=10)]
    runs.append(meadow_at(Path("c"), *last, seed=20))
    if differs is None:
        assert arm(Path("arm"), runs).runs == tuple(runs)
        return
    with pytest.raises(InputError) as raised:
        arm(Path("arm"), runs)
    says = f"c and a do not belong to one arm: they differ in {differs}"
    assert str(raised.value).startswith(says)


def test_forks_of_an_arm_begin_at_one_tick_but_may_have_different_sources() -> None:
    of = {"run": "another", "tick": 9}
    runs = [meadow_at(Path(name), {"fork": each}, {}, seed)
            for name, each, seed in (("a", FORKED, 1), ("b", of, 2))]  # fmt: skip
    assert arm(Path("arm"), runs).runs == tuple(runs)
    later = meadow_at(Path("c"), {"fork": {"run": "source", "tick": 10}}, {}, 3)
    with pytest.raises(InputError, match=r"^c and a .* they differ in fork\.tick$"):
        arm(Path("arm"), [*runs, later])


def test_runs_of_an_arm_begin_with_the_same_genomes(tmp_path: Path) -> None:
    """Each run has its own file of genomes, with the same name."""
    runs = []
    for seed, content in enumerate([b"1", b"1", b"2"]):
        runs.append(meadow_at(tmp_path / str(seed), {}, {}, seed))
        own = (str(runs[-1].path / FOUNDERS),)
        runs[-1].config = runs[-1].config.model_copy(update={"ancestors": own})
        runs[-1].path.mkdir()
        (runs[-1].path / FOUNDERS).write_bytes(content)
    assert arm(tmp_path, runs[:2]).config.seeds == 2
    says = f"{tmp_path / '2'} and {tmp_path / '0'} do not belong to one arm: they differ in genomes"
    with pytest.raises(InputError, match=f"^{says}$"):
        arm(tmp_path, runs)


def test_worlds_of_an_arm_are_counted_run_by_run() -> None:
    """The runs have different numbers of worlds."""
    runs = [meadow_at(Path(str(seed)), {"seeds": seeds}, {}, seed)
            for seed, seeds in ((10, 1), (20, 3), (30, 2), (40, 1))]  # fmt: skip
    joined = arm(Path("arm"), runs)
    assert joined.firsts.tolist() == [0, 1, 4, 6]
    assert joined.config.seeds == 7
    np.testing.assert_array_equal(joined.world_seeds, [10, 20, 21, 22, 30, 31, 40])
