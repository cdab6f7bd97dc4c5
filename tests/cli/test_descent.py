"""Tables of ancestors and of lines: each column has its own numbers, and notes have those of the end."""

import json
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock, patch

import numpy as np
import pytest

from primordia.cli import descent
from primordia.cli.assays.options import save_figure
from primordia.phylogeny.coalescence import Times
from primordia.phylogeny.descent import CommonAncestor
from primordia.phylogeny.sweeps import Sweep
from tests.commands import here

RUN = Path("RUN")
Shown = dict[str, Any]


@pytest.fixture
def shown() -> Iterator[Shown]:
    """Keep the parts of the table that is shown."""
    parts: Shown = {}

    def show(title: str, head: Any, rows: Any, notes: Any) -> None:
        parts.update(title=title, head=list(head), rows=[list(row) for row in rows], notes=notes)

    with patch.object(descent, "show_table", show):
        yield parts


def step(place: int, birth: str, **other: Any) -> dict[str, Any]:
    """Return an ancestor; no two of its numbers are equal."""
    names = "organism", "generation", "born", "lifespan", "children", "tenth", "half", "fixed"
    numbers = {name: 1000 * number + place for number, name in enumerate(names, 1)}
    return {**numbers, "parent": None, "birth_cause": birth, "cause": "starved", **other}


def ancestors(steps: list[dict[str, Any]], **other: Any) -> Any:
    places = np.arange(len(steps))
    values: dict[str, Any] = {
        "organism": 1234, "world": 2, "line": steps, "size": np.array([0.5, 0.25, 123.456, 0, np.nan]),
        "changes": np.zeros(0), "unknown": None, "common": None, "roots": 3, "step": steps.__getitem__,
        "telling": lambda most: places[:most], "islands": None, "traits": None,
    }  # fmt: skip
    return SimpleNamespace(**{**values, **other})


def test_a_founder_that_was_born_of_another_is_no_end_of_the_shares(shown: Shown) -> None:
    """So it is without heredity."""
    descent._show_ancestors(RUN, ancestors([step(0, "founder", parent=7)]))
    assert any(note.startswith("Genomes are not inherited") for note in shown["notes"])
    descent._show_ancestors(RUN, ancestors([step(0, "founder"), step(1, "mutant", parent=0)]))
    assert not any(note.startswith("Genomes are not inherited") for note in shown["notes"])


def test_a_row_of_an_ancestor_has_its_life_its_mutation_and_its_spread(shown: Shown) -> None:
    steps = [
        step(0, "founder"),
        step(1, "mutant", cause=None, fixed=None, half=None, tenth=None),
        step(2, "mutant", fixed=0),
        step(3, "copy"),
        step(4, "mutant"),
    ]
    descent._show_ancestors(RUN, ancestors(steps))
    assert shown["title"] == "RUN: the line of organism 1,234 of world 2"
    head = "organism line born lived death children change"
    assert shown["head"] == [*head.split(), "10 %", "50 %", "all"]
    assert list(map(" ".join, shown["rows"])) == [
        "1,000 2,000 3,000 4,000 starved 5,000 founder 6,000 7,000 8,000",
        "1,001 2,001 3,001 4,001 alive 5,001 0.25 - - -",
        "1,002 2,002 3,002 4,002 starved 5,002 123 6,002 7,002 0",
        "1,003 2,003 3,003 4,003 starved 5,003 copy 6,003 7,003 8,003",
        "1,004 2,004 3,004 4,004 starved 5,004 - 6,004 7,004 8,004",
    ]
    assert len(shown["notes"]) == 3


def test_ancestors_that_are_left_out_are_counted(shown: Shown) -> None:
    for count in (20, 1300):
        steps = [step(place, "copy") for place in range(count)]
        descent._show_ancestors(RUN, ancestors(steps, size=np.zeros(count)))
        assert len(shown["rows"]) == 20
        left_out = [note for note in shown["notes"] if "ancestors are left out" in note]
        assert [note.split()[0] for note in left_out] == (["1,280"] if count > 20 else [])


