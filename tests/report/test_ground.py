"""The space-time picture of a page and its organisms, in a world in which lines often take over."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from primordia.figures import spacetime
from primordia.law.world import BirthCause, Cause
from primordia.phylogeny.clades import clades_of
from primordia.report import ground
from primordia.report.ground import Ground, palette
from primordia.report.organisms import organisms
from primordia.runs.lives import Lives
from tests.pedigrees import moran
from tests.report.unpacked import all_unpacked, unpacked
from tests.synthetic import occupants

CELLS = 8


def takeovers(births: int = 300, cells: int = CELLS) -> Lives:
    """Return a world whose cells are full. In each tick one organism dies, and a child takes its cell."""
    lives = moran(cells, births)
    cell = np.arange(len(lives))
    for row in range(cells, len(lives)):
        (dead,) = np.flatnonzero(lives.died & (lives.ended == lives.born[row]))
        cell[row] = cell[dead]
    return replace(lives, cell=cell.astype(np.int32))


def test_each_cell_shows_the_line_of_its_organism_at_each_moment() -> None:
    """The ink of a line depends on its size, which is counted in cells and moments."""
    lives = takeovers()
    shown, clades = Ground(lives, CELLS), clades_of(lives)
    assert len(clades.renewals) > 5, "lines take over several times"
    segments, inks = shown.segments, all_unpacked(shown.data()["segments"])["ink"]
    places = list(zip(lives.cell[segments["row"]], segments["start"], strict=True))
    assert places == sorted(places), "by cell, and then by time"
    seen: dict[int, list[int]] = {}
    for place in range(len(lives)):
        tick = int(lives.born[place])
        living = occupants(lives, tick)
        there = np.flatnonzero((segments["start"] <= place) & (place < segments["stop"]))
        assert sorted(lives.cell[segments["row"][there]].tolist()) == list(range(CELLS))
        for at in there.tolist():
            row = living[int(lives.cell[segments["row"][at]])]
            (code,) = spacetime.line_codes(lives, clades, np.array([[row]]), np.array([tick]))[0]
            assert (segments["row"][at], segments["code"][at]) == (row, code)
            seen.setdefault(int(code), []).append(int(inks[at]))
    codes = np.array(sorted(seen))
    sizes = np.array([len(seen[code]) for code in codes.tolist()])
    expected = spacetime.line_inks(lives, clades, codes, sizes).tolist()
    assert [set(seen[code]) for code in codes.tolist()] == [{ink} for ink in expected]


def test_the_first_marks_say_when_and_why_lines_began() -> None:
    lives = takeovers(cells=4)
    clades = clades_of(lives)
    marks = Ground(lives, 4).data()["marks"]
    assert len(marks) == 12 < len(clades.renewals)
    assert marks[0] == {"place": 0, "tick": 0, "why": "2 alive: each begins a line"}
    for mark, tick in zip(marks[1:], clades.renewals[1:].tolist(), strict=False):
        births = sum(born < tick for born in lives.born.tolist())
        assert mark == {"place": births, "tick": tick, "why": "one line has taken over"}


def test_of_many_cells_every_third_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """All lines began three births before the end. A line that lasted has a strong ink, also if it lives
    only in cells that are not shown."""
    monkeypatch.setattr(ground, "COLUMNS", 3)
    lives = takeovers().recorded_until(274)
    shown, clades = Ground(lives, CELLS), clades_of(lives)
    data = shown.data()
    assert [data[name] for name in ("cells", "shown", "step", "births")] == [8, 3, 3, 282]
    segments = all_unpacked(data["segments"])
    assert (lives.cell[segments["organism"]] == 3 * segments["column"]).all()
    assert set(segments["column"].tolist()) == {0, 1, 2}
    ticks = lives.born[CELLS:]
    rows = spacetime.occupants(lives, np.arange(CELLS), ticks)
    every = np.unique(spacetime.line_codes(lives, clades, rows, ticks))
    hidden = every[~np.isin(every, shown.segments["code"])]
    inks = spacetime.line_inks(lives, clades, every, np.ones(len(every), int))
    strong = np.isin(hidden, every[inks < len(spacetime.COLOURS)])
    assert 0 < strong.sum() < len(hidden), "some of these lines lasted, and some did not"
    assert ((shown.inks(every)[np.isin(every, hidden)] < len(spacetime.COLOURS)) == strong).all()


@pytest.mark.parametrize("share", [1, 3])
def test_a_world_is_shown_in_part_if_it_exceeds_its_share_of_the_page(
    share: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A larger world is shown at 5 moments. The page then has the organisms of these moments, and up to
    40 of the living."""
    lives = takeovers()
    monkeypatch.setattr(ground, "SEEN", share * CELLS * 5)
    monkeypatch.setattr(ground, "WHOLE", share * 308)
    assert Ground(lives, CELLS, share).data()["whole"] is True
    monkeypatch.setattr(ground, "WHOLE", share * 307)
    part = Ground(lives, CELLS, share)
    data = part.data()
    assert data["whole"] is False
    moments = [int(each) for each in np.linspace(0, 307, 5)]
    assert unpacked(data["moments"]).tolist() == moments
    assert unpacked(data["ticks"]).tolist() == lives.born[moments].tolist()
    ticks = lives.born[moments].tolist()
    seen = {row for tick in ticks for row in occupants(lives, tick).values()}
    assert part.rows.tolist() == sorted(seen | set(np.flatnonzero(~lives.died).tolist()))
    monkeypatch.setattr(ground, "COLUMNS", 1)
    few = Ground(lives, CELLS, share)
    monkeypatch.setattr(ground, "SEEN", share * 3)
    alone = {occupants(lives, int(lives.born[place]))[0] for place in (0, 153, 307)}
    assert few.rows.tolist() == sorted(alone | set(np.flatnonzero(~lives.died)[:3].tolist()))


