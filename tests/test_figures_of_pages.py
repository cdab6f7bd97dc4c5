"""Measured figures in pages come from committed tables, and what rests on the first seeds says so."""

import re
import tomllib
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from primordia import config

HERE = Path(__file__).parent.parent
TEMPLATES = HERE / "docs" / "templates"
PAGES = sorted(
    page for part in ("results", "explanation", "teach") for page in (TEMPLATES / part).glob("*.md")
)
"""Templates of pages that report what was measured."""

NOT_TYPED = re.compile(
    r"^```.*?^```$|^    .*?$|\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\}|`[^`\n]*`|\]\([^)]*\)|https?://\S+",
    re.MULTILINE | re.DOTALL,
)
"""Blocks of code, expressions, code in a sentence, targets of links."""
FIGURE = re.compile(r"(?<![\w.,:-])-?\d[\d,]*(?:\.\d+)?(?![\w.]*\d)")
UNKEPT = re.compile(r"no\s+table\s+is\s+kept|kept\s+nowhere\s+else")
"""What a page says of figures that were written down once, when runs were not kept yet."""
KNOWN = {
    **dict.fromkeys(("65,536", "4.32"), "the table of Gaussian quantiles"),
    **dict.fromkeys(("102,000", "225"), "figures of the paper"),
    "512": "the founders among which an assay chooses",
    "2.4": "CartPole's track, in the published code",
    "65,210": "the tick at which the clock of Pong's console comes round",
    "7,141": "the ticks of a round of Boxing",
    "8,192": "the ticks of a game of Freeway",
    "3,000": "the length of games from any start, in starts.py",
    "1.7": "0.3 times the root of 32, a spectral radius",
    "8,000": "the length at which games of the first seeds were cut, and lives of tanks in words",
    **dict.fromkeys(("1,800", "12,139", "787"), "reinforcement learning with robots, in tasks.md"),
    "2,500": "the ticks of a game of Freeway in MinAtar",
    "198": "the weights of a tank with ten senses and 18 buttons",
    **dict.fromkeys(
        ("2,360", "15,820", "16,411", "16,600", "17,367", "26,300", "37,800", "62,010", "98,235"),
        "papers that the table of BattleZone names",
    ),
}
"""Figures that are typed by hand, each with its reason."""


@pytest.fixture(scope="module", name="fill")
def _fill() -> Iterator[ModuleType]:
    """The script that fills templates."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TEMPLATES))
        yield import_module("fill")


@pytest.fixture(scope="module")
def filled(fill: ModuleType) -> dict[Path, str]:
    """Return the text that each page should have.

    For speed the settings of each task are read once, and no habitat is made.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(config, "load", cache(config.load))
        patch.setattr(config, "check", lambda settings: None)
        pages: dict[Path, str] = fill.pages()
    return pages


def numbers(values: Any) -> Iterator[float]:
    """Yield all numbers of nested settings."""
    if isinstance(values, dict | list):
        for value in values.values() if isinstance(values, dict) else values:
            yield from numbers(value)
    elif isinstance(values, int | float) and not isinstance(values, bool):
        yield float(values)


@cache
def settings() -> set[float]:
    """Return the value of each setting of the tasks and experiments."""
    files = [path for part in ("experiments", "src") for path in (HERE / part).rglob("*.toml")]
    return {number for file in files for number in numbers(tomllib.loads(file.read_text("utf-8")))}


def typed(text: str, set_: set[float]) -> list[str]:
    """Return figures that look measured and are typed by hand: decimals, and numbers from 100 on.

    Left out are settings, years, and what a page says no table is kept of: a block, the table below it,
    or a section that says so at its head.
    """
    found = []
    for section in re.split(r"^(?=## )", text, flags=re.MULTILINE):
        head, *others = blocks = section.split("\n\n")
        if head.startswith("## ") and UNKEPT.search("".join(others[:1])):
            continue
        for before, block in zip(["", *blocks], blocks, strict=False):
            if UNKEPT.search(block) or (block.startswith("|") and UNKEPT.search(before)):
                continue
            found += [each.rstrip(",") for each in FIGURE.findall(NOT_TYPED.sub(" ", block))]
    return [each for each in found if looks_measured(each) and value(each) not in set_]


