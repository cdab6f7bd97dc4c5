"""The commands `primordia assay transplant` and `generalists`, on a run that lived."""

import json
from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia.assays.generalists import generalists
from primordia.assays.transplant import transplant
from primordia.runs import loop
from tests.commands import complains, here
from tests.engine.test_islands import WHEELS
from tests.worlds import config

OPTIONS = ("--each", 3, "--games", 1, "--ticks", 40)


@pytest.fixture(scope="module")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Return two worlds of three islands, with two habitats."""
    path = tmp_path_factory.mktemp("islands") / "wheels"
    loop.start(config(WHEELS, stop={"ticks": 200}), path)
    return primordia.load(path)


@pytest.mark.parametrize("name", ["transplant", "generalists"])
def test_assays_of_islands_tell_what_python_returns(
    name: str, wheels: primordia.Run, tmp_path: Path
) -> None:
    most: list[Any] = ["--most", 4] if name == "generalists" else []
    told = here("assay", name, wheels.path, *OPTIONS, *most, "--out", tmp_path, "--json")
    assert told.returncode == 0, told.stderr
    run, manner = wheels.opened(), {"each": 3, "games": 1, "ticks": 40}
    found: list[Any] = {
        "transplant": lambda: transplant(run, **manner),
        "generalists": lambda: generalists(run, **manner, most=4),
    }[name]()
    expected = json.loads(json.dumps([each.to_dict() for each in found]))
    assert json.loads(told.stdout) == {str(wheels.path): expected}
    assert (tmp_path / f"{name}.png").stat().st_size > 5000
    table = here("assay", name, wheels.path, *OPTIONS, *most)
    assert str(wheels.path) in table.stdout
    assert "watch" in table.stdout


@pytest.mark.parametrize("name", ["transplant", "generalists"])
def test_a_run_without_islands_is_refused_in_one_line(name: str, poles: primordia.Run) -> None:
    complains(here("assay", name, poles.path), 2, "its worlds have no islands")
