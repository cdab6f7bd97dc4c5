"""Runs of an arm: they must have the same settings, description and founders, but other worlds."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.brains.genomes import FOUNDERS
from primordia.errors import InputError
from primordia.runs.arm import arm
from primordia.runs.description import Description
from tests.worlds import MEADOW, config


def run_of(path: Path, changes: dict[str, Any], about: dict[str, Any], seed: int = 3) -> Any:
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
    runs = [run_of(Path("a"), *first), run_of(Path("b"), *first, seed=10)]
    runs.append(run_of(Path("c"), *last, seed=20))
    if differs is None:
        assert arm(Path("arm"), runs).runs == tuple(runs)
        return
    with pytest.raises(InputError) as raised:
        arm(Path("arm"), runs)
    says = f"c and a do not belong to one arm: they differ in {differs}"
    assert str(raised.value).startswith(says)


def test_forks_of_an_arm_begin_at_one_tick_but_may_have_different_sources() -> None:
    of = {"run": "another", "tick": 9}
    runs = [run_of(Path(name), {"fork": each}, {}, seed)
            for name, each, seed in (("a", FORKED, 1), ("b", of, 2))]  # fmt: skip
    assert arm(Path("arm"), runs).runs == tuple(runs)
    later = run_of(Path("c"), {"fork": {"run": "source", "tick": 10}}, {}, 3)
    with pytest.raises(InputError, match=r"^c and a .* they differ in fork\.tick$"):
        arm(Path("arm"), [*runs, later])


def test_runs_of_an_arm_begin_with_the_same_genomes(tmp_path: Path) -> None:
    """Each run has its own file of genomes, with the same name."""
    runs = []
    for seed, content in enumerate([b"1", b"1", b"2"]):
        runs.append(run_of(tmp_path / str(seed), {}, {}, seed))
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
    runs = [run_of(Path(str(seed)), {"seeds": seeds}, {}, seed)
            for seed, seeds in ((10, 1), (20, 3), (30, 2), (40, 1))]  # fmt: skip
    joined = arm(Path("arm"), runs)
    assert joined.firsts.tolist() == [0, 1, 4, 6]
    assert joined.config.seeds == 7
    np.testing.assert_array_equal(joined.world_seeds, [10, 20, 21, 22, 30, 31, 40])
