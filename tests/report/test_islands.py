"""The page of a run with islands: the table, the curves, the phylogeny and the pictures."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from primordia.figures import style
from primordia.report import islands
from primordia.report.content import of_run
from primordia.report.words import listed, setting
from primordia.runs.archive import Archive
from tests.report.browser import Page

COLOURS = style.island_colours(("dune", "marsh"))


@pytest.fixture(scope="module")
def content(shore: Archive) -> dict[str, Any]:
    return of_run(shore, filmed=False)


def test_the_table_counts_who_lives_on_each_island_and_who_came(
    shore: Archive, content: dict[str, Any]
) -> None:
    run, shown = shore, content["islands"]
    table = shown["table"]
    assert table["head"] == list(islands.HEAD)
    assert [row[0] for row in table["rows"]] == [
        f"seed {seed}, {name}" for seed in (5, 6, 7) for name in ("dune", "marsh")
    ]
    for number, row in enumerate(table["rows"]):
        world, island = divmod(number, 2)
        lives = run.lives.of_world(world)
        home, parent = (lives.cell >= 6).astype(int), lives.parent
        here, alive = home == island, (home == island) & ~lives.died
        came = sum(home[parent[at]] != island for at in np.flatnonzero(here & (parent >= 0)))
        assert row[1:] == [
            str((6, 18)[island]),
            f"{alive.sum():,}",
            f"{lives.lifespan[alive].mean():,.0f}" if alive.any() else "-",
            f"{here.sum():,}",
            f"{came:,} ({100 * came / here.sum():.0f} %)",
        ]


def test_the_curves_of_islands_follow_those_of_the_run(content: dict[str, Any]) -> None:
    titles = [panel["title"] for panel in content["panels"]]
    assert titles[-2:] == ["Inhabited cells of each island", "Mean age on each island"]
    for panel in content["panels"][-2:]:
        medians = [table["curves"][-1] for table in panel["tables"]]
        assert [curve["colour"] for curve in medians] == [*COLOURS.values()]
        assert [curve["name"].split(",")[0] for curve in medians] == [*COLOURS]


def test_nodes_of_the_phylogeny_have_their_islands(shore: Archive, content: dict[str, Any]) -> None:
    run = shore
    for number, world in enumerate(content["worlds"]):
        lives = run.lives.of_world(number)
        assert world["islands"] == [
            {"name": "dune", "colour": COLOURS["dune"], "first": 0, "last": 5},
            {"name": "marsh", "colour": COLOURS["marsh"], "first": 6, "last": 23},
        ]
        nodes = world["tree"]["nodes"]
        assert {node["island"] for node in nodes} == {0, 1}
        for node in nodes:
            cell = lives.cell[np.searchsorted(lives.id, node["number"])]
            assert node["island"] == (cell >= 6)


def test_a_plain_page_has_no_word_on_islands(torus: Path, torus_content: dict[str, Any]) -> None:
    assert "islands" not in torus_content
    assert "island" not in setting(Archive(torus).config)
    for world in torus_content["worlds"]:
        assert "islands" not in world
        assert "island" not in world["tree"]["nodes"][0]
    assert not any("island" in panel["title"] for panel in torus_content["panels"])


def test_the_settings_name_the_islands(shore: Archive) -> None:
    words = setting(shore.config)
    assert "divided into 2 islands: dune and marsh." in words
    assert [listed(names) for names in (["a"], ["a", "b"], ["a", "b", "c"])] == [
        "a", "a and b", "a, b and c"
    ]  # fmt: skip


def test_islands_in_a_browser(shore_page: Path, page: Page) -> None:
    page.open_file(shore_page)
    assert page.complaints() == []
    for selector in ("section .key", ".tree + .readout"):
        assert page.all(selector)
    rows = page.script("return [...document.querySelectorAll('tbody tr')].map((r) => r.innerText)")
    assert [row.split("\t")[0] for row in rows] == [
        f"seed {seed}, {name}" for seed in (5, 6, 7) for name in ("dune", "marsh")
    ]
    assert page.script(
        "return [...document.querySelectorAll('.bands span')].map((b) => [b.textContent, b.style.top])"
    ) == [["dune", "0%"], ["marsh", "25%"]]
    strokes = page.script(
        "return [...document.querySelectorAll('.tree .bar')].map((bar) => bar.getAttribute('stroke'))"
    )
    expected = [page.script("return curveColour(arguments[0])", each) for each in COLOURS.values()]
    assert set(strokes) == set(expected)
    words = "return nodeText([{number: 7, born: 3, alive: true, skipped: 0, parent: -1, island: 1}], 0, "
    assert page.script(words + "[{name: 'dune'}, {name: 'marsh'}])").startswith(
        "organism 7, born at tick 3, on marsh, alive"
    )
    assert "on marsh" not in page.script(words + "[])")
    space_time_names_its_islands(page)


def space_time_names_its_islands(page: Page) -> None:
    """Above the cells of an island is a line in its colour. The words of a cell name its island."""
    canvas = page.one("#ground")
    pixels = page.pixels(canvas)[..., :3]
    for island, colour in enumerate(COLOURS.values()):
        rgb = [int(colour[at : at + 2], 16) for at in (1, 3, 5)]
        rows, columns = np.nonzero((pixels[:22, 80:-80] == rgb).all(axis=-1))
        assert np.bincount(rows).max() > pixels.shape[1] / 10, "a line, and not only a name"
        assert (columns < (pixels.shape[1] - 160) / 3).all() == (island == 0)
    said = set()
    for x in (0.15, 0.8):
        page.hover(canvas, x, 0.6)
        readout = page.until(lambda: page.text(".ground .readout").strip())
        found = re.match(r"cell (\d+), on (\w+), birth ", readout)
        assert found, readout
        assert found[2] == ("dune" if int(found[1]) < 6 else "marsh")
        said.add(found[2])
        page.hover(page.one("h1"), 0.5, 0.5)
        page.script("document.querySelector('.ground .readout').textContent = ''")
    assert said == {"dune", "marsh"}
    page.script("document.querySelector('.organism button').click()")
    assert re.search(r"\d+, on (dune|marsh)", page.text(".organism dl"))
