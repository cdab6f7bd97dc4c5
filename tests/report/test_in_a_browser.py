"""The page in a browser: figures show and answer, nothing is asked for, and all can use it."""

import re
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement

import primordia
from primordia.report.content import of_run
from primordia.report.page import page as made
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.commands import here
from tests.experiments.meadows import write
from tests.report.browser import PHONE, Page

CANVAS = ".ground canvas"


def differ(one: np.ndarray, other: np.ndarray) -> bool:
    return one.shape != other.shape or bool((one != other).any())


def is_painted(page: Page, canvas: WebElement) -> bool:
    return len(np.unique(page.pixels(canvas).view(np.uint32))) > 2


def is_loaded(page: Page, video: WebElement) -> bool:
    return bool(page.script("return arguments[0].readyState >= 2", video))


@pytest.mark.parametrize("which", ["cart_page", "torus_page"])
def test_every_figure_shows_and_nothing_is_asked_for(
    which: str, page: Page, request: pytest.FixtureRequest
) -> None:
    path: Path = request.getfixturevalue(which)
    page.open_file(path)
    page.until(lambda: len(page.all(".chart canvas")) == len(page.all(".chart")))
    canvases = page.all("canvas")
    assert len(canvases) == len(page.all(".chart")) + len(page.all(".ground, .film"))
    for canvas in canvases:
        page.until(partial(is_painted, page, canvas))
    assert len(page.all(".tree svg path.bar")) > 3
    for video in page.all("video"):
        page.until(partial(is_loaded, page, video))
        assert page.script("return arguments[0].videoWidth", video) > 100
        assert page.script("return arguments[0].paused", video)
    assert page.complaints() == []
    asked = page.requests()
    assert asked[0] == path.as_uri()
    assert all(address.startswith(("blob:", "data:")) for address in asked[1:]), asked
    assert path.stat().st_size < 4_000_000


