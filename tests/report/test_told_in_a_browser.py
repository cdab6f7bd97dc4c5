"""What a page tells of organisms, moments and lines of descent, compared with its content."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from primordia.law.world import BirthCause, Cause
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.report.browser import Page
from tests.report.unpacked import unpacked

ORIGINS = {
    BirthCause.FOUNDER: "a founder",
    BirthCause.COPY: "an exact copy",
    BirthCause.MUTANT: "with mutations",
}
CARD = """
document.getElementById("number").value = arguments[0];
document.querySelector("aside form").requestSubmit();
return [...document.querySelectorAll(".organism dl > *")].map((each) => each.textContent.trim());
"""


@pytest.fixture
def world(torus_page: Path, page: Page) -> dict[str, Any]:
    """Open the page of a run on a torus, and return the content of its first world."""
    page.open_file(torus_page)
    content = json.loads(page.text("#content"))
    return {**content["worlds"][0], "palette": content["palette"]}


def card_of(lives: Lives, row: int) -> dict[str, str]:
    """Return what the card of an organism must tell."""
    born, ended = int(lives.born[row]), int(lives.ended[row])
    children = [int(each) for each in lives.id[lives.parent == lives.id[row]]]
    listed = ", ".join(f"{each:,}" for each in children[:10]) + (", …" if children[10:] else "")
    line = [row]
    while lives.parent_row[line[-1]] >= 0:
        line.append(int(lives.parent_row[line[-1]]))
    dead = bool(lives.died[row])
    state = f"tick {ended:,}, {Cause(int(lives.cause[row])).label}" if dead else "alive"
    return {
        "Born": f"tick {born:,}, {ORIGINS[BirthCause(int(lives.birth_cause[row]))]}",
        "Cell": f"{lives.cell[row]:,}",
        "Lived" if dead else "Age": f"{ended - born:,} ticks",
        "Died" if dead else "State": state,
        "Parent": f"{lives.parent[row]:,}" if lives.parent[row] >= 0 else "none",
        "Generation": str(len(line) - 1),
        "Children": f"{len(children)}: {listed}" if children else "0",
    }


def test_the_card_of_an_organism_tells_its_whole_record(
    torus: Path, world: dict[str, Any], page: Page
) -> None:
    """Among these are founders, the dead by each cause, the living, and parents of many."""
    lives = Archive(torus).lives.of_world(0)
    counts = np.bincount(lives.parent_row[lives.parent_row >= 0], minlength=len(lives))
    rows = {0, 1, int(counts.argmax()), int(lives.lifespan.argmax()), len(lives) - 1}
    rows |= {int(np.flatnonzero(lives.cause == cause)[-1]) for cause in set(lives.cause.tolist())}
    for row in sorted(rows):
        told = page.script(CARD, int(lives.id[row]))
        assert dict(zip(told[::2], told[1::2], strict=True)) == card_of(lives, row)
    first, longest = page.all(".organism .bar button")[:2]
    for button, row in ((first, 0), (longest, int(lives.lifespan.argmax()))):
        button.click()
        assert page.text(".organism h3") == f"Organism {lives.id[row]:,}"


def test_a_film_tells_and_paints_each_of_its_pictures(world: dict[str, Any], page: Page) -> None:
    """The young are mixed with up to half of white. On a light page the inks are those of the figures."""
    film, canvas = world["film"], page.one(".film canvas")
    cells = unpacked(film["cells"]).reshape(len(film["places"]), -1)
    strong = np.array(world["palette"][: len(world["palette"]) // 2])
    ground = page.script("return rgbOf(variable('--empty'))")
    inks = [*strong, *(ink + 0.66 * (ground - ink) for ink in strong)]
    last = (
        f"birth {film['places'][-1] + 1:,}, tick {film['ticks'][-1]:,}, {film['alive'][-1]} alive"
    )
    assert page.text(".film .readout") == last, "the present is shown first"
    for at in (0, len(cells) // 2, len(cells) - 1):
        page.script(
            "const slider = document.querySelector('.film input'); slider.value = arguments[0];"
            " slider.dispatchEvent(new Event('input'));",
            at,
        )
        assert page.text(".film .readout") == (
            f"birth {film['places'][at] + 1:,}, tick {film['ticks'][at]:,}, {film['alive'][at]} alive"
        )
        pixels = page.pixels(canvas)[..., :3].reshape(-1, 3).astype(float)
        for byte, pixel in zip(cells[at].tolist(), pixels, strict=True):
            ink = inks[byte % 32 - 1]
            light = 0.5 * (1 - (byte // 32) / 7)
            expected = ink + light * (255 - ink) if byte else np.array(ground)
            np.testing.assert_allclose(pixel, expected, atol=1.5)


def test_the_phylogeny_is_drawn_in_births_and_walked_by_its_levels(
    world: dict[str, Any], page: Page
) -> None:
    tree = world["tree"]
    nodes = tree["nodes"]
    width = page.script("return document.querySelector('.tree').clientWidth")
    gap = min(max(420 / tree["shown"], 3), 14)

    def x(place: float) -> float:
        return 4 + place / world["ground"]["births"] * (width - 8)

    def y(level: int) -> float:
        return 24 + (level + 0.5) * gap

    bars = page.script(
        "return [...document.querySelectorAll('.tree .bar')].map((bar) => bar.getAttribute('d')"
        ".match(/[-\\d.]+/g).map(Number))"
    )
    for node, bar in zip(nodes, bars, strict=True):
        stop = max(x(node["stop"]), x(node["start"]) + 1)
        assert bar == pytest.approx([x(node["start"]), y(node["level"]), stop])
    living = sorted((node["level"], at) for at, node in enumerate(nodes) if node["alive"])
    press = (
        "const event = new KeyboardEvent('keydown', { key: arguments[0] });"
        " document.querySelector('.tree').dispatchEvent(event);"
        " return [document.querySelector('.tree + .readout').textContent,"
        " [...document.querySelectorAll('.tree .bar.on')].map((each) => Number(each.dataset.node))]"
    )
    order = [at for _, at in living]
    keys = ["ArrowDown"] * (len(order) + 1) + ["ArrowUp"] * (len(order) + 1)
    walk = [*order, order[-1], *order[-2::-1], order[0], order[0]]
    for key, at in zip(keys, walk, strict=True):
        told, marked = page.script(press, key)
        assert told.startswith(
            f"organism {nodes[at]['number']:,}, born at tick {nodes[at]['born']:,}, "
        )
        line = {at}
        while nodes[at]["parent"] >= 0:
            line.add(at := nodes[at]["parent"])
        assert set(marked) == line


def test_another_world_begins_with_its_whole_picture_and_nothing_chosen(
    world: dict[str, Any], page: Page
) -> None:
    page.script(CARD, 7)
    page.script("document.querySelectorAll('.ground .zoom button')[1].click()")
    assert page.script("return document.querySelector('#ground').classList.contains('zoomed')")
    before = page.one("#ground")
    page.all("#world option")[1].click()
    page.until(lambda: page.one("#ground") != before)
    assert page.text(".organism h3") == "No organism is chosen"
    page.wait_for_figures()
    assert not page.script("return document.querySelector('#ground').classList.contains('zoomed')")
