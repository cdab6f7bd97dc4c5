"""The arms of an experiment side by side: tables of outcomes and effects, and curves."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.comparison.comparison import OUTCOMES, ComparedArm, Comparison
from primordia.comparison.measured import Measured
from primordia.comparison.survival import survival
from primordia.comparison.tables import effects
from primordia.report import arms
from primordia.report.arms import _outcomes, _over_time, _survival
from primordia.runs.lives import Lives, joined
from tests.synthetic import alive, surviving, world_of

COLOURS = "#111111", "#222222", "#333333"
LIVED = [(tick, tick % 7 + tick // 5, tick % 4 > 0) for tick in range(0, 100, 2)]


def arm(name: str, number: int, births: list[float], lives: Lives) -> ComparedArm:
    """Return an arm whose worlds saturated after these births; a negative number is a lower bound."""
    bounds = np.array(births)
    unknown = Measured(np.zeros(len(bounds)), np.zeros(len(bounds), bool))
    measured = {**dict.fromkeys(OUTCOMES, unknown), "births": Measured(abs(bounds), bounds > 0)}
    measured["ticks"] = Measured(10 * abs(bounds), bounds > 0)
    seeds = np.arange(3, dtype=np.uint64) + 10 * number
    settings = {"hazard": number / 10, "metabolism.cap": None if number else 80.0}
    others: Any = None
    return ComparedArm(
        name, settings, seeds, measured, survival(lives, 1, 50), others, others, others
    )


@pytest.fixture(scope="module")
def compared() -> Comparison:
    """Return three arms; of the last one, two of three worlds are saturated."""
    made = (
        arm("mild", 0, [10, 20, 30], world_of(LIVED, until=200)),
        arm("harsh", 1, [40, 50, 60], world_of(LIVED[:20], until=200)),
        arm("odd", 2, [1, 2, -30], world_of(LIVED[::3], until=200)),
    )
    return Comparison("meadow", made, 50, 0, None, None, "tick")


def test_outcomes_and_effects_are_those_of_each_arm(compared: Comparison) -> None:
    """There are nine pairs of a world of the last arm and a world of the first. The last arm has fewer
    births in six pairs and more in two; the order of one pair is unknown."""
    table = _outcomes(compared)
    assert table["head"] == [
        "arm", "hazard", "metabolism.cap", "worlds saturated",
        "births to saturation", "ticks to saturation",
    ]  # fmt: skip
    assert table["rows"] == [
        ["mild", "0.0", "80.0", "3 of 3", "20 (10 to 30)", "200 (100 to 300)"],
        ["harsh", "0.1", "none", "3 of 3", "50 (40 to 60)", "500 (400 to 600)"],
        ["odd", "0.2", "none", "2 of 3", "2 (1 to >= 30)", "20 (10 to >= 300)"],
    ]
    head, rows = effects(compared)
    assert head == ["against mild", "births to saturation", "ticks to saturation"]
    assert rows[0] == ["harsh", "+1.00 later; 2.5", "+1.00 later; 2.5"]
    assert rows[1] == [
        "odd",
        "-0.44 earlier; order known in 88 % of pairs; 0.1",
        "-0.44 earlier; order known in 88 % of pairs; 0.1",
    ]


def test_survival_of_each_arm_has_its_name_and_colour(compared: Comparison) -> None:
    panel = _survival(compared, COLOURS)
    assert (panel["x"], panel["y"]) == ("age (ticks)", "fraction alive")
    assert (panel["log_x"], panel.get("log_y")) == (True, None)
    parts = LIVED, LIVED[:20], LIVED[::3]
    names = "mild", "harsh", "odd"
    for table, part, name, colour in zip(panel["tables"], parts, names, COLOURS, strict=True):
        (curve,) = table["curves"]
        assert (curve["name"], curve["colour"], curve["kind"]) == (name, colour, "steps")
        shares = surviving(world_of(part, until=200), 50)
        assert (table["x"][0], table["x"][-1]) == (1, 50)
        assert curve["values"][1:] == pytest.approx([shares[age] for age in table["x"]][1:], 1e-4)


def test_curves_over_time_are_medians_of_the_worlds_of_each_arm() -> None:
    """The worlds of an arm end at different ticks. The last one is in the second arm. A median needs
    values of half of the worlds. At tick 1 all ages are 0, which a logarithmic axis cannot show."""
    ends = [(150, 160, 170), (200, 130, 130, 201)]
    worlds = [
        [
            world_of([(tick + 1, age, died) for tick, age, died in LIVED[i:]], end)
            for i, end in enumerate(arm)
        ]
        for arm in ends
    ]
    runs: Any = [
        SimpleNamespace(path=Path(name), lives=joined(each, np.arange(len(each))))
        for name, each in zip(("mild", "harsh"), worlds, strict=True)
    ]
    ages, living = _over_time(runs, COLOURS[:2])
    assert (ages["log_x"], ages["log_y"]) == (True, True)
    assert (living["log_x"], living["log_y"]) == (True, False)
    assert (ages["y"], living["y"]) == ("age (ticks)", "organisms")
    assert (ages["title"], living["title"]) == ("Mean age of the living", "Organisms alive")

    def value(lives: Lives, tick: int, age: bool) -> float | None:
        if tick < lives.born[0] or tick > lives.ended.max():
            return None
        since = [tick - lives.born[row] for row in range(len(lives)) if alive(lives, row, tick)]
        return (float(np.mean(since)) if since else None) if age else float(len(since))

    for panel in (ages, living):
        assert panel["x"] == "time (ticks)"
        (table,) = panel["tables"]
        assert table["x"][-1] == 201
        names = [(each["name"], each["colour"], each["kind"]) for each in table["curves"]]
        assert names == [("mild", COLOURS[0], "line"), ("harsh", COLOURS[1], "line")]
        for curve, each in zip(table["curves"], worlds, strict=True):
            for tick, shown in list(zip(table["x"], curve["values"], strict=True))[::9]:
                values = [value(lives, tick, panel is ages) for lives in each]
                known = [got for got in values if got is not None]
                middle = float(np.median(known)) if 2 * len(known) >= len(each) else None
                middle = None if panel is ages and not middle else middle
                assert shown == (middle if middle is None else pytest.approx(middle, 1e-4)), tick


def test_curves_of_forks_begin_at_the_fork() -> None:
    lives = world_of(LIVED, until=200)
    run: Any = SimpleNamespace(path=Path("fork"), lives=lives.recorded_since(50))
    for panel in _over_time([run, run], COLOURS[:2]):
        assert panel["x"] == "time since the fork (ticks)"
        (table,) = panel["tables"]
        assert table["x"][-1] == 150
        for tick, shown in zip(table["x"], table["curves"][1]["values"], strict=True):
            since = [
                tick + 50 - lives.born[row] for row in range(50) if alive(lives, row, tick + 50)
            ]
            expected = len(since) if panel["y"] == "organisms" else np.mean(since)
            assert shown == pytest.approx(expected, 1e-4)


def test_two_arms_have_tables_notes_and_curves(
    compared: Comparison, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first note explains the tables. The others are those of the comparison."""
    lives = world_of(LIVED, until=200)
    runs: Any = [SimpleNamespace(path=Path(name), lives=lives) for name in ("mild", "harsh")]
    two = replace(compared, arms=compared.arms[:2])
    monkeypatch.setattr(arms, "compare", lambda given: two if given is runs else None)
    monkeypatch.setattr(arms, "evidence_notes", lambda given: [given.task, "Needs: 9."])
    made = arms.arms(runs)
    head, rows = effects(two)
    outcomes = _outcomes(two)
    assert outcomes["title"] == "Outcomes"
    assert made["tables"] == [outcomes, {"title": "Effects", "head": head, "rows": rows}]
    assert "Cliff's delta" in made["notes"][0]
    assert made["notes"][1:] == ["meadow", "Needs: 9."]
    assert [panel["title"] for panel in made["panels"]] == [
        "Alive at each age", "Mean age of the living", "Organisms alive",
    ]  # fmt: skip


def test_an_experiment_with_one_arm_has_curves_and_no_tables() -> None:
    run: Any = SimpleNamespace(path=Path("only"), lives=world_of(LIVED, until=200))
    alone = arms.arms([run])
    assert (alone["tables"], alone["notes"]) == ([], [])
    titles = [panel["title"] for panel in alone["panels"]]
    assert titles == ["Mean age of the living", "Organisms alive"]
