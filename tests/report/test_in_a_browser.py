"""The page as a whole in a browser: it needs no network, and suits screens, keys and readers."""

import re
from functools import partial
from pathlib import Path

import pytest
from selenium.webdriver import ActionChains
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement

import primordia
from primordia.report.page import page as made
from tests.commands import here
from tests.experiments.meadows import herds
from tests.report.browser import PHONE, Page
from tests.report.unpacked import content_of

CANVAS = ".ground canvas"


def is_painted(page: Page, canvas: WebElement) -> bool:
    return page.picture(canvas)[1] > 2


def is_loaded(page: Page, video: WebElement) -> bool:
    return bool(page.script("return arguments[0].readyState >= 2", video))


BOTH = pytest.mark.parametrize(
    "which", ["cart_page", pytest.param("torus_page", marks=pytest.mark.slow)]
)
"""Pages with films and with several worlds."""


@BOTH
def test_every_figure_shows_and_the_page_loads_nothing_else(
    which: str, page: Page, request: pytest.FixtureRequest
) -> None:
    """The commands are copied, or else selected."""
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
    button = page.one(".command button")
    button.click()
    page.until(lambda: button.text in ("Copied", "Selected"))
    repeated = {"cart": "primordia run config.toml --out", "torus": "primordia verify torus"}
    assert page.text(".command pre").startswith(repeated[path.parent.name])


def test_light_and_dark_are_those_of_the_system_or_chosen(cart_page: Path, page: Page) -> None:
    page.prefers(color_scheme="dark")
    page.open_file(cart_page)

    def ground() -> int:
        """Return the brightness of the page, from 0 to 255."""
        colour = page.script("return getComputedStyle(document.body).backgroundColor")
        return max(map(int, re.findall(r"\d+", colour)[:3]))

    assert ground() < 60
    before = page.picture(page.one(CANVAS))
    next(each for each in page.all("#scheme option") if each.text == "light").click()
    assert ground() > 200
    page.until(lambda: page.picture(page.one(CANVAS)) != before)


@BOTH
def test_a_phone_shows_the_page_without_scrolling_sideways_and_takes_fingers(
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
    two_fingers_zoom_the_picture_and_a_tap_chooses(page)


def two_fingers_zoom_the_picture_and_a_tap_chooses(page: Page) -> None:
    canvas = page.one(CANVAS)
    page.script("arguments[0].scrollIntoView({block: 'center'})", canvas)
    whole = page.picture(canvas)
    box = page.script(
        "const {left, top} = arguments[0].getBoundingClientRect(); return [left, top]", canvas
    )
    points = [[(150 - apart, 200), (150 + apart, 200)] for apart in (20, 35, 50, 65, 80)]
    page.touch("touchStart", box, points[0])
    for each in points[1:]:
        page.touch("touchMove", box, each)
    page.touch("touchEnd", box, [])
    page.until(lambda: page.picture(canvas) != whole)
    assert page.text(".organism h3") == "No organism is chosen", "a pinch is no tap"
    page.touch("touchStart", box, [(150, 200)])
    page.touch("touchEnd", box, [])
    page.until(lambda: page.text(".organism h3") != "No organism is chosen")


def test_each_control_has_a_name_and_shows_its_focus(torus_page: Path, page: Page) -> None:
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


def test_no_name_is_read_as_html_and_the_buttons_of_a_film_leave_its_panel_free(
    cart_page: Path, tmp_path: Path, page: Page
) -> None:
    hostile = "</script><script>document.title = 'hacked'</script><img src=x onerror='hacked()'>"
    content = {**content_of(cart_page), "title": hostile, "subtitle": hostile}
    content["films"]["films"][1]["panel"] = True
    (tmp_path / "page.html").write_text(made(content), encoding="utf-8")
    page.open_file(tmp_path / "page.html")
    assert page.text("h1") == hostile
    assert page.driver.title.startswith(hostile)
    assert page.all("img") == []
    free = []
    for video in page.all("video"):
        page.until(partial(is_loaded, page, video))
        ratio = page.script("return arguments[0].videoHeight / arguments[0].videoWidth", video)
        free.append(video.size["height"] - ratio * video.size["width"])
    assert abs(free[0]) < 2
    assert free[1] > 60
    assert page.complaints() == []


@pytest.mark.slow
def test_the_arms_of_an_experiment_stand_side_by_side(tmp_path: Path, page: Page) -> None:
    file, out = herds(tmp_path), tmp_path / "out"
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
