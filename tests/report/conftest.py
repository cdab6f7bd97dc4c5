"""Runs that pages are made of: three small worlds on a torus, and the same with few words."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia.organism.reliving import replay
from primordia.report import lives
from primordia.report.content import of_run
from primordia.report.page import page as page_of
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.report.browser import DESKTOP, Page, browser
from tests.worlds import HERD, config

TORUS: dict[str, Any] = {
    **HERD,
    "about": "Meadows in which nothing moves.",
    "seed": 5,
    "stop": {"ticks": 900},
}


@pytest.fixture(scope="session")
def torus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of three worlds with births, copies and deaths of several causes."""
    where = tmp_path_factory.mktemp("report") / "torus"
    loop.start(config(TORUS), where)
    return where


@pytest.fixture(scope="session")
def torus_content(torus: Path) -> dict[str, Any]:
    """Return the content of its page."""
    return of_run(Archive(torus), filmed=False)


@pytest.fixture(scope="session")
def shore(torus: Path) -> Archive:
    """Return the run on a torus as if its rows were islands: the first one, and the other three."""
    islands = [{"name": "dune"}, {"name": "marsh", "share": 3.0}]
    run = Archive(torus)
    run.config = config({**TORUS, "habitat": {**TORUS["habitat"], "islands": islands}})
    return run


@pytest.fixture(scope="session")
def cart(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run with poles on carts, whose lives can be filmed."""
    where = tmp_path_factory.mktemp("report") / "cart"
    loop.start(config(cells=8, hazard=0.002, stop={"ticks": 1500, "until": None}), where)
    return where


@pytest.fixture(scope="session")
def cart_page(cart: Path) -> Path:
    """Write the page of a run, with short films."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lives, "PART", 0.2)
        patch.setattr(replay, "STILL", 0.1)
        return primordia.load(cart).report()


@pytest.fixture(scope="session")
def torus_page(torus: Path) -> Path:
    """Write the page of a run of three worlds on a torus."""
    return primordia.load(torus).report()


@pytest.fixture(scope="session")
def shore_page(shore: Archive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the page of a run with islands."""
    file = tmp_path_factory.mktemp("report") / "shore.html"
    file.write_text(page_of(of_run(shore, filmed=False)), encoding="utf-8")
    return file


@pytest.fixture(scope="session")
def started() -> Iterator[Page]:
    """Start a browser."""
    with browser() as page:
        yield page


@pytest.fixture
def page(started: Page) -> Page:
    """Return the browser at the size of a desktop, with a user who prefers nothing."""
    started.size(*DESKTOP)
    started.prefers(color_scheme="light")
    return started
