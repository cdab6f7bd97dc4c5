"""Figures of the page: they show the content of the page, and follow mouse, keys, wheel and fingers."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.keys import Keys

from primordia.runs.archive import Archive
from tests.report.browser import Page
from tests.report.unpacked import unpacked

CANVAS, TOLD = ".ground canvas", ".tree + .readout"


@pytest.fixture
def world(torus_page: Path, page: Page) -> dict[str, Any]:
    """Open the page of a run on a torus, and return the content of its first world."""
    page.open_file(torus_page)
    content = json.loads(page.text("#content"))
    return {**content["worlds"][0], "palette": content["palette"]}


@pytest.mark.slow
def test_a_chart_shows_values_and_zooms_by_mouse_keys_and_buttons(
    cart_page: Path, page: Page
) -> None:
    page.open_file(cart_page)
    chart = page.one(".chart")
    plot = page.until(lambda: page.one(".chart .plot .u-over"))

    def value_at(x: float) -> str:
        page.hover(plot, x, 0.5)
        return page.text(".chart .key")

    first = value_at(0.05)
    assert re.search(r"mean age [\d.,]+at [\d,]+", first), first
    assert value_at(0.9) != first
    assert value_at(0.05) == first
    group = page.one(".chart .plot")
    for zoom, back in (
        (lambda: page.drag(plot, 0.4, 0.8), lambda: page.keys(group, "0")),
        (lambda: page.keys(group, "+"), lambda: page.keys(group, "-")),
        (
            lambda: chart.find_elements("css selector", ".zoom button")[1].click(),
            lambda: chart.find_elements("css selector", ".zoom button")[2].click(),
        ),
    ):
        zoom()
        assert value_at(0.05) != first
        back()
        assert value_at(0.05) == first
    page.keys(group, Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
    assert page.text(".chart .key") != first


def test_space_time_zooms_and_moves_by_wheel_keys_mouse_and_buttons(
    cart_page: Path, page: Page
) -> None:
    """The wheel scrolls the page until the picture is chosen."""
    page.open_file(cart_page)
    canvas = page.one(CANVAS)
    whole = page.picture(canvas)
    page.script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", canvas)
    origin, above = ScrollOrigin.from_element(canvas), page.script("return scrollY")
    ActionChains(page.driver).scroll_from_origin(origin, 0, 100).perform()
    page.until(lambda: page.script("return scrollY") > above)
    assert page.picture(canvas) == whole
    page.click(canvas, 0.02, 0.02)  # outside of the picture: the canvas gets the keys alone
    page.drag(canvas, 0.3, 0.5, 0.7)
    assert page.text(".organism h3") == "No organism is chosen", "a drag is no click"
    whole = page.picture(canvas)
    turn = ActionChains(page.driver).scroll_from_origin(origin, 0, -300)
    ways: dict[str, Any] = {
        "wheel": turn.perform,
        "key": lambda: page.keys(canvas, "+"),
        "button": lambda: page.all(".ground .zoom button")[1].click(),
    }
    for name, zoom in ways.items():
        zoom()
        page.until(lambda: page.picture(canvas) != whole)
        near = page.picture(canvas)
        page.keys(canvas, Keys.ARROW_DOWN)
        moved = page.picture(canvas)
        page.drag(canvas, 0.3, 0.6)
        assert len({near[0], moved[0], page.picture(canvas)[0]}) == 3, name
        page.keys(canvas, "0")
        assert page.picture(canvas) == whole, name


@pytest.mark.slow
def test_a_film_moves_by_keys_plays_and_shows_the_organism_of_a_cell(
    torus: Path, torus_page: Path, page: Page
) -> None:
    page.open_file(torus_page)
    canvas, slider = page.one(".film canvas"), page.one(".film input")
    last = page.picture(canvas)
    assert page.script("return arguments[0].width", canvas) == 6
    page.keys(slider, Keys.HOME)
    assert page.text(".film .readout").startswith("birth 1,")
    assert page.picture(canvas) != last
    page.keys(slider, Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
    third = page.text(".film .readout")
    assert third.startswith("birth 3,")
    assert slider.get_attribute("aria-valuetext") == third
    button = page.one(".film button")
    button.click()
    assert button.text == "Pause"
    page.until(lambda: page.text(".film .readout") != third)
    button.click()
    assert button.text == "Play"
    page.keys(slider, Keys.END)
    world = Archive(torus).lives.of_world(0)
    row = int(np.flatnonzero(world.ended > world.born[-1])[0])  # alive in the last picture
    down, across = divmod(int(world.cell[row]), 6)
    page.click(canvas, (across + 0.5) / 6, (down + 0.5) / 4)
    assert page.text(".organism h3") == f"Organism {world.id[row]:,}"


def test_each_picture_of_a_film_has_its_words_and_its_colours(
    world: dict[str, Any], page: Page
) -> None:
    """The colour of a young organism is mixed with up to half of white. A light page has the inks of the
    figures."""
    film, canvas = world["film"], page.one(".film canvas")
    cells = unpacked(film["cells"]).reshape(len(film["places"]), -1)
    strong = np.array(world["palette"][: len(world["palette"]) // 2])
    ground = page.script("return rgbOf(variable('--empty'))")
    inks = [*strong, *(ink + 0.66 * (ground - ink) for ink in strong)]

    def words(at: int) -> str:
        return f"birth {film['places'][at] + 1:,}, tick {film['ticks'][at]:,}, {film['alive'][at]} alive"

    assert page.text(".film .readout") == words(-1), "the present is shown first"
    for at in (0, len(cells) // 2, len(cells) - 1):
        page.script(
            "const slider = document.querySelector('.film input'); slider.value = arguments[0];"
            " slider.dispatchEvent(new Event('input'));",
            at,
        )
        assert page.text(".film .readout") == words(at)
        pixels = page.pixels(canvas)[..., :3].reshape(-1, 3).astype(float)
        for byte, pixel in zip(cells[at].tolist(), pixels, strict=True):
            ink = inks[byte % 32 - 1]
            light = 0.5 * (1 - (byte // 32) / 7)
            expected = ink + light * (255 - ink) if byte else np.array(ground)
            np.testing.assert_allclose(pixel, expected, atol=1.5)


def is_coloured_by_a_trait(page: Page) -> None:
    """Equal ratios are equally far apart in the scale, and the key has its ends."""
    assert not page.all("#trait"), "bodies are not inherited here"
    page.script(
        "window.made = { traits: { names: ['leg', 'arm'], scale: ['#101010', '#202020', '#303030'] },"
        " nodes: [[1, 0.5], [1, 1], [1, 3], [1, 8]].map((traits) => ({ traits })) };"
        "window.state = { trait: -1 }; window.painted = 0;"
        "document.body.append(traitControl(made, 'island', state, () => { painted += 1; }))"
    )
    choose = "const s = document.getElementById('trait'); s.value = arguments[0];"
    choose += "s.dispatchEvent(new Event('change')); return [state.trait, painted]"
    assert page.script(choose, "1") == [1, 1]
    assert page.text(".scale") == "x 0.50x 8.00"
    colours = page.script(
        "const { nodes, traits } = made, range = traitRange(nodes, 1);"
        "return nodes.map((node) => traitColour(traits.scale, range, node.traits[1]))"
    )
    assert colours == ["#101010", "#101010", "#202020", "#303030"]
    same = "return traitColour(made.traits.scale, traitRange(made.nodes, 0), 1)"
    assert page.script(same) == "#202020", "all have the same factor"
    assert page.script("return traitText(made, made.nodes[2])") == ", leg x 1.00, arm x 3.00"
    assert page.script(choose, "-1") == [-1, 2]
    assert page.text(".scale") == ""
    assert page.script("return traitText({}, {})") == ""
    page.script("document.body.lastChild.remove()")
    is_drawn_in_colours_of_traits(page)


def is_drawn_in_colours_of_traits(page: Page) -> None:
    """Choose a trait in the section of a world to whose phylogeny traits have been added."""
    added = page.driver.execute_async_script(
        "const done = arguments[arguments.length - 1];"
        "const content = JSON.parse(document.getElementById('content').textContent);"
        "readWorld(content.worlds[0]).then((world) => {"
        "  world.tree.nodes.forEach((node, at) => { node.traits = [1 + at]; });"
        "  world.tree.traits = { names: ['leg'], scale: ['#0072b2', '#d55e00'] };"
        "  document.querySelector('.tree').closest('section').replaceWith("
        "    treeSection(world, content.palette, null, () => {}));"
        "  done(world.tree.nodes.length); });"
    )
    page.wait_for_figures()
    strokes = (
        "return [...document.querySelectorAll('.tree .bar')].map((b) => b.getAttribute('stroke'))"
    )
    before = page.script(strokes)
    options = "return [...document.querySelectorAll('#trait option')].map((each) => each.text)"
    assert page.script(options) == ["line of descent", "leg"]
    page.script(
        "const s = document.getElementById('trait'); s.value = 0; s.dispatchEvent(new Event('change'))"
    )
    least, most = page.script("return ['#0072b2', '#d55e00'].map(curveColour)")
    after = page.script(strokes)
    assert len(after) == added
    assert (after[0], after[-1]) == (least, most)
    assert set(after) == {least, most} != set(before)
    page.keys(page.one(".tree"), Keys.ARROW_DOWN)
    assert ", leg x " in page.text(".tree + .readout")


def bars_of(world: dict[str, Any], wide: float) -> list[Any]:
    """Return where the line of each node of the phylogeny belongs in a picture of some width."""
    gap = min(max(420 / world["tree"]["shown"], 3), 14)

    def x(place: float) -> float:
        return 4 + place / world["ground"]["births"] * (wide - 8)

    return [
        pytest.approx(
            [x(node["start"]), 24 + (node["level"] + 0.5) * gap,
             max(x(node["stop"]), x(node["start"]) + 1)]
        )
        for node in world["tree"]["nodes"]
    ]  # fmt: skip


PRESS = """
const event = new KeyboardEvent('keydown', { key: arguments[0] });
document.querySelector('.tree').dispatchEvent(event);
return [document.querySelector('.tree + .readout').textContent,
  [...document.querySelectorAll('.tree .bar.on')].map((each) => Number(each.dataset.node))];
