"""Tables of assays: each cell has the median and quartiles of its own values."""

import json
from dataclasses import replace
from pathlib import Path
from unittest.mock import MagicMock, call, patch

import numpy as np
import pytest

from primordia.assays.ablate import Ablation
from primordia.assays.compete import Competition
from primordia.assays.effects import Effect
from primordia.assays.garden import Bed
from primordia.assays.generalists import Ancestor, Generalists
from primordia.assays.line import Line, Step
from primordia.assays.transplant import Transplant
from primordia.cli.assays import assay, options, tables
from primordia.figures import assays
from primordia.history.heredity import Inherited, Pairs
from primordia.history.threshold import Threshold

OFFSETS = (8, 0, 2)
"""Differences of three worlds or organisms from the least one; the mean is not the median."""


def spread(least: int) -> str:
    """Return the text of three values that lie OFFSETS above the least."""
    return f"{least + 2} ({least + 1} to {least + 5})"


def cells(table: tables.Told) -> dict[str, list[str]]:
    """Return the cells of each row by the row's name."""
    assert all(len(row) == len(table.head) for row in table.rows)
    return {row[0]: list(row[1:]) for row in table.rows}


def test_heredity_has_pairs_in_all_and_spreads_over_worlds() -> None:
    def pairs(first: int, more: int) -> Pairs:
        return Pairs(1000 * first + more, *(first + each + more for each in (0, 20, 40, 60)))

    found = [
        Inherited(
            world, pairs(100, more), pairs(200, more), pairs(300, more), 400 + more, 500 + more
        )
        for world, more in enumerate(OFFSETS)
    ]
    table = tables.heredity("run", found)
    assert table.title == "run: 3 worlds, medians (quartiles)"
    assert list(table.head) == ["", "copies", "mutants", "both"]
    assert list(cells(table).items()) == [
        ("pairs", ["300,010", "600,010", "900,010"]),
        ("slope", [spread(100), spread(200), spread(300)]),
        ("exactly as long", [spread(120), spread(220), spread(320)]),
        ("a tenth longer", [spread(140), spread(240), spread(340)]),
        ("a third shorter", [spread(160), spread(260), spread(360)]),
        ("selection", ["", "", spread(400)]),
        ("transmission", ["", "", spread(500)]),
    ]


def test_only_worlds_above_one_hold_their_line() -> None:
    """The number is 1 in one world, above 1 in two, below 1 in one, and unknown in one."""
    worlds = [(0.5, 0.5, 4.0), (0.5, 0.0, 2.0), (0.25, 1.0, 1.5), (1.0, 0.5, 1.0), (0.0, None, 3.0)]
    found = [Threshold(number, *each) for number, each in enumerate(worlds)]
    assert [each.held for each in found] == [3, 1, 1.5, 0.5, None]
    table = tables.threshold("run", found)
    assert cells(table) == {
        "p, share of children that mutate": ["0.5 (0.25 to 0.5)"],
        "v, share of good parents' mutants that are as good": ["0.5 (0.375 to 0.625)"],
        "s, life of good parents' copies / life of all organisms": ["2 (1.5 to 3)"],
        "s (1 - p (1 - v))": ["1.25 (0.875 to 1.88)"],
        "worlds where it is above 1: a good line persists": ["2 of 4"],
    }


def test_effects_of_each_mutation_are_its_own() -> None:
    """Shares are means over organisms, lives are medians; the parents live 100, 200 and 300 ticks."""
    lived = {100: [100, 120, 60, 50], 200: [200, 200, 210, 220], 300: [300, 300, 300, 300]}
    longer = {100: [110, 400, 500, 101], 200: [100, 100, 900, 800], 300: [330, 290, 600, 700]}
    found = [
        Effect(name, number, 0, parent, np.array(mutants, float))
        for name, each in (("scale 1", lived), ("as set", longer))
        for number, (parent, mutants) in enumerate(each.items())
    ]
    table = tables.effects("run", found)
    assert table.title == "run: 3 organisms; each mutation made 4 mutants of each"
    assert table.head == (
        "",
        "as long",
        "longer",
        "a tenth longer",
        "a third shorter",
        "median life",
    )
    assert list(cells(table).items()) == [
        ("scale 1", ["0.583", "0.250", "0.167", "0.167", "205 (142 to 252)"]),
        ("as set", ["0.000", "0.750", "0.667", "0.167", "450 (352 to 458)"]),
    ]
    assert "The organisms lived 200 (150 to 250) ticks." in table.notes[0]


