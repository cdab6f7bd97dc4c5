"""Runs that pages are made of: three small worlds on a torus, and the same with few words."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia.report import lives
from primordia.runs import loop
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
def shore(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of two worlds on a torus, with islands of a row and of three rows."""
    where = tmp_path_factory.mktemp("report") / "shore"
    islands = [{"name": "dune"}, {"name": "marsh", "share": 3.0, "hazard": 0.02}]
    habitat = {**TORUS["habitat"], "islands": islands}
    loop.start(config({**TORUS, "habitat": habitat, "seeds": 2, "stop": {"ticks": 400}}), where)
    return where


@pytest.fixture(scope="session")
def cart(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run with poles on carts, whose lives can be filmed."""
    where = tmp_path_factory.mktemp("report") / "cart"
    loop.start(config(cells=16, stop={"ticks": 1500, "until": None}), where)
    return where


@pytest.fixture(scope="session")
def cart_page(cart: Path) -> Path:
    """Write the page of a run, with short films."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lives, "PART", 1.0)
        return primordia.load(cart).report()


@pytest.fixture(scope="session")
def torus_page(torus: Path) -> Path:
    """Write the page of a run of three worlds on a torus."""
    return primordia.load(torus).report()


@pytest.fixture(scope="session")
def shore_page(shore: Path) -> Path:
    """Write the page of a run with islands."""
    return primordia.load(shore).report()


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