"""


def test_the_phylogeny_is_drawn_over_births_and_read_by_keys_and_mouse(
    world: dict[str, Any], page: Page
) -> None:
    nodes, wide = (
        world["tree"]["nodes"],
        page.script("return document.querySelector('.tree').clientWidth"),
    )
    bars = page.script(
        "return [...document.querySelectorAll('.tree .bar')].map((bar) => bar.getAttribute('d')"
        ".match(/[-\\d.]+/g).map(Number))"
    )
    assert bars == bars_of(world, wide)
    order = [at for _, at in sorted((n["level"], at) for at, n in enumerate(nodes) if n["alive"])]
    keys = ["ArrowDown"] * (len(order) + 1) + ["ArrowUp"] * (len(order) + 1)
    walk = [*order, order[-1], *order[-2::-1], order[0], order[0]]
    for key, at in zip(keys, walk, strict=True):
        words, marked = page.script(PRESS, key)
        about = nodes[at]
        assert words.startswith(f"organism {about['number']:,}, born at tick {about['born']:,}, ")
        line = {at}
        while nodes[at]["parent"] >= 0:
            line.add(at := nodes[at]["parent"])
        assert set(marked) == line
    page.keys(page.one(".tree"), Keys.ARROW_DOWN, Keys.ENTER)
    assert page.text(".organism h3") == f"Organism {nodes[order[1]]['number']:,}"
    words = page.text(TOLD)
    page.hover(page.all(".tree .hit")[3], 0.5, 0.5)
    page.until(lambda: page.text(TOLD) != words)
    is_coloured_by_a_trait(page)
    assert page.complaints() == []


def test_a_choice_of_world_ends_the_zoom_and_the_choice_of_an_organism(
    torus_page: Path, page: Page
) -> None:
    """A marked line of descent stays marked when the tree is drawn again."""
    page.open_file(torus_page)
    page.keys(page.one(".tree"), Keys.ARROW_DOWN)
    marked = "return [...document.querySelectorAll('.tree .on')].map((each) => each.dataset.node)"
    line, drawn = page.until(lambda: page.script(marked)), page.one(".tree svg")
    page.size(900, 900)
    page.until(lambda: page.one(".tree svg") != drawn)
    assert page.script(marked) == line
    page.one("#number").send_keys("7", Keys.ENTER)
    assert page.text(".organism h3") == "Organism 7"
    page.script("document.querySelectorAll('.ground .zoom button')[1].click()")
    assert page.script("return document.querySelector('#ground').classList.contains('zoomed')")
    before = page.one("#ground")
    options = page.all("#world option")
    assert [each.text for each in options] == ["seed 5", "seed 6", "seed 7"]
    picture = page.picture(before)
    options[1].click()
    page.until(lambda: page.one("#ground") != before)
    page.until(lambda: page.picture(page.one(CANVAS)) != picture)
    assert page.text(".organism h3") == "No organism is chosen"
    page.wait_for_figures()
    assert not page.script("return document.querySelector('#ground').classList.contains('zoomed')")
