"""Functions of the page's scripts, called in a browser. A case is an expression and its value."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from primordia.report.packed import packed
from tests.report.browser import Page

Ask = Callable[[str], Any]

WORLD: dict[str, Any] = {
    "births": 100,
    "cells": 8,
    "shown": 4,
    "step": 2,
    "rate": 50,
    "whole": True,
    "moments": [0, 10, 20, 40, 80, 99],
    "ticks": [0, 15, 25, 60, 300, 1000],
    "firstOf": [0, 2, 2, 4, 5],
    "segments": {
        "column": [0, 0, 2, 2, 3],
        "organism": [0, 1, 2, 2, 4],
        "start": [0, 40, 10, 20, 80],
        "stop": [20, 100, 20, 40, 81],
        "ink": [0, 1, 2, 3, 0],
    },
    "facts": {
        "number": [0, 3, 7, 8, 12, 13],
        "ancestor": [0, 1, 0, 2, 3, 4],
        "cell": [0, 0, 4, 3, 6, 2],
        "first": 0,
    },
}
"""Organism 3 descends from 0, 8 from 3 and 13 from 8; 12 descends from 7."""

NUMBERS = [
    ("[1234.5, 999999].map(whole)", ["1,235", "999,999"]),
    ("[0, 0.01, 0.1, 0.5, 500, 999, 1000, 1500, 12345, 2e6, 1e9, -1500, 123.456].map(short)",
     ["0", "1/100", "0.1", "0.5", "500", "999", "1k", "1.5k", "12.3k", "2M", "1G", "-1.5k", "123.5"]),
    ("[0.01234, 12.345, 99.96, 100, 1234.4].map(exact)", ["0.0123", "12.3", "100", "100", "1,234"]),
    ("[2950, 3000, 179950, 180000, 183100].map((ticks) => simulated(ticks, 50))",
     [" (59 s)", " (1 min 0 s)", " (59 min 59 s)", " (1 h 0 min)", " (1 h 1 min)"]),
    ("simulated(100, null)", ""),
    ("roundNumbers(0, 100, 10)", [0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100]),
    ("roundNumbers(3, 47, 4)", [20, 40]),
    ("roundNumbers(1, 4, 10)", [1, 2, 3, 4]),
    ("roundNumbers(0, 30, 6)", [0, 5, 10, 15, 20, 25, 30]),
]  # fmt: skip
PLACES = [
    ("[0, 1, 2, 3, 5, 9].map((wanted) => lastUpTo([1, 3, 3, 5], wanted))", [-1, 0, 0, 2, 3, 3]),
    ("[lastUpTo([1, 3, 3, 5], 9, 1, 3), lastUpTo([1, 3, 3, 5], 0, 1, 3)]", [2, 0]),
    ("firstOfColumns([0, 0, 2, 2, 3], 4)", [0, 2, 2, 4, 5]),
    ("[-1, 0, 9.9, 10, 99].map((place) => momentAt(world, place))", [0, 0, 0, 1, 5]),
    ("[0, 39, 40, 100].map((place) => tickAt(world, place))", [0, 25, 60, 1000]),
    ("[0, 19, 20, 39, 40, 99].map((place) => segmentAt(world, 0, place))", [0, 0, -1, -1, 1, 1]),
    ("[0, 10, 20, 40].map((place) => segmentAt(world, 2, place))", [-1, 2, 3, -1]),
    ("[segmentAt(world, 1, 20), segmentAt(world, 3, 80)]", [-1, 4]),
    ("[0, 3, 5, 13, 14, -1].map((number) => organismOf(world, number))", [0, 1, -1, 5, -1, -1]),
    ("descentOf(world, 5)", [5, 3, 1, 0]),
    ("[...litBy(world, 1)]", [2, 2, 1, 3, 1, 3]),
    ("[...litBy(world, 0)]", [2, 3, 1, 3, 1, 3]),
    ("litBy(world, -1)", None),
    ("extentOf(world, 2)", {"column": 2, "start": 10, "stop": 40}),
    ("extentOf(world, 1)", {"column": 0, "start": 40, "stop": 100}),
    ("[extentOf(world, 3), extentOf(world, 5)]", [None, None]),
]
VIEWS = [
    ("edges(wholeView(world))", [0, 4, 0, 100]),
    ("[[0, 4, 0, 100], [0, 4, 1, 100], [1, 4, 0, 100]].map((each) => isWhole(world, view(...each)))",
     [True, False, False]),
    ("edges(zoomedView(world, wholeView(world), 0.5))", [0, 4, 25, 75]),
    ("edges(zoomedView(world, wholeView(world), 0.5, 0, 1))", [0, 4, 50, 100]),
    ("edges(zoomedView(world, view(0, 4, 90, 98), 0.1))", [0, 4, 90, 98]),
    ("edges(zoomedView(world, view(0, 4, 80, 100), 2))", [0, 4, 60, 100]),
    ("zoomedSpan(10, 30, 0.5, 0.25, 40, 4)", [12.5, 22.5]),
    ("edges(movedView(world, view(0, 2, 40, 60), 0.5, -0.5))", [1, 3, 30, 50]),
    ("edges(movedView(world, view(0, 2, 40, 60), 9, 9))", [2, 4, 80, 100]),
    ("[[1, 40], [2, 50], [1, 60]].map((at) => edges(viewWith(world, view(0, 2, 40, 60), ...at)))",
     [[0, 2, 40, 60], [1, 3, 40, 60], [0, 2, 50, 70]]),
    ("[[3, 11], [2, 10], [0, 60]].map((ends) => candidates(...ends))",
     [[3, 4, 5, 6, 7, 8, 9, 10, 11], [2, 5, 10], [1, 2, 5, 10, 20, 50]]),
    ("ticksInView(world, wholeView(world), 440)",
     [[0, 1], [10, 20], [20, 50], [40, 100], [80, 500], [99, 1000]]),
    ("ticksInView(world, view(0, 4, 10, 80), 70)", [[10, 20], [40, 100]]),
    ("Object.values(scalesOf({ left: 50, top: 20, width: 400, height: 300 }, view(1, 3, 40, 100)))"
     ".map((each) => each.call ? each(50) : each)", [50 + 49 * 200, 70, 200, 5]),
    ("[...placesOfRows(5, world, wholeView(world))]", [10, 20, 40, 40, 80]),
]  # fmt: skip
CHARTS = [
    ("[0, 1, 2, 3].map((at) => nearestValue([undefined, 4, undefined, null], at, 'line') ?? -1)",
     [-1, 4, 4, -1]),
    ("nearestValue([4, undefined], 1, 'dots') ?? -1", -1),
    ("[[1, 2, 5, 10, 20, 100], [1, 2, 5, 10], [2, 5, 10, 20]].map((at) => powersOfTen(null, at))",
     [[1, None, None, 10, None, 100], [1, None, None, 10], [2, 5, 10, 20]]),
    ("roomAround(true)(null, 3, 400)", [1, 1000]),
    ("[[5, 100], [-5, 0]].map((ends) => roomAround(false)(null, ...ends))", [[0, 106], [-5, 1]]),
    ("bandsOf([{ kind: 'line' }, { kind: 'high', colour: '#000000' }, { kind: 'low' }])"
     ".map((each) => each.series)", [[2, 3]]),
    ("[scale(true).distr, scale(undefined).distr]", [3, 1]),
    ("zoomed(1, 101, [1, 101], (u) => zoomChart(u, 'in'))", [21, 81]),
    ("zoomed(1, 101, [1, 101], (u) => zoomChart(u, 'in', 0))", [1, 61]),
    ("zoomed(21, 81, [1, 101], (u) => zoomChart(u, 'out'))", [1, 101]),
    ("zoomed(21, 51, [1, 101], (u) => zoomChart(u, 'out'))", [11, 61]),
    ("zoomed(21, 51, [1, 101], (u) => zoomChart(u, 'all'))", [1, 101]),
    ("zoomed(1, 10, [1, 10000], (u) => moveChart(u, 1), 3)", [10, 100]),
    ("zoomed(21, 41, [1, 101], (u) => moveChart(u, 0.2))", [25, 45]),
    ("zoomed(81, 101, [1, 101], (u) => moveChart(u, 0.2))", [81, 101]),
    ("zoomed(2, 22, [1, 101], (u) => moveChart(u, -0.2))", [1, 21]),
]  # fmt: skip
COLOURS = [
    ("rgbOf('#0072b2')", [0, 114, 178]),
    ("mixed([0, 100, 200], [100, 200, 0], 0.25)", [25, 125, 150]),
    ("css([1, 2, 3])", "rgb(1 2 3)"),
    ("luminance([255, 255, 255]).toFixed(3)", "1.000"),
    ("[[255, 0, 0], [0, 255, 0], [0, 0, 255]].map(luminance)", [0.3, 0.59, 0.11]),
    ("aged([0, 100, 200], 7)", [0, 100, 200]),
    ("aged([0, 100, 200], 0)", [128, 178, 228]),
    ("inks([[10, 20, 30], [90, 90, 90]])[0]", [10, 20, 30]),
    ("inks([[10, 20, 30], [90, 90, 90]]).length", 2),
    ("curveColour('#222222') === variable('--ink')", True),
    ("curveColour('#d4d4d4') === variable('--soft')", True),
    ("curveColour('#0072b2')", "rgb(0 114 178)"),
]
NODES = (
    "[{ number: 5, born: 1200, alive: false, skipped: 0, parent: -1 },"
    " { number: 1700, born: 3000, alive: true, skipped: 0, parent: 0 },"
    " { number: 9, born: 7, alive: true, skipped: 1, parent: 1 }]"
)
FACTS = (
    "{ name: 'mild', settings: { cells: '8' }, toml: 'cells = 8', versions: { jax: '1' },"
    " digests: [{ seed: '3', digest: 'abc' }], exact: true, restarts: 0, commands: ['primordia run a'] }"
)
PAIR = (
    "{ rate: 50, facts: { number: [0, 7], first: 1000, born: [0, 5], lifespan: [300, 5000],"
    " cell: [0, 3], origin: [0, 2], origins: ['founder', 'copy', 'mutant'], cause: [0, 3],"
    " causes: ['fatal', 'starved', 'hazard'], parent: [0, 1], generation: [0, 1], children: [1, 0] } }"
)
MANY = "{ facts: { children: [12], number: [...Array(13).keys()], parent: [0, ...Array(12).fill(1)] } }"
TEXTS = [
    (f"card({PAIR}, 1).map((each) => each.textContent)",
     ["Organism 7", "Borntick 1,005, with mutationsCell3Lived5,000 ticks (1 min 40 s)"
      "Diedtick 6,005, hazardParent0Generation1Children0"]),
    (f"card({PAIR}, 0).map((each) => each.textContent)",
     ["Organism 0", "Borntick 1,000, a founderCell0Age300 ticks (6 s)StatealiveParentnone"
      "Generation0Children1: 7 "]),
    (f"childrenOf({MANY}, 0).textContent", "12: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, … "),
    ("[0, 1, 9, 10, 11].map((count) => childrenOf({ facts: { children: [count],"
     " number: [...Array(11).keys()], parent: [0, ...Array(10).fill(1)].slice(0, count + 1) } }, 0)"
     ".textContent.trim())",
     ["0", "1: 1", "9: 1, 2, 3, 4, 5, 6, 7, 8, 9", "10: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10",
      "11: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, …"]),
    ("childrenOf({ facts: { children: [3], number: [4, 9], parent: [0, 5] } }, 0).textContent",
     "3: 9, … "),
    ("[0, 1, 2].map((at) => parentOf({ facts: { number: [3, 9, 12], parent: [0, 8, 10] } }, at))"
     ".map((each) => each.textContent || each)",
     ["none", "7, not in the picture", "9"]),
    (f"[0, 1, 2].map((at) => nodeText({NODES}, at))",
     ["organism 5, born at tick 1,200, an ancestor, no parent on record",
      "organism 1,700, born at tick 3,000, alive, 1 generation from organism 5",
      "organism 9, born at tick 7, alive, 2 generations from organism 1,700"]),
    ("groundText({ topology: 'ring', cells: 8, shown: 8, whole: true })",
     "Cells lie across, in the order of the ring; births run downwards. Each colour is a line of"
     " descent: strong if the line lasted, pale if the line died out; gaps are empty cells."),
    ("groundText({ topology: 'torus4', cells: 1200, shown: 400, whole: false }).split('. ')",
     ["Cells lie across, row after row of the torus; births run downwards",
      "Each colour is a line of descent: strong if the line lasted, pale if the line died out; gaps"
      " are empty cells",
      "400 of 1,200 cells are shown",
      "The picture shows the cells after some of the births only; shorter lives may be missing."]),
    (f"factsOf({FACTS}).map((each) => each.textContent)",
     ["mild", "primordia run aCopy", "All settings as config.tomlcells = 8Copy", "Settingscells8",
      "Versionsjax1", "Digest of the worldseed 3abc"]),
    (f"factsOf({{ ...{FACTS}, exact: false, restarts: 1200,"
     " commands: ['primordia run config.toml', 'b'] }).slice(1, 5).map((each) => each.textContent)",
     ["This run is not exact: parts of the run cannot be repeated bit for bit.",
      "The living got new bodies 1,200 times, when the run was resumed.",
      "primordia run config.toml\nbCopy", "config.toml, which the command takescells = 8Copy"]),
    (f"factsOf({{ ...{FACTS}, name: '', digests: [{{ seed: '3', digest: 'abc' }}, {{ seed: '4',"
     " digest: 'de' }] }).map((each) => each.textContent)",
     ["primordia run aCopy", "All settings as config.tomlcells = 8Copy", "Settingscells8",
      "Versionsjax1", "Digests of the worldsseed 3abcseed 4de"]),
    ("groundText({ topology: 'well-mixed', cells: 8, shown: 8, whole: true }).split(';')[0]",
     "Cells lie across, all neighbours of each other"),
    ("livesSection({ films: [], missing: 'no' }).textContent", "LivesNot filmed: no."),
    ("[...wideTable({ title: 't', head: ['a', 'b'], rows: [['x', '1'], ['y', '2']] })"
     ".querySelectorAll('caption, th, td')].map((each) => each.textContent)",
     ["t", "a", "b", "x", "1", "y", "2"]),
    ("[unknown({ whole: true }, '7'), unknown({ whole: false }, '7'), unknown({}, '')]"
     ".map((each) => each[1].textContent)",
     ["Organism 7 was not born in this world.", "Organism 7 is not in this picture.",
      "Give a birth number."]),
]  # fmt: skip
MARKED = (
    "((tick, cause) => { const marks = []; markInFilm({ fillRect: (...box) => marks.push(box) },"
    " { at: 1, ticks: [0, tick], columns: 4 }, { facts: { first: 4, born: [0, 6], lifespan: [1, 5],"
    " cause: [1, cause], cell: [0, 6] } }, 1); return marks; })"
)
"""The marks of an organism in cell 6, which is born at tick 10 and dies at tick 15, or is alive."""
FILM = [
    (f"[0, 9, 10, 14, 15].map((tick) => {MARKED}(tick, 1))",
     [[], [], [[2, 1, 1, 1]], [[2, 1, 1, 1]], []]),
    (f"[9, 10, 15, 99].map((tick) => {MARKED}(tick, 0).length)", [0, 1, 1, 1]),
]  # fmt: skip
CASES: dict[str, Any] = {
    "film": FILM,
    "texts": TEXTS,
    "numbers": NUMBERS,
    "places": PLACES,
    "views": VIEWS,
    "charts": CHARTS,
    "colours": COLOURS,
}

HELPERS = """
const world = arguments[0];
const view = (left, right, top, bottom) => ({ left, right, top, bottom });
const edges = ({ left, right, top, bottom }) => [left, right, top, bottom];
const zoomed = (min, max, xs, act, distr = 1) => {
  let found = null;
  const setScale = (_, { min: low, max: high }) => (found = [low, high]);
  act({ data: [xs], scales: { x: { min, max, distr } }, setScale });
  return found.map((each) => Number(each.toPrecision(9)));
};
"""


@pytest.fixture(scope="module")
def ask(started: Page, torus_page: Path) -> Ask:
    """Return a function that gives the value of an expression in the light page of a run."""
    started.prefers(color_scheme="light")
    started.size(1200, 900)
    started.open_file(torus_page)
    return lambda code: started.script(f"{HELPERS} return {code};", WORLD)


@pytest.mark.parametrize("what", list(CASES))
def test_functions_of_the_scripts_return_the_expected_values(what: str, ask: Ask) -> None:
    cases: list[tuple[str, Any]] = CASES[what]
    found = ask(f"[{', '.join(code for code, _ in cases)}]")
    for (code, expected), got in zip(cases, found, strict=True):
        assert got == expected, code


def test_arrays_are_unpacked_as_they_were_packed(ask: Ask, started: Page) -> None:
    code = "const [each, done] = arguments; unpacked(each).then((values) => done([...values]));"
    for values in ([], [0, 255, 3], [7, 65535], [70_000, 5], [2**40, 1]):
        for rising in (False, True):
            given = sorted(values) if rising else values
            array = packed(np.array(given, np.int64), rising)
            assert started.driver.execute_async_script(code, array) == given


def test_each_pixel_of_space_time_has_the_colour_of_its_segment(ask: Ask) -> None:
    """The rows show births 10, 20, 40, 40 and 80. If organism 3 is chosen, each organism has the ink of
    its state."""
    inks = "[[1, 2, 3, 4], [11, 12, 13, 14], [21, 22, 23, 24], [31, 32, 33, 34]]"
    paint = (
        "((lit, first, columns) => { const pixels = new Uint32Array(5 * columns);"
        " fillPixels(pixels, columns, 5, first, world, wholeView(world), lit,"
        f" Object.assign({inks}, {{ empty: 0 }})); return [...pixels]; }})"
    )
    columns = [[1, 0, 2, 2, 2], [0] * 5, [3, 4, 0, 0, 0], [0, 0, 0, 0, 1]]
    assert ask(f"{paint}(null, 0, 4)") == np.array(columns).T.ravel().tolist()
    lit = [[21, 0, 22, 22, 22], [0] * 5, [13, 14, 0, 0, 0], [0, 0, 0, 0, 11]]
    assert ask(f"{paint}(litBy(world, 1), 0, 4)") == np.array(lit).T.ravel().tolist()
    assert ask(f"{paint}(null, 2, 2)") == np.array(columns[2:]).T.ravel().tolist()
    table = ask(
        "colourTable([[10, 20, 30], [90, 80, 70]]).map((inks) => [...inks].map((pixel) =>"
        " [pixel & 255, (pixel >> 8) & 255, (pixel >> 16) & 255]))"
    )
    empty = np.array(ask("rgbOf(variable('--empty'))"))
    for state, share in ((0, 0.0), (1, 0.86), (3, 0.35)):
        for got, ink in zip(table[state], ([10, 20, 30], [90, 80, 70]), strict=True):
            assert got == pytest.approx((1 - share) * np.array(ink) + share * empty, abs=0.51)
    assert table[2] == [[10, 20, 30]] * 2, "the chosen line of descent is always strong"
