"""Runs as notebooks show them: every text of a run is text, whatever it says."""

from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import pytest

import primordia
from primordia.api import notebook
from primordia.errors import Trouble
from primordia.experiments.status import ArmStatus, CampaignStatus
from primordia.runs import loop
from tests.worlds import CLOCKWORK, config

SCRIPT = "<script>alert(1)</script>&amp;\"'"


class Parts(HTMLParser):
    """The elements of a text in HTML, and the texts in them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[str] = []
        self.texts: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append(tag)
        if tag in ("th", "td", "p"):
            self.texts.append("")

    def handle_data(self, data: str) -> None:
        self.texts[-1] += data


TABLE = {"p", "strong", "table", "thead", "tbody", "tr", "th", "td"}


def shown(part: Any) -> Parts:
    """Return what a notebook shows of an object; nothing of it is more than a table."""
    parts = Parts(part._repr_html_())
    assert set(parts.elements) <= TABLE
    return parts


def test_a_run_is_a_table_of_its_worlds(tmp_path: Path) -> None:
    loop.start(config({**CLOCKWORK, "task": SCRIPT, "stop": {"ticks": 300}}), tmp_path / "run")
    run = primordia.load(tmp_path / "run")
    parts = shown(run)
    assert parts.texts[0] == f"{SCRIPT}: 2 worlds of 16 cells"
    assert parts.elements.count("tr") == 1 + 2
    rows = [parts.texts[1:][i : i + 8] for i in range(0, 8 * 3, 8)]
    worlds = run.info()["worlds"]
    for row, world in zip(rows[1:], worlds, strict=True):
        assert row[:4] == [f"{world[name]:,}" for name in ("seed", "ticks", "births", "alive")]


def test_a_run_that_cannot_be_read_shows_the_error(tmp_path: Path) -> None:
    place = tmp_path / "<script>"
    assert shown(primordia.api.Run(place)).texts == [
        f"{place} is not a run of primordia: it has no readable versions.json"
    ]


def test_a_damaged_run_shows_the_damage(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(primordia.Run, "info", MagicMock(side_effect=Trouble("births are damaged")))
    assert shown(primordia.Run(Path("run"))).texts == ["births are damaged"]


def test_each_column_has_the_number_that_its_title_names() -> None:
    numbers = "seed", "ticks", "births", "alive", "mean_age", "oldest_age"
    world: dict[str, Any] = {name: 1000.25 * number for number, name in enumerate(numbers, 1)}
    world |= {"seed": 1000, "deaths_by_cause": {"fatal": 2345, "hazard": 0, "starved": 1}}
    world |= {"saturation": {"tick": 7000, "births": 8000}}
    parts = Parts(notebook.of_run({"task": "x", "cells": 1024, "worlds": [world]}))
    head = ["seed", "ticks", "births", "alive", "mean age", "oldest", "deaths", "saturated at tick"]
    row = ["1000", "2,000", "3,001", "4,001", "5,001", "6,002", "2,345 fatal, 1 starved", "7,000"]
    assert parts.texts == ["x: 1 world of 1,024 cells", *head, *row]
    world |= {"alive": 0, "mean_age": None, "oldest_age": None, "saturation": None}
    new = {**world, "ticks": 0, "alive": 1, "mean_age": 0.0, "oldest_age": 0, "deaths_by_cause": {}}
    parts = Parts(notebook.of_run({"task": "x", "cells": 1024, "worlds": [world, new]}))
    empty = ["1000", "2,000", "3,001", "0", "", "", "2,345 fatal, 1 starved", ""]
    assert parts.texts[0] == "x: 2 worlds of 1,024 cells"
    assert parts.texts[9:] == [*empty, "1000", "0", "3,001", "1", "0", "0", "", ""]


@pytest.mark.parametrize("count", [notebook.MOST, notebook.MOST + 1, notebook.MOST + 1200])
def test_the_rows_that_are_not_listed_are_counted(count: int) -> None:
    parts = Parts(notebook.table("x", ["y"], [[str(number)] for number in range(count)]))
    listed = list(map(str, range(notebook.MOST)))
    more = [f"and {count - notebook.MOST:,} more"] if count > notebook.MOST else []
    assert parts.texts == ["x", "y", *listed, *more]


def test_an_experiment_is_a_table_of_its_arms() -> None:
    arms = (ArmStatus(SCRIPT, 5, 4, 3, 1234.5, None), ArmStatus("none", 5, 0, 0, None, None))
    jobs = {"done": 9, "running": 1, "failed": 0, "waiting": 0}
    parts = Parts(notebook.of_experiment(CampaignStatus(f"Why? {SCRIPT}", jobs, arms, (), ())))
    assert set(parts.elements) <= TABLE
    assert parts.texts[0] == f"Why? {SCRIPT} Jobs: 9 done, 1 running"
    assert parts.texts[1:6] == ["arm", "worlds", "begun", "saturated", "ticks lived for each death"]
    assert parts.texts[6:] == [SCRIPT, "5", "4", "3", "1,234", "none", "5", "0", "0", ""]
