"""The commands `primordia assay ...`, on a run that lived."""

import json
from pathlib import Path

import pytest

import primordia
from primordia.runs import loop
from tests.commands import here
from tests.worlds import HERD, config


@pytest.mark.parametrize(
    ("name", "words"), [("heredity", "slope"), ("threshold", "s (1 - p (1 - v))")]
)
def test_assays_of_records_tell_what_python_returns(
    name: str, words: str, poles: primordia.Run
) -> None:
    told = json.loads(here("assay", name, poles.path, "--after", "0.25", "--json").stdout)
    found = getattr(poles, name)(0.25)
    assert told == {str(poles.path): [each.to_dict() for each in found]}
    assert [each.world for each in found] == [0, 1]
    table = here("assay", name, poles.path).stdout
    assert words in table
    assert "2 worlds" in table


@pytest.mark.slow
def test_where_death_ignores_the_genome_nothing_is_inherited(tmp_path: Path) -> None:
    """Only accidents kill in this meadow: mutants are as good as copies, and no line is better."""
    loop.start(config(HERD, hazard=0.05, replication=0.3, stop={"ticks": 800}), tmp_path / "run")
    run = primordia.load(tmp_path / "run")
    for world in run.heredity(0.1):
        assert world.both.pairs > 200
        assert world.both.slope == pytest.approx(0, abs=0.2)
    for world in run.threshold(0.1):
        assert world.advantage == pytest.approx(1, abs=0.5)


@pytest.mark.slow
def test_any_genome_file_can_be_assayed(poles: primordia.Run, tmp_path: Path) -> None:
    file = tmp_path / "some.safetensors"
    poles.export(file, 3, 4)
    options = ("--games", 1, "--ticks", 60, "--json")
    told = here("assay", "ablate", file, 1, "--angle_limit", 5.0, *options)
    found = json.loads(told.stdout)[str(file)]
    assert {(each["organism"], each["world"]) for each in found} == {(1, 0)}
    whole = json.loads(here("assay", "ablate", file, *options).stdout)[str(file)]
    assert {each["organism"] for each in whole} == {0, 1}


def test_wrong_words_are_one_line(poles: primordia.Run, tmp_path: Path) -> None:
    file = tmp_path / "some.safetensors"
    poles.export(file, 3)
    for words, message in (
        (("effects", file, "--world", 1), "has no worlds; leave out --world"),
        (("effects", poles.path, "--task", "CartPole-survival"), "leave out --task"),
        (("effects", poles.path, 10**6), "no organism"),
        (("line", file), "is neither a run of primordia"),
        (("ablate", poles.path, "--wind", 3), "this run's habitat has no setting 'wind'"),
    ):
        done = here("assay", *words)
        assert done.returncode == 2
        assert message in done.stderr
        assert done.stderr.count("\n") == 1
