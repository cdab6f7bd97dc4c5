"""Comparison of runs: figures against brute force, the command, and what the command refuses."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.comparison.comparison import Comparison
from primordia.comparison.measured import Measured
from primordia.experiments import results
from primordia.figures import style
from primordia.figures.comparison import draw
from primordia.runs import loop
from tests.commands import complains, here
from tests.comparison.test_survival import restricted_mean
from tests.worlds import RING, config

QUICK: dict[str, Any] = {
    **RING,
    "replication": 0.2,
    "hazard": 0.006,
    "stop": {"ticks": 600, "until": "saturation"},
}
"""An end by which some worlds are saturated and some are not."""
WORLDS = RING["seeds"]


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Make three runs of one task; in the last, worlds live until they saturate."""
    folder = tmp_path_factory.mktemp("runs")
    changes: dict[str, dict[str, Any]] = {
        "one": {},
        "another": {"seed": 100},
        "patient": {"seed": 200, "stop": {"until": "saturation"}},
    }
    for name, change in changes.items():
        loop.start(config({**QUICK, **change}), folder / name)
    return [folder / name for name in changes]


@pytest.fixture(scope="module")
def compared(runs: list[Path]) -> Comparison:
    return primordia.compare(*runs)


def test_figures_of_worlds_equal_those_of_brute_force(
    runs: list[Path], compared: Comparison
) -> None:
    seen = 0
    for path, arm in zip(runs, compared.arms, strict=True):
        run = primordia.Run(path)
        worlds = run.info()["worlds"]
        born, died = (run.table(name).to_pylist() for name in ("births", "deaths"))
        for number, world in enumerate(worlds):
            moment = world["saturation"]
            for unit, key in (("births", "births"), ("ticks", "tick")):
                value = arm.measured[unit].value[number]
                assert arm.measured[unit].known[number] == (moment is not None)
                assert value == (moment[key] if moment else world[unit])
            ends = {row["id"]: row["tick"] for row in died if row["world"] == number}
            lives = [
                (ends.get(row["id"], world["ticks"]) - row["tick"], row["id"] in ends)
                for row in born
                if row["world"] == number
            ]
            age = QUICK["saturation_ticks"]
            long = [lived >= age for lived, _ in lives]
            undecided = [lived < age and not dead for lived, dead in lives]
            first = arm.measured["first"]
            before = int(first.value[number]) - 1
            assert not any(long[:before] + undecided[:before])
            assert long[before] if first.known[number] else [*undecided, True][before]
            mean = restricted_mean(lives, age)
            assert arm.measured["lifespan"].value[number] == pytest.approx(mean)
            seen += len(lives)
        assert arm.saturated == sum(world["saturation"] is not None for world in worlds)
    assert seen > 300
    assert [arm.worlds for arm in compared.arms] == [WORLDS] * 3
    assert compared.arms[2].saturated == WORLDS
    assert "food" not in compared.outcomes, "these worlds have no metabolism"
    assert any(0 < arm.saturated < WORLDS for arm in compared.arms[:2])


def test_the_command_shows_tables_and_draws_a_figure(runs: list[Path], tmp_path: Path) -> None:
    done = here("compare", *runs, "--out", tmp_path / "new")
    assert done.returncode == 0, done.stderr
    words = "one", "another", "patient", "births to saturation", "mean lifespan", "reference"
    for word in (*words, "Intervals need 6 worlds of each run (--seeds 6): one has 4"):
        assert word in done.stdout
    for name in ("compare.png", "compare.svg"):
        assert (tmp_path / "new" / name).stat().st_size > 10_000
        assert str(tmp_path / "new" / name) in done.stdout


def test_one_arm_has_results_without_effects(runs: list[Path], tmp_path: Path) -> None:
    arm = primordia.load(runs[0]).opened()
    page, sheet, picture = results.write(tmp_path / "results", "Is it long?", [arm])
    title, _, summary, note, made = page.read_text().split("\n\n")
    assert (title, note) == ("# Is it long?", " ".join(results.NOTES))
    assert summary.splitlines()[2].startswith(f"| one | {WORLDS} |")
    assert made.startswith("Run on ")
    assert len(sheet.read_text().splitlines()) == 1 + WORLDS
    assert picture.stat().st_size > 10_000


def test_runs_that_cannot_be_compared_are_refused(runs: list[Path], tmp_path: Path) -> None:
    """`test_comparison.py` has the runs that do not fit together."""
    complains(here("compare"), 2, "two or more runs")
    complains(here("compare", runs[0]), 2, "two or more runs")
    complains(here("compare", f"a={runs[0]}", f"a={runs[1]}"), 2, "two runs are named a")
    complains(here("compare", *runs, "--ticks", 601), 2, "--ticks 601", "stopped at 600")
    complains(here("compare", *runs, "--births", 0), 2, "--births")
    complains(here("compare", runs[0], tmp_path), 2, f"{tmp_path} is not a run")
    for name in ("config.toml", "versions.json"):
        (tmp_path / name).write_bytes((runs[0] / name).read_bytes())
    complains(here("compare", runs[0], tmp_path), 2, "no checkpoint yet")


@pytest.mark.usefixtures("_laid_out")
@pytest.mark.parametrize(("saturated", "fed"), [(0, False), (WORLDS, True)])
def test_everything_that_is_drawn_is_within_the_page(
    compared: Comparison, saturated: int, fed: bool
) -> None:
    """Figures have two to four panels."""
    known = np.arange(WORLDS) < saturated
    moments = {name: Measured(np.ones(WORLDS), known) for name in ("births", "ticks")}
    food = {"food": Measured(np.ones(WORLDS), np.full(WORLDS, fed))}
    arm = replace(compared.arms[0], measured={**compared.arms[0].measured, **moments, **food})
    with style.applied():
        drawn = draw(replace(compared, arms=(arm,)))
        drawn.draw_without_rendering()
    assert len(drawn.axes) == 2 + fed + bool(saturated)
    for axes in drawn.axes:
        for text in (axes.title, axes.xaxis.label, axes.yaxis.label):
            box = text.get_window_extent()
            assert drawn.bbox.count_contains([box.min, box.max]) == 2, text