def test_ablated_lives_are_compared_with_intact_lives() -> None:
    intact = [100 + more for more in OFFSETS]
    found = [
        Ablation(without, number, 0, each, each * kept)
        for without, kept in (("senses", 0.5), ("memory", 2.0))
        for number, each in enumerate(intact)
    ]
    table = tables.ablate("run", found)
    assert table.title == "run: 3 organisms, medians (quartiles)"
    assert list(cells(table).items()) == [
        ("nothing", [spread(100), "1"]),
        ("senses", ["51 (50.5 to 52.5)", "0.5"]),
        ("memory", ["204 (202 to 210)", "2"]),
    ]


def test_a_garden_has_means_of_beds_and_medians_of_worlds() -> None:
    """The founders have no recorded lives. The beds of the three worlds have different sizes."""

    def bed(group: str, world: int, recorded: list[int] | None, reborn: list[float]) -> Bed:
        lived = None if recorded is None else np.array(recorded)
        return Bed(group, world, np.arange(len(reborn)), lived, np.array(reborn))

    found = [
        bed("oldest", 0, [100, 300], [50, 150]),
        bed("founders", 0, None, [7, 8, 9]),
        bed("oldest", 1, [400, 402, 404, 1190], [10, 20, 30, 540]),
        bed("oldest", 2, [1000], [1000]),
    ]
    assert cells(tables.garden("run", found)) == {
        "oldest": ["3", "7", "599 (400 to 800)", "150 (125 to 575)", "0.5 (0.375 to 0.75)"],
        "founders": ["1", "3", "-", "8", "-"],
    }


def test_a_line_is_a_column_with_its_first_last_and_largest_step() -> None:
    lived = [1000, 100, 300, 1900, 2000, 1850]
    steps = [
        Step(2 * number, 10 + number, 5000 + number, "mutant", 3, each)
        for number, each in enumerate(lived)
    ]
    falling = [Step(0, 1, 0, "founder", 3, 90), Step(1, 2, 20, "mutant", 3, 80)]
    found = [Line(15, 3, 4321, 1234, steps), Line(2, 0, 1, 2, falling)]
    table = tables.line("run", found)
    assert list(table.head) == ["", "organism 15 of world 3", "organism 2 of world 0"]
    assert cells(table) == {
        "generations": ["4,321", "1"],
        "different genomes": ["1,234", "2"],
        "born again": ["6", "2"],
        "ticks that the first lives": ["1,000", "90"],
        "ticks that the last lives": ["1,850", "80"],
        "as good from": ["13 (generation 6, tick 5,003)", "1 (generation 0, tick 0)"],
        "largest step": ["13: 300 to 1,900", "-"],
    }
    plain = found[1].to_dict()
    names = "generation", "organism", "born", "birth_cause", "recorded", "reborn"
    assert plain["steps"][0] == dict(zip(names, (0, 1, 0, "founder", 3, 90), strict=True))
    assert "migrations" not in plain


def test_a_line_tells_of_islands_and_of_bodies_that_are_inherited() -> None:
    steps = [
        Step(3 * n, 10 + n, 50 + n, "mutant", 3, 90, island, brain, 90)
        for n, (island, brain) in enumerate((("sea", 40), ("lagoon", 90)))
    ]
    table = cells(tables.line("run", [Line(11, 3, 9, 2, steps, migrations=1234)]))
    assert (table["island of birth"], table["migrations"]) == (["lagoon"], ["1,234"])
    assert table["brain as good from"] == ["11 (generation 3, tick 51)"]
    assert table["body as good from"] == ["10 (generation 0, tick 50)"]


def test_two_genomes_share_the_living() -> None:
    """The second wins two of four worlds, the first one, and one is a draw."""
    late = np.array([0.75, 0.25, 0.0, 0.5])
    share = np.stack([np.full(4, 0.5), late], axis=1)
    table = tables.compete("both", [Competition("a", "b", np.array([0, 5000]), share)])
    assert table.title == "both: each genome begins in half of the cells, 5,000 ticks, no mutation"
    assert cells(table) == {
        "a": ["4", "1", "0.375 (0.188 to 0.562)"],
        "b": ["4", "2", "0.625 (0.438 to 0.812)"],
    }
    assert table.notes[0].endswith(" Sign test over worlds: p = 1.")


