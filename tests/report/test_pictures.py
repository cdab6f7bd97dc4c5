"""The pictures of a page hold what the records say, cell by cell and moment by moment."""

import base64
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.figures import spacetime
from primordia.history.ancestry import generations
from primordia.phylogeny.clades import clades_of
from primordia.report import film, ground
from primordia.report import tree as phylogeny
from primordia.report.ground import Ground
from primordia.report.organisms import nearest_among, organisms
from primordia.report.packed import packed
from primordia.report.tree import Nodes, grown, tree
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.pedigrees import lives_of
from tests.report.conftest import TORUS
from tests.report.unpacked import all_unpacked, unpacked
from tests.synthetic import occupants
from tests.worlds import config

PARENTS = st.lists(st.integers(-1, 30), min_size=1, max_size=40).map(
    lambda drawn: np.array([min(parent, row - 1) for row, parent in enumerate(drawn)])
)
"""The row of each organism's parent, or -1; parents come before their children."""


@pytest.mark.parametrize(
    ("values", "rising", "kind"),
    [
        ([0, 255], False, "uint8"),
        ([0, 256], False, "uint16"),
        ([65_535, 0], False, "uint16"),
        ([65_536], False, "uint32"),
        ([2**32 - 1], False, "uint32"),
        ([2**32], False, "float64"),
        ([2**32, 2**32 + 255, 2**32 + 256], True, "float64"),
        ([7, 262, 517], True, "uint8"),  # the differences are 7, 255 and 255
        ([], True, "uint8"),
    ],
)
def test_packed_arrays_have_the_shortest_type_and_no_time(
    values: list[int], rising: bool, kind: str
) -> None:
    """Bytes 4 to 7 of a gzip file are the time at which it was written (RFC 1952)."""
    made = packed(np.array(values, np.int64), rising)
    assert (made["type"], made["rising"]) == (kind, rising)
    assert base64.b64decode(made["data"])[4:8] == bytes(4)


@pytest.mark.parametrize("whole", [True, False])
def test_space_time_shows_who_was_where_after_each_moment(
    torus: Path, monkeypatch: pytest.MonkeyPatch, whole: bool
) -> None:
    lives = Archive(torus).lives.of_world(1)
    if not whole:
        monkeypatch.setattr(ground, "WHOLE", 10)
        monkeypatch.setattr(ground, "SEEN", 700)
    shown = Ground(lives, 24)
    data, facts = shown.data(), all_unpacked(organisms(lives, shown.rows))
    moments, segments = unpacked(data["moments"]), all_unpacked(data["segments"])
    assert data["whole"] == (len(moments) == len(lives)) == whole
    assert unpacked(data["ticks"]).tolist() == lives.born[moments].tolist()
    for place in moments.tolist():
        tick = int(lives.born[place])
        there = np.flatnonzero((segments["start"] <= place) & (place < segments["stop"]))
        seen = {int(segments["column"][i]): int(segments["organism"][i]) for i in there}
        assert len(seen) == len(there), "two organisms in a cell"
        numbers = {cell: int(lives.id[row]) for cell, row in occupants(lives, tick).items()}
        assert {cell: int(facts["number"][at]) for cell, at in seen.items()} == numbers


@given(PARENTS, st.data())
def test_ancestors_and_generations_are_those_of_a_walk(parents: np.ndarray, data: Any) -> None:
    some = np.array(sorted(data.draw(st.sets(st.integers(0, len(parents) - 1)))), np.int64)

    def above(row: int) -> list[int]:
        return [] if parents[row] < 0 else [int(parents[row]), *above(int(parents[row]))]

    assert generations(parents).tolist() == [len(above(row)) for row in range(len(parents))]
    expected = [next((up for up in above(row) if up in some), -1) for row in some.tolist()]
    assert [(-1 if at < 0 else int(some[at])) for at in nearest_among(parents, some)] == expected