def test_a_chart_tells_values_and_zooms_by_mouse_keys_and_buttons(
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


def test_a_click_on_a_cell_shows_its_organism_and_lights_its_line(
    cart: Path, cart_page: Path, page: Page
) -> None:
    lives = Archive(cart).lives
    page.open_file(cart_page)
    canvas = page.one(CANVAS)
    before = page.pixels(canvas)
    page.hover(canvas, 0.5, 0.7)
    told = re.fullmatch(
        r"cell (\d+), birth ([\d,]+), tick ([\d,]+): organism ([\d,]+), age ([\d,]+)",
        page.text(".ground .readout"),
    )
    assert told, page.text(".ground .readout")
    cell, birth, tick, number, age = (int(each.replace(",", "")) for each in told.groups())
    row = lives.row(number)
    assert lives.cell[row] == cell
    assert lives.born[birth - 1] == tick
    assert tick - lives.born[row] == age
    page.click(canvas, 0.5, 0.7)
    assert page.text(".organism h3") == f"Organism {number:,}"
    check_card(page, lives, row)
    assert differ(before, page.pixels(canvas)), "its line is lit"
    assert page.script("return document.activeElement === arguments[0]", canvas)


def check_card(page: Page, lives: Lives, row: int) -> None:
    """Compare the card of an organism with the records."""
    words = [each.text for each in page.all(".organism dt")]
    values = [each.text for each in page.all(".organism dd")]
    card = dict(zip(words, values, strict=True))
    assert card["Born"].startswith(f"tick {lives.born[row]:,}")
    assert card["Cell"] == f"{lives.cell[row]:,}"
    lived = card["Lived"] if lives.died[row] else card["Age"]
    assert lived.startswith(f"{lives.lifespan[row]:,} ticks")
    assert card["Parent"] == (f"{lives.parent[row]:,}" if lives.parent[row] >= 0 else "none")
    children = lives.id[lives.parent == lives.id[row]]
    assert card["Children"].startswith(f"{len(children):,}")


def test_organisms_are_found_by_number_and_by_their_relatives(
    cart: Path, cart_page: Path, page: Page
) -> None:
    lives = Archive(cart).lives
    page.open_file(cart_page)
    row = int(np.flatnonzero(lives.parent_row >= 0)[-1])
    page.one("#number").send_keys(str(lives.id[row]), Keys.ENTER)
    assert page.text(".organism h3") == f"Organism {lives.id[row]:,}"
    check_card(page, lives, row)
    page.one(".organism button.link").click()
    assert page.text(".organism h3") == f"Organism {lives.parent[row]:,}"
    page.one("#number").send_keys("999999", Keys.ENTER)
    assert "No such organism" in page.text(".organism h3")
    longest = int(lives.lifespan.argmax())
    next(each for each in page.all(".organism button") if "longest" in each.text).click()
    check_card(page, lives, longest)


def test_space_time_zooms_and_moves_by_wheel_keys_mouse_and_buttons(
    cart_page: Path, page: Page
) -> None:
    page.open_file(cart_page)
    canvas = page.one(CANVAS)
    page.click(
        canvas, 0.02, 0.02
    )  # outside of the picture: it gets the keys, and nothing is chosen
    whole = page.pixels(canvas)
    turn = ActionChains(page.driver).scroll_from_origin(ScrollOrigin.from_element(canvas), 0, -300)
    ways: dict[str, Any] = {
        "wheel": turn.perform,
        "key": lambda: page.keys(canvas, "+"),
        "button": lambda: page.all(".ground .zoom button")[1].click(),
    }
    for name, zoom in ways.items():
        zoom()
        page.until(lambda: differ(page.pixels(canvas), whole))
        near = page.pixels(canvas)
        page.keys(canvas, Keys.ARROW_DOWN)
        assert differ(page.pixels(canvas), near), name
        page.drag(canvas, 0.3, 0.6)
        page.keys(canvas, "0")
        assert not differ(page.pixels(canvas), whole), name
    assert page.text(".organism h3") == "No organism is chosen", "to drag is not to click"


def test_two_fingers_zoom_the_picture_and_a_tap_chooses(cart_page: Path, page: Page) -> None:
    page.size(*PHONE, mobile=True)
    page.open_file(cart_page)
    canvas = page.one(CANVAS)
    page.script("arguments[0].scrollIntoView({block: 'center'})", canvas)
    whole = page.pixels(canvas)
    box = page.script(
        "const {left, top} = arguments[0].getBoundingClientRect(); return [left, top]", canvas
    )
    points = [[(150 - apart, 200), (150 + apart, 200)] for apart in (20, 35, 50, 65, 80)]
    page.touch("touchStart", box, points[0])
    for each in points[1:]:
        page.touch("touchMove", box, each)
    page.touch("touchEnd", box, [])
    page.until(lambda: differ(page.pixels(canvas), whole))
    assert page.text(".organism h3") == "No organism is chosen", "to pinch is not to tap"
    page.touch("touchStart", box, [(150, 200)])
    page.touch("touchEnd", box, [])
    page.until(lambda: page.text(".organism h3") != "No organism is chosen")


def test_the_page_scrolls_by_the_wheel_until_the_picture_is_chosen(
    cart_page: Path, page: Page
) -> None:
    page.open_file(cart_page)
    canvas = page.one(CANVAS)
    whole = page.pixels(canvas)
    ActionChains(page.driver).scroll_by_amount(0, 300).perform()
    page.until(lambda: page.script("return scrollY") > 0)
    assert not differ(page.pixels(canvas), whole)


def test_a_film_is_scrubbed_played_and_asked_about(
    torus: Path, torus_page: Path, page: Page
) -> None:
    page.open_file(torus_page)
    canvas, slider = page.one(".film canvas"), page.one(".film input")
    last = page.pixels(canvas)
    assert page.script("return arguments[0].width", canvas) == 6
    page.keys(slider, Keys.HOME)
    assert page.text(".film .readout").startswith("birth 1,")
    first = page.pixels(canvas)
    assert differ(first, last)
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


def test_the_phylogeny_is_read_by_mouse_and_keys(torus_page: Path, page: Page) -> None:
    page.open_file(torus_page)
    page.keys(page.one(".tree"), Keys.ARROW_DOWN, Keys.ARROW_DOWN)
    readout = page.text(".tree + .readout")
    told = re.match(r"organism ([\d,]+), born at tick [\d,]+, alive, ", readout)
    assert told, readout
    page.until(lambda: page.all(".tree .on"))
    page.keys(page.one(".tree"), Keys.ENTER)
    assert page.text(".organism h3") == f"Organism {told[1]}"
    page.hover(page.all(".tree .hit")[3], 0.5, 0.5)
    page.until(lambda: page.text(".tree + .readout") != readout)


def test_a_line_of_descent_stays_marked_when_the_tree_is_drawn_again(
    torus_page: Path, page: Page
) -> None:
    page.open_file(torus_page)
    page.keys(page.one(".tree"), Keys.ARROW_DOWN)
    marked = "return [...document.querySelectorAll('.tree .on')].map((each) => each.dataset.node)"
    line = page.until(lambda: page.script(marked))
    drawn = page.one(".tree svg")
    page.size(900, 900)
    page.until(lambda: page.one(".tree svg") != drawn)
    assert page.script(marked) == line


def test_another_world_is_shown_when_it_is_chosen(torus_page: Path, page: Page) -> None:
    page.open_file(torus_page)
    before = page.pixels(page.one(CANVAS))
    options = page.all("#world option")
    assert [each.text for each in options] == ["seed 5", "seed 6", "seed 7"]
    options[2].click()
    page.until(lambda: differ(page.pixels(page.one(CANVAS)), before))


def test_light_and_dark_are_those_of_the_system_or_chosen(cart_page: Path, page: Page) -> None:
    page.prefers(color_scheme="dark")
    page.open_file(cart_page)

    def ground() -> int:
        """Return the brightness of the page, from 0 to 255."""
        colour = page.script("return getComputedStyle(document.body).backgroundColor")
        return max(map(int, re.findall(r"\d+", colour)[:3]))

    assert ground() < 60
    before = page.pixels(page.one(CANVAS))
    next(each for each in page.all("#scheme option") if each.text == "light").click()
    assert ground() > 200
    page.until(lambda: differ(page.pixels(page.one(CANVAS)), before))


@pytest.mark.parametrize("which", ["cart_page", "torus_page"])
def test_a_phone_shows_it_without_scrolling_sideways(
    which: str, page: Page, request: pytest.FixtureRequest
) -> None:
    page.size(*PHONE, mobile=True)
    page.open_file(request.getfixturevalue(which))
    page.until(lambda: page.all(".tree svg") and page.all(".chart canvas"))
    assert page.script("return document.documentElement.scrollWidth") <= PHONE[0]
    outside = page.script(
        "return [...document.querySelectorAll('main *')].filter((each) =>"
        " each.getBoundingClientRect().right > innerWidth + 1 && !each.closest('.wide, .hidden, svg'))"
        ".map((each) => each.outerHTML.slice(0, 80))"
    )
    assert outside == []


def test_whatever_can_be_used_has_a_name_and_shows_when_it_has_the_focus(
    torus_page: Path, page: Page
) -> None:
    page.open_file(torus_page)
    page.until(lambda: page.all(".chart canvas"))
    page.script("document.querySelectorAll('details').forEach((each) => (each.open = true))")
    used = page.all("button, select, input, video, .ground canvas, .film canvas, [tabindex='0']")
    assert len(used) > 20
    unnamed = [
        each.get_attribute("outerHTML")[:80]
        for each in used
        if not each.accessible_name and each.tag_name != "pre"
    ]
    assert unnamed == []
    assert len(page.all("h1")) == 1
    assert page.script("return document.documentElement.lang") == "en"
    ActionChains(page.driver).send_keys(Keys.TAB).perform()
    assert page.script("return document.activeElement.className") == "skip"
    for _ in range(6):
        ActionChains(page.driver).send_keys(Keys.TAB).perform()
        style = "return getComputedStyle(document.activeElement).outlineStyle"
        assert page.script(style) != "none", page.script("return document.activeElement.outerHTML")


def test_no_name_of_a_run_is_read_as_html(cart: Path, tmp_path: Path, page: Page) -> None:
    hostile = "</script><script>document.title = 'hacked'</script><img src=x onerror='hacked()'>"
    run = Archive(cart)
    run.config = run.config.model_copy(update={"task": hostile, "about": hostile})
    (tmp_path / "page.html").write_text(made(of_run(run, filmed=False)), encoding="utf-8")
    page.open_file(tmp_path / "page.html")
    assert page.text("h1") == hostile
    assert page.driver.title.startswith(hostile)
    assert page.all("img") == []
    assert page.complaints() == []


def test_the_arms_of_an_experiment_stand_side_by_side(tmp_path: Path, page: Page) -> None:
    file, out = write(tmp_path, jobs={"worlds": 3}), tmp_path / "out"
    for job in (0, 1):
        assert here("experiment", file, "--out", out, "--job", job, "--quiet").returncode == 0
    page.open_file(primordia.load(out).report())
    assert page.text("h1") == "Is it mild?"
    assert [each.text for each in page.all("tbody th")] == ["mild", "harsh", "harsh"]
    assert [each.text for each in page.all("#world option")] == ["mild, seed 3", "harsh, seed 3"]
    charts = page.all(".chart h3")
    assert charts[0].text == "Alive at each age"
    page.until(lambda: len(page.all(".chart canvas")) == len(charts))
    assert page.complaints() == []
    page.size(*PHONE, mobile=True)
    page.until(lambda: page.script("return document.documentElement.scrollWidth") <= PHONE[0])


def test_the_commands_are_copied_or_at_least_selected(cart_page: Path, page: Page) -> None:
    page.open_file(cart_page)
    button = page.one(".command button")
    button.click()
    page.until(lambda: button.text in ("Copied", "Selected"))
    assert page.text(".command pre").startswith("primordia run CartPole-survival --cells 16")