def looks_measured(figure: str) -> bool:
    """Say whether a figure is a decimal, or a number from 100 on that is not a year."""
    year = re.fullmatch(r"(19|20)\d\d", figure) is not None
    return "." in figure or (abs(value(figure)) >= 100 and not year)


def value(figure: str) -> float:
    return float(figure.replace(",", ""))


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("Lives of 3,456 ticks, at 1.25 m/s, 17 times as long.", ["3,456", "1.25"]),
        ("Lives of {{ cell('a', 'b', 'c') }} ticks, in `runs/3456`.", []),
        ("Worlds of 30,000 ticks, as Schmidgall & Hays 2021 say", []),
        ("Lives of 3,456 ticks (no table is kept):\n\n| 4,567 |\n\n5,678", ["5,678"]),
        ("## Trials\n\nOf these no table is kept.\n\n3,456\n\n## Others\n\n4,567", ["4,567"]),
    ],
)
def test_figures_that_are_typed_by_hand_are_found(text: str, found: list[str]) -> None:
    assert typed(text, {30_000.0}) == found


@pytest.mark.parametrize("template", PAGES, ids=lambda path: path.stem)
def test_no_measured_figure_of_a_page_is_typed_by_hand(template: Path) -> None:
    found = typed(template.read_text(encoding="utf-8"), settings())
    assert set(found) <= KNOWN.keys(), "write an expression over a committed table, or add a reason"


def test_each_reason_for_a_typed_figure_is_still_needed() -> None:
    every = "\n\n".join(path.read_text(encoding="utf-8") for path in PAGES)
    assert KNOWN.keys() <= set(typed(every, settings()))


def test_figures_of_pages_are_those_of_the_tables(filled: dict[Path, str]) -> None:
    """`make figures` fills them in."""
    for page, text in filled.items():
        assert page.read_text(encoding="utf-8") == text, f"{page} differs; run `make figures`"


def test_a_page_says_which_experiments_were_lived_on_the_first_seeds(
    fill: ModuleType, filled: dict[Path, str]
) -> None:
    for page, text in filled.items():
        for block in text.split("\n\n"):
            for folder, name in re.findall(r"\]\([./]*experiments/(\w+)/([\w-]+)\.toml\)", block):
                if not fill.unseen(f"{folder}/{name}"):
                    here = f"{page.name}: {folder}/{name}.toml"
                    assert "first seeds" in block, f"{here} was lived on seeds below 1,000"


def test_four_groups_stand_side_by_side_in_old_and_in_new_tables(
    fill: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Organisms of a world count as their median, so a world with many does not weigh more."""
    monkeypatch.setattr(fill, "_path", lambda name, kind: tmp_path / f"{name}.{kind}")
    fill.rows.cache_clear()
    groups = ("{}", "{}, all alive", "control", "a founder")
    renamed = ("{}: champion", "{}: all alive", "best founder", "founder")
    lives = {0: [1, 2, 9], 1: [4], 2: [30]}
    for name, column, names in (("old", "world", groups), ("new", "seed", renamed)):
        rows = [
            f"{who.format('arm')},{1000 + world},own game,{life + 100 * place}"
            for place, who in enumerate(names)
            for world, each in lives.items()
            for life in each
        ]
        quoted = [re.sub(r"^(.*?),(\d+,own)", r'"\1",\2', row) for row in rows]
        text = "\n".join([f"who,{column},way,lifespan", *quoted])
        (tmp_path / f"{name}-games.csv").write_text(text, encoding="utf-8")
        four = fill.standings(name, "own game", "arm", "control")
        assert [each.median for each in four] == ["4", "104", "204", "304"]
        assert fill.standings(name, "sticky", "arm", "control").best == "not measured"
        assert fill.seeds_of_games(name) == "3, unseen seeds"
    fill.rows.cache_clear()
