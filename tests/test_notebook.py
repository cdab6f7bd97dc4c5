"""Runs as notebooks show them: the words of `primordia info`."""

from pathlib import Path

from IPython.lib.pretty import pretty

import primordia
from primordia.history.summary import summary
from primordia.runs import loop
from tests.worlds import HERD, config


def test_a_run_is_shown_by_its_summary(tmp_path: Path) -> None:
    """Control characters are spelled out."""
    name = "\x1b[31mred"
    loop.start(config({**HERD, "task": name, "stop": {"ticks": 100}}), tmp_path / "run")
    run = primordia.load(tmp_path / "run")
    assert pretty(run) == summary(run.info()).replace("\x1b", "\\x1b")
    assert "3 worlds of 24 cells" in pretty(run)


def test_a_run_that_cannot_be_read_shows_the_error(tmp_path: Path) -> None:
    place = tmp_path / "none"
    assert pretty(primordia.api.Run(place)) == (
        f"{place} is not a run of primordia: it has no readable versions.json"
    )
