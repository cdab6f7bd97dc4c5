"""The commands `primordia assay ...`, on a run that lived."""

import json

import pytest

import primordia
from primordia.runs import loop
from tests.commands import here
from tests.worlds import MEADOW, config

SETTINGS = {**MEADOW, "brain": {"hidden": 3}, "hazard": 0.05, "replication": 0.3, "seeds": 3}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    path = tmp_path_factory.mktemp("assays") / "run"
    loop.start(config(SETTINGS, stop={"ticks": 800}), path)
    return primordia.load(path)


@pytest.mark.parametrize("name", ["heredity", "threshold"])
def test_json_holds_what_python_returns(name: str, run: primordia.Run) -> None:
    told = json.loads(here("assay", name, run.path, "--after", "0.25", "--json").stdout)
    found = getattr(run, name)(0.25)
    assert told == {str(run.path): [each.to_dict() for each in found]}
    assert [each.world for each in found] == [0, 1, 2]


def test_where_death_ignores_the_genome_nothing_is_inherited(run: primordia.Run) -> None:
    """Only accidents kill in this meadow: mutants are as good as copies, and no line is better."""
    for world in run.heredity(0.1):
        assert world.both.pairs > 200
        assert world.both.slope == pytest.approx(0, abs=0.2)
    for world in run.threshold(0.1):
        assert world.advantage == pytest.approx(1, abs=0.5)


@pytest.mark.parametrize(
    ("name", "words"), [("heredity", "slope"), ("threshold", "s (1 - p (1 - v))")]
)
def test_the_table_names_its_rows(name: str, words: str, run: primordia.Run) -> None:
    done = here("assay", name, run.path)
    assert done.returncode == 0
    assert words in done.stdout
    assert "3 worlds" in done.stdout
