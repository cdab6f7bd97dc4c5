"""Several runs read as one arm tell what one run of the same worlds tells."""

from dataclasses import fields
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.api import Run
from primordia.brains import genomes
from primordia.errors import InputError
from primordia.history.foraging import foraging
from primordia.history.pedigree import genomes as genomes_of
from primordia.runs import loop
from primordia.runs.opening import opened, split_name
from primordia.runs.schema import TABLES
from tests.commands import complains, here
from tests.worlds import MILLS, config

SETTINGS: dict[str, Any] = {**MILLS, "seeds": 1, "seed": 3, "stop": {"ticks": 400}}
JOBS = {"b": 0, "a": 1}
"""Names of runs, with their worlds; by name they are in another order."""


def start(run: Path, first: int, worlds: int = 1) -> None:
    loop.start(config(SETTINGS, seed=SETTINGS["seed"] + first, seeds=worlds), run)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make two worlds in one run, `whole`, and in two, `arm`, and forks of these."""
    folder = tmp_path_factory.mktemp("runs")
    start(folder / "whole", 0, 2)
    primordia.load(folder / "whole").fork(250, folder / "forked" / "whole", seed=80)
    for name, first in JOBS.items():
        start(folder / "arm" / name, first)
        primordia.load(folder / "arm" / name).fork(
            250, folder / "forked" / "arm" / name, seed=80 + first
        )
    return folder


@pytest.fixture(params=["", "forked"], ids=["begun", "forked"])
def both(runs: Path, request: pytest.FixtureRequest) -> tuple[Run, Run]:
    """Return the same worlds as one run and as an arm of two."""
    folder = runs / request.param
    return primordia.load(folder / "whole"), primordia.load(folder / "arm")


def test_an_arm_has_the_numbers_rows_lives_and_food_of_one_run(both: tuple[Run, Run]) -> None:
    whole, arm = (run.info() | {"wall_s": None} for run in both)
    assert len(arm["worlds"]) == 2
    assert arm == whole
    for name in TABLES:
        one, other = (run.table(name) for run in both)
        columns = ("world", "tick") if name == "metrics" else ("world", "tick", "id")
        key = [(each, "ascending") for each in columns]
        assert other.sort_by(key) == one.sort_by(key)
        assert len(both[1].opened().table(name, ["tick"])) == len(other)
    one, other = (run.lives() for run in both)
    for each in fields(one):
        np.testing.assert_array_equal(getattr(other, each.name), getattr(one, each.name))
    for mean, same in zip(*(foraging(run.opened()) for run in both), strict=True):
        np.testing.assert_array_equal(same, mean)


def test_organisms_of_an_arm_are_those_of_one_run(both: tuple[Run, Run]) -> None:
    """In the last world, which is the first of its run: genome, games, and a life lived again."""
    whole, arm = (run.oldest(1) for run in both)
    assert repr(arm) == repr(whole)
    rows = np.arange(0, len(both[0].lives()), 40)
    one, other = (genomes_of(run.opened(), rows) for run in both)
    np.testing.assert_array_equal(other, one)
    results = (each.evaluate(games=3, ticks=50).to_dict() for each in (whole, arm))
    assert next(results) == next(results)


def test_an_exported_genome_tells_the_seed_of_its_own_world(
    both: tuple[Run, Run], tmp_path: Path
) -> None:
    for run, world in product(both, range(2)):
        (number,) = run.export(tmp_path / "x.safetensors", world=world)
        seed = str(run.opened().world_seeds[world])
        about = {"task": "mill", "seed": seed, "organisms": str(number)}
        assert genomes.about(tmp_path / "x.safetensors") == about


def test_runs_are_compared_as_arms(runs: Path) -> None:
    start(runs / "other-1", 50)
    start(runs / "other-2", 70)
    compared = primordia.compare(f"mild={runs / 'whole'}", f"later={runs}/other-*")
    again = primordia.compare(runs / "arm", primordia.load([runs / "other-2", runs / "other-1"]))
    assert [arm.name for arm in compared.arms] == ["mild", "later"]
    assert [arm.worlds for arm in compared.arms] == [2, 2]
    assert compared.arms[1].settings == {"seed": 53}
    for one, other in zip(compared.arms, again.arms, strict=True):
        for outcome, measured in one.measured.items():
            np.testing.assert_array_equal(other.measured[outcome].value, measured.value)


def test_a_name_is_told_from_a_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a=b").mkdir()
    assert split_name("a=b") == (None, "a=b")
    assert split_name("a=c=d") == ("a", "c=d")
    assert split_name("runs/a=c") == (None, "runs/a=c")


def test_what_is_no_arm_is_refused(runs: Path, tmp_path: Path) -> None:
    start(tmp_path / "again", 1)
    one = runs / "arm" / "a"
    says = f"^{one} and {tmp_path / 'again'} both hold the world of seed 4$"
    with pytest.raises(InputError, match=says):
        opened([runs / "arm" / "b", one, tmp_path / "again"])
    with pytest.raises(InputError, match="given twice"):
        primordia.compare(runs / "arm", one)
    single = f"is an arm of 2 runs, but a single run is needed here, such as {one}"
    complains(here("resume", runs / "arm"), 2, single)
    complains(here("verify", runs / "arm"), 2, "is an arm of 2 runs")
    complains(here("fork", runs / "arm", "--at", "9"), 2, "is an arm of 2 runs")