@given(PARENTS, st.data())
def test_the_phylogeny_joins_lines_where_they_part(parents: np.ndarray, data: Any) -> None:
    leaves = sorted(data.draw(st.sets(st.integers(0, len(parents) - 1), min_size=1)))
    nodes = grown(parents, np.array(leaves))
    place_of = {row: place for place, row in enumerate(nodes.row.tolist())}
    roots = nodes.row[nodes.parent < 0].tolist()
    assert roots == sorted(roots), "in order of birth"

    def line(row: int) -> list[int]:
        return [row] if parents[row] < 0 else [row, *line(int(parents[row]))]

    def drawn(place: int) -> list[int]:
        return [] if place < 0 else [int(nodes.row[place]), *drawn(nodes.parent[place])]

    for leaf in leaves:
        walked = [row for row in line(leaf) if row in place_of]
        assert drawn(place_of[leaf]) == walked
        assert sum(nodes.skipped[place_of[row]] + 1 for row in walked) == len(line(leaf))
    lines = [line(leaf) for leaf in leaves]
    for row, place in place_of.items():
        ways = {each[each.index(row) - 1] for each in lines if row in each and each[0] != row}
        assert nodes.alive[place] == (row in leaves)
        assert nodes.alive[place] or len(ways) > 1 or parents[row] < 0, "each node is needed"
        assert nodes.left_by[nodes.parent == place].tolist() == sorted(ways, reverse=True)
    assert sorted(nodes.level[nodes.alive]) == list(range(len(leaves)))
    assert not_crossing(nodes)


def not_crossing(nodes: Nodes) -> bool:
    """Return whether no line that leaves a parent crosses the bar of another node."""
    level, left_by = nodes.level, nodes.left_by
    ends = np.where(nodes.alive, np.inf, np.append(left_by[1:], 0))
    for place, parent in enumerate(nodes.parent):
        low, high = sorted((level[place], level[parent]))
        between = (low < level) & (level < high) & (left_by < left_by[place])
        if parent >= 0 and (between & (left_by[place] < ends)).any():
            return False
    return True


def test_a_film_of_a_torus_shows_each_cell_with_the_ink_of_its_line_and_the_shade_of_its_age(
    torus: Path,
) -> None:
    """There are 8 shades: equal steps of the logarithm of 1 + age, up to the longest life."""
    run = Archive(torus)
    lives = run.lives.of_world(1)
    shown, clades, longest = Ground(lives, 24), clades_of(lives), int(lives.lifespan.max())
    made = film.film(shown, run.config)
    assert made is not None
    assert (made["rows"], made["columns"]) == (4, 6)
    pictures = unpacked(made["cells"]).reshape(-1, 24)
    for number, (place, tick, alive_, picture) in enumerate(
        zip(made["places"], made["ticks"], made["alive"], pictures, strict=True)
    ):
        assert tick == lives.born[place]
        there = occupants(lives, tick)
        assert np.flatnonzero(picture).tolist() == sorted(there)
        assert alive_ == len(there)
        for cell, row in there.items() if number % 9 == 0 else ():
            byte, age = int(picture[cell]), tick - int(lives.born[row])
            assert byte // 32 == min(int(8 * np.log1p(age) / np.log1p(longest)), 7)
            codes = spacetime.line_codes(lives, clades, np.array([[row]]), np.array([tick]))[0]
            assert byte % 32 - 1 == shown.inks(codes)[0]
    shades = pictures[pictures > 0] >> film.INK_BITS
    assert shades.min() == 0
    assert shades.max() == 7, "the largest number of three bits"


def test_a_ring_has_no_film(torus: Path) -> None:
    run = Archive(torus)
    ring = run.config.model_copy(update={"placement": type(run.config.placement)()})
    assert film.film(Ground(run.lives.of_world(0), 24), ring) is None


def tiny() -> Lives:
    """Return a world in which organisms 4, 5 and 6 live; 6 is the child of 5."""
    parents = [-1, 0, 0, 1, 3, 2, 5]
    lives = lives_of(
        parents, [0, 2, 2, 3, 5, 5, 7], [4, 4, 6, 6, 9, 9, 9], [True] * 4 + [False] * 3
    )
    cells = np.array([0, 1, 2, 0, 5, 1, 3], np.int32)
    return replace(lives, cell=cells, seen=lives.born + 1)