def test_islands_and_traits_are_columns_and_unknown_changes_are_dashes(shown: Shown) -> None:
    steps = [
        step(0, "mutant", island="lagoon", migrations=1234, traits={"leg": 1.0}),
        step(1, "mutant", island="lagoon", migrations=1235, traits={"leg": None}),
    ]
    given = {"islands": ["lagoon"], "traits": {"leg": np.ones(2)}}
    unknown = {"size": None, "changes": None, "unknown": "no trust"}
    descent._show_ancestors(RUN, ancestors(steps, **given, **unknown))
    assert shown["head"][2:7] == ["born", "island", "migrations", "leg", "lived"]
    assert [row[2:7] for row in shown["rows"]] == [
        ["3,000", "lagoon", "1,234", "1.00", "4,000"], ["3,001", "lagoon", "1,235", "-", "4,001"],
    ]  # fmt: skip
    assert [row[9] for row in shown["rows"]] == ["-", "-"]
    assert any(note.startswith("migrations: births up to this organism") for note in shown["notes"])
    assert "leg: factors of the habitat's own parameters." in shown["notes"]
    assert "The changes are unknown: no trust." in shown["notes"]


def test_the_text_about_the_common_ancestor_has_its_birth_and_its_time() -> None:
    common = CommonAncestor(organism=1111, born=2222, since=3333, generation=4444)
    assert descent._common_text(ancestors([], common=common)) == (
        "The common ancestor of the living is organism 1,111, born at tick 2,222 in generation 4,444."
        " Since tick 3,333 all of the living descend from this organism."
    )
    assert "descend from 1,200 organisms" in descent._common_text(ancestors([], roots=1200))
    assert descent._common_text(ancestors([], roots=0)).startswith("Nothing is alive")


def line(place: int, **other: Any) -> dict[str, Any]:
    names = "largest_share", "final_share", "slope", "slope_per_lifespan", "p_of_slope"
    shares = {name: (number + place / 10) / 10 for number, name in enumerate(names, 1)}
    return {"organism": 1000 + place, **shares, "p_of_final_share": 0.75, **other}


def world(count: int, **other: Any) -> Any:
    """Return a world of lines. Its numbers at the last tick differ from all others."""
    exported = {
        "lines": [line(place) for place in range(count)],
        "founded": 1500,
        "shadows": 2000,
        "p_of_effective_lines": 0.0123,
        "bands": {"effective_lines": [[1.0, 2.5], [3.0, 7.25]], "largest_share": [[0, 0], [1, 1]]},
    }
    values: dict[str, Any] = {
        "world": 3, "founders": np.arange(count), "ticks": np.array([1500, 1600, 9000]),
        "effective": np.array([[9.0, 8, 7], [6, 5, 4], [3, 2, 1.5]]), "sweeps": [],
        "diversity": np.array([11111, 44444, 33333]), "to_dict": lambda: exported,
        "pairs": Times(np.array([1000, 3000]), np.array([0.25, 0.5])),
        "neutral_pairs": Times(np.array([5000]), np.array([0.8])), "islands": None,
    }  # fmt: skip
    return SimpleNamespace(**{**values, **other})


def test_a_row_of_a_line_has_its_shares_slopes_and_p_values(shown: Shown) -> None:
    found, slopes = world(3), ("slope", "slope_per_lifespan", "p_of_slope")
    for place, value in ((1, None), (2, 0.0)):
        found.to_dict()["lines"][place] |= dict.fromkeys(slopes, value)
    descent._show_lines(RUN, found)
    assert shown["title"] == "RUN: world 3, 3 lines founded at tick 1,500, up to tick 9,000"
    head = ["line of", "largest", "last share", "s per tick", "s per life", "p of s", "p of last"]
    assert shown["head"] == head
    assert shown["rows"] == [
        ["1,000", "0.100", "0.200", "0.3", "0.4", "0.5", "0.75"],
        ["1,001", "0.110", "0.210", "-", "-", "-", "0.75"],
        ["1,002", "0.120", "0.220", "0", "0", "0", "0.75"],
    ]


def test_islands_are_columns_after_lines(shown: Shown) -> None:
    found = world(1, islands=["lagoon"])
    found.to_dict()["lines"][0] |= {"island": "lagoon", "migrations": 1234}
    descent._show_lines(RUN, found)
    assert shown["head"][:4] == ["line of", "island", "migrations", "largest"]
    assert shown["rows"][0][:4] == ["1,000", "lagoon", "1,234", "0.100"]
    assert any("migrations: births in the line" in note for note in shown["notes"])