@pytest.mark.parametrize(("arms", "as_json"), [(("a",), True), (("a", "b"), False)])
def test_each_of_several_arms_has_a_table_and_a_folder_of_figures(
    arms: tuple[str, ...], as_json: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With --json, only the JSON is printed on standard output."""
    found = {f"runs/{name}": [MagicMock()] for name in arms}
    for name, (result,) in found.items():
        result.to_dict.return_value = {"of": name}
    with (
        patch("primordia.figures.assays.effects", side_effect=tuple) as draw,
        patch("primordia.figures.style.save", return_value=["x.png", "x.svg"]) as save,
        patch.object(tables, "effects", lambda arm, _: tables.Told(f"table of {arm}", "h", ["1"])),
    ):
        options.tell("effects", found, as_json, tmp_path)
    folders = [tmp_path / name if len(arms) > 1 else tmp_path for name in arms]
    assert draw.call_args_list == [call(of) for of in found.values()]
    assert [each.args[1] for each in save.call_args_list] == [each / "effects" for each in folders]
    out, err = capsys.readouterr()
    figures = "Figure: x.png and x.svg\n" * len(arms)
    if as_json:
        assert (json.loads(out), err) == ({"runs/a": [{"of": "runs/a"}]}, figures)
    else:
        assert (out.index("table of runs/a") < out.index("table of runs/b"), err) == (True, "")
        assert out.endswith(figures)


def test_each_assay_has_tables_and_a_figure() -> None:
    for name in assay.commands:
        assert hasattr(tables, name)
        assert hasattr(assays, name)


def test_unknown_numbers_are_dashes_and_zeros_are_not() -> None:
    unknown = Pairs(0, None, None, None, None)
    inherited = tables.heredity("run", [Inherited(0, unknown, unknown, unknown, None, None)])
    assert [list(row[1:]) for row in inherited.rows] == [
        ["0"] * 3, *[["-"] * 3] * 4, *[["", "", "-"]] * 2,
    ]  # fmt: skip
    persists = tables.threshold("run", [Threshold(0, None, None, None)])
    assert [row[1] for row in persists.rows] == ["-"] * 4 + ["0 of 0"]
    never = tables.threshold("run", [Threshold(0, 1.0, 0.0, 2.0)])
    assert [row[1] for row in never.rows] == ["1", "0", "2", "0", "0 of 1"]
    assert (len(persists.notes), len(never.notes)) == (0, 1), "why there are no copies"


def test_transplants_are_told_by_island_of_birth_and_by_island_of_life() -> None:
    """Lives are least in the second world. Nothing was born late on the last island."""
    least = np.array([[100.0, 10, 10], [50, 20, 40], [np.nan] * 3, [5, 5, 5]])
    found = [
        Transplant(world, ("dune", "marsh", "sea"), (9, world, 0), least + more)
        for world, more in enumerate(OFFSETS)
    ]
    table = tables.transplant("run", found)
    assert table.title == "run: mean ticks lived; medians over 3 worlds (quartiles)"
    assert list(table.head) == ["", "organisms", *(f"living on {n}" for n in found[0].islands)]
    rows = cells(table)
    assert rows["born on dune"] == ["27", spread(100), spread(10), spread(10)]
    assert rows["born on marsh"] == ["3", spread(50), spread(20), spread(40)]
    assert rows["born on sea"] == ["0", "-", "-", "-"]
    assert rows["founders"] == ["", spread(5), spread(5), spread(5)]
    assert cells(tables.transplant("run", found[1:2]))["home / away"] == ["", "10", "0.444", "-"]
    assert cells(tables.transplant("run", found[1:2]))["local / foreign"] == ["", "2", "2", "-"]
    assert tables.transplant("run", found[:1]).title == "run: mean ticks lived; 1 world"


def ancestor(generation: int, lived: tuple[float, float], *mastered: str) -> Ancestor:
    """Return an ancestor whose number and tick of birth follow from its generation."""
    cause, island = ("founder", "dune") if generation == 0 else ("mutant", "marsh")
    return Ancestor(generation, 10 * generation, 1000 * generation, cause, island, lived, mastered)


def test_generalists_are_told_with_the_births_at_which_their_line_gained_islands() -> None:
    line = (
        ancestor(0, (5, 1), "dune"),
        ancestor(3, (3, 2)),
        ancestor(7, (9, 3), "dune"),
        ancestor(9, (8, 70), "dune", "marsh"),
    )
    found = [
        Generalists(
            world, ("dune", "marsh"), np.arange(4), np.array([0, 0, 1, 1]),
            np.array([[1.0, 2], [5, 2], [5, 9], [6, 9]]), np.array([4.0, 8]), line if world else (),
        )
        for world in range(2)
    ]  # fmt: skip
    assert found[0].shares.tolist() == [0.25, 0.25, 0.5]
    shares, lives, gains = tables.generalists("run", found[1:])
    assert shares.title == "run: 4 late organisms of each world; 1 world"
    assert cells(shares) == {
        "masters 0 islands": ["0.25"],
        "masters 1 island": ["0.25"],
        "masters 2 islands": ["0.5"],
    }
    assert cells(lives) == {"dune": ["5", "4"], "marsh": ["5.5", "8"]}
    assert cells(gains) == {
        "1: dune": ["70", "7", "7,000", "marsh", "mutant", "3", "9"],
        "1: marsh": ["90", "9", "9,000", "marsh", "mutant", "3", "70"],
    }
    never = [replace(found[1], line=line[:2])]
    assert [row[0] for row in tables.generalists("run", never)[2].rows] == ["none"]