def test_the_nodes_of_a_phylogeny_have_their_organisms_and_times() -> None:
    """Each line begins at the first birth of its tick. Organisms 1 and 2 are born in one tick, so their
    lines begin together."""
    picture = Ground(tiny(), 6)
    made = tree(picture)
    assert made is not None
    assert (made["living"], made["shown"]) == (3, 3)
    names = "number", "born", "parent", "start", "stop", "level", "alive", "skipped"
    rows = [tuple(node[name] for name in names) for node in made["nodes"]]
    assert rows == [
        (0, 0, -1, 0, 1, 0, False, 0),
        (5, 5, 0, 1, 7, 0, True, 1),
        (6, 7, 1, 6, 7, 1, True, 0),
        (4, 5, 0, 1, 7, 2, True, 2),
    ]
    segments = all_unpacked(picture.data()["segments"])
    for node in made["nodes"][1:]:
        own = np.flatnonzero(segments["organism"] == node["number"])
        last = own[np.argmax(segments["stop"][own])]
        assert node["ink"] == segments["ink"][last], "the ink that the line has now"


def test_the_inks_of_a_phylogeny_are_those_of_the_lines_that_live_now() -> None:
    """At tick 3, organisms 0, 2 and 3 are one line. The other line ends at tick 5. Then each of the three
    begins a line."""
    lives = lives_of([-1, -1, 0, 0], [0, 0, 2, 3], [9, 5, 9, 9], [False, True, False, False])
    picture = Ground(replace(lives, cell=np.arange(4, dtype=np.int32), seen=lives.born), 4)
    made = tree(picture)
    assert made is not None
    codes = spacetime.line_codes(lives, picture.clades, np.array([[0], [2], [3]]), np.array([9]))
    inks = picture.inks(codes[:, 0]).tolist()
    assert len(set(inks)) == 3
    assert {node["number"]: node["ink"] for node in made["nodes"]} == dict(
        zip((0, 2, 3), inks, strict=True)
    )


@pytest.mark.parametrize(("most", "numbers"), [(3, [4, 5, 6]), (2, [4, 5]), (1, [5])])
def test_a_phylogeny_shows_a_limited_number_of_the_living_spread_over_the_cells(
    most: int, numbers: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The living are 5, 6 and 4 in the order of their cells."""
    monkeypatch.setattr(phylogeny, "LEAVES", most)
    made = tree(Ground(tiny(), 6))
    assert made is not None
    assert (made["living"], made["shown"]) == (3, len(numbers))
    alive_ = [node["number"] for node in made["nodes"] if node["alive"]]
    assert sorted(alive_) == numbers
    assert tree(Ground(tiny().take(np.arange(4)), 6)) is None, "nothing lives"


def test_shades_of_a_film_are_relative_to_the_longest_life_of_all_also_of_the_living() -> None:
    """In the last picture, of tick 7, two organisms are 2 ticks old, and one is newborn. The two are 25
    ticks old at tick 30."""
    lives = tiny()
    lives = replace(lives, ended=np.where(lives.died, lives.ended, 30))
    made = film.film(Ground(lives, 6), config(TORUS, cells=6))
    assert made is not None
    last = unpacked(made["cells"]).reshape(-1, 6)[-1]
    shade = int(8 * np.log1p(2) / np.log1p(25))
    assert [int(last[cell]) // 32 for cell in (1, 3, 5)] == [shade, 0, shade]


def test_the_share_of_the_page_limits_the_number_of_pictures_of_a_film(
    torus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Archive(torus)
    lives = run.lives.of_world(0)
    births = len(lives)

    def places(share: int = 1, some: Lives = lives) -> list[int]:
        made = film.film(Ground(some, 24, share), run.config)
        return [] if made is None else made["places"]

    assert places() == [int(each) for each in np.linspace(0, births - 1, min(births, 300))]
    monkeypatch.setattr(film, "PICTURES", 4)
    assert places() == [int(each) for each in np.linspace(0, births - 1, 4)]
    monkeypatch.setattr(film, "BYTES", 24 * 3 * 2)
    assert places(3) == [0, births - 1]
    assert places(2) == [0, (births - 1) // 2, births - 1]
    assert places(4) == [], "a film has two pictures or more"
    assert places(1, lives.take(np.arange(2))) == [0, 1]
    assert places(1, lives.take(np.arange(1))) == []