def test_notes_are_about_the_last_tick(shown: Shown) -> None:
    """Pairs on record have their common ancestor 1,000 or 3,000 ticks ago, equally often."""
    descent._show_lines(RUN, world(2))
    notes = " ".join(shown["notes"])
    assert (
        "Effective number of lines at the end: 1.50; in 95 % of 2,000 shadows 2.50 to 7.25. For its"
        " mean over time: p = 0.012."
    ) in notes
    assert "Phylogenetic diversity of the living: 33,333 ticks." in notes
    assert (
        "50% of the pairs of the living have a common ancestor on record, 2,000 ticks ago on average."
        " With drift alone, 80% would have one, 5,000 ticks ago."
    ) in notes
    now = Times(np.array([0]), np.array([0.25]))
    descent._show_lines(RUN, world(2, pairs=now, neutral_pairs=now))
    assert "on record, 0 ticks ago on average. With drift alone, 25%" in shown["notes"][-1]
    none = Times(np.array([], int), np.array([]))
    for name in ("pairs", "neutral_pairs"):
        descent._show_lines(RUN, world(2, **{name: none}))
        assert "of the pairs" not in " ".join(shown["notes"])


@pytest.mark.parametrize("count", [10, 2010])
def test_the_ten_largest_lines_are_shown_and_the_others_counted(count: int, shown: Shown) -> None:
    descent._show_lines(RUN, world(count))
    assert [row[0] for row in shown["rows"]] == [f"{1000 + n:,}" for n in range(min(count, 10))]
    left_out = [note for note in shown["notes"] if "left out" in note]
    expected = f"{count - 10:,} smaller lines are left out; --json shows all."
    assert left_out == ([expected] if count > 10 else [])


def test_only_a_sweep_past_half_of_the_living_is_under_way() -> None:
    done = Sweep(5, "copy", 100, 300, 1400, 3)
    begun = Sweep(1234, "copy", 700, 4321, None, 3)
    early = Sweep(8, "copy", 700, None, None, 3)
    whole = "Sweeps to all of the living: 1; median duration: 1,300 ticks"
    assert descent._sweeps_text([done, begun]) == (
        f"{whole}. Under way: the sweep of organism 1,234, whose descendants have been more than half"
        " of the living since tick 4,321."
    )
    assert descent._sweeps_text([done, early]) == f"{whole}."
    assert descent._sweeps_text([]) == "Sweeps to all of the living: 0."
    at_once = Sweep(9, "copy", 300, 300, 300, 1)
    text = descent._sweeps_text([at_once, done, begun])
    assert text.startswith("Sweeps to all of the living: 2; median duration: 650 ticks. Under way")
    for lives, median in (((1000, 4003), "2,501.5"), ((40, 7, 9010), "40")):
        some = [Sweep(n, "copy", 10, 11, 10 + ticks, 3) for n, ticks in enumerate(lives)]
        whole = f"Sweeps to all of the living: {len(lives)}; median duration: {median} ticks."
        assert descent._sweeps_text([*some, early]) == whole


@pytest.mark.parametrize(
    ("words", "names"),
    [
        (("ancestors",), ["ancestors", "portraits"]),
        (("lineages", "--world", "all", "--json"), ["lines-3", "lines-12"]),
    ],
    ids=["ancestors", "lineages"],
)
def test_the_files_of_each_figure_are_printed_apart_from_json(
    words: tuple[str, ...], names: list[str], tmp_path: Path
) -> None:
    """With --json, other programs read standard output, so it has nothing but JSON."""
    run, lines = MagicMock(), [MagicMock(world=number) for number in (3, 12)]
    run.lineages.return_value = lines
    for each in lines:
        each.to_dict.return_value = {}
    with (
        patch("primordia.api.load", return_value=run),
        patch("primordia.figures.descent.draw"),
        patch("primordia.figures.lines.draw"),
        patch("primordia.figures.portraits.draw"),
        patch("primordia.figures.style.save", lambda _, path: [f"{path}.png", f"{path}.svg"]),
        patch.object(descent, "_show_ancestors"),
    ):
        done = here(*words, RUN, "--out", tmp_path / "new")
    paths = [tmp_path / "new" / name for name in names]
    printed = done.stderr if "--json" in words else done.stdout
    assert printed.splitlines() == [f"Figure: {path}.png and {path}.svg" for path in paths]
    assert "--json" not in words or json.loads(done.stdout) == [{}, {}]


def test_a_figure_without_anything_to_draw_is_not_written(tmp_path: Path) -> None:
    """There are no portraits where bodies are not inherited."""
    with patch("primordia.figures.style.save", MagicMock(side_effect=AssertionError)):
        save_figure(lambda: None, tmp_path, "portraits", as_json=False)