def test_organisms_that_a_page_leaves_out_count_as_ancestors_and_children() -> None:
    """The world's first birth on record is at tick 1,000, as in a fork."""
    lives = takeovers()
    cause = np.where(lives.died & (lives.id % 2 > 0), Cause.HAZARD, lives.cause).astype(np.int8)
    origin = np.where(lives.id % 3 > 1, BirthCause.COPY, lives.birth_cause).astype(np.int8)
    ticks = {name: getattr(lives, name) + 1000 for name in ("born", "seen", "ended")}
    lives = replace(lives, cause=cause, birth_cause=origin, id=lives.id + 50, **ticks)
    lives = replace(lives, parent=np.where(lives.parent < 0, -1, lives.parent + 50))
    rows = np.arange(5, len(lives), 4)
    shown: Any = organisms(lives, rows)
    facts = all_unpacked(shown)
    assert shown["first"] == 1000

    def above(row: int) -> list[int]:
        parent = int(lives.parent[row])
        return [] if parent < 0 else [parent - 50, *above(parent - 50)]

    for place, row in enumerate(rows.tolist()):
        got = {name: int(values[place]) for name, values in facts.items()}
        known = [list(rows).index(up) + 1 for up in above(row) if up in rows]
        why = int(lives.cause[row])
        assert got == {
            "number": row + 50,
            "born": int(lives.born[row]) - 1000,
            "lifespan": int(lives.ended[row] - lives.born[row]),
            "cell": int(lives.cell[row]),
            "origin": int(lives.birth_cause[row]),
            "cause": why + 1,
            "parent": int(lives.parent[row]) + 1,
            "ancestor": known[0] if known else 0,
            "generation": len(above(row)),
            "children": int((lives.parent == row + 50).sum()),
        }
        assert why < 0 or shown["causes"][why] == ("hazard" if row % 2 else "fatal")
    assert shown["origins"] == ["founder", "copy", "mutant"]


def test_the_palette_has_the_colours_of_the_figures_and_then_pale_ones() -> None:
    """The pale ones are the same colours with 70 % of white."""
    colours = palette()
    assert colours[:2] == [[0, 114, 178], [230, 159, 0]]
    assert colours[15:17] == [[178, 213, 232], [248, 226, 178]]
