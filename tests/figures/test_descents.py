"""Figures of lines of descent show what was measured, here invented values."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.text import Text

from primordia.figures import descent, style
from primordia.figures import lines as descents
from tests.assays.lives import COPY, FOUNDER, MUTANT
from tests.assays.lives import lives as lives_of
from tests.figures.reading import axes_of, edges_at, key, labels, lines, points

FOUNDED = 30
TICKS = FOUNDED + np.array([0, 1, 10, 100, 250])


def an_evolution(count: int = 65, **others: Any) -> Any:
    """Return invented measurements of the lines of world 3, as `WorldLines` names them."""
    draw = np.random.default_rng(8)
    lives = lives_of(*((-1, FOUNDER, 50) for _ in range(200)))
    found = {
        "world": 3,
        "lives": replace(lives, id=lives.id + 1000, born=lives.born + 5),
        "founders": draw.permutation(200)[:count],
        "ticks": TICKS,
        "shares": draw.random((len(TICKS), count)),
        "ranked": draw.permutation(count),
        "effective": np.array([[9.0, 8, 7, 6, 5], [8.0, 7, 6, 5, 4], [7.0, 6, 1, 3, 0]]),
        "drift": SimpleNamespace(
            largest=draw.random((40, len(TICKS))), effective=draw.uniform(0, 9, (40, len(TICKS)))
        ),
        "diversity": np.array([900, 700, 800, 300, 100]),
        "sweeps": [SimpleNamespace(born=25, fixed=tick) for tick in (None, 29, FOUNDED, 31, 140)],
        "pairs": SimpleNamespace(back=np.array([4, 20]), share=np.array([0.25, 0.5])),
        "neutral_pairs": SimpleNamespace(back=np.array([9, 30]), share=np.array([0.5, 0.75])),
    }
    return SimpleNamespace(**{**found, **others})


TIME = np.array([1, 1, 10, 100, 250])
"""Time since the lines were founded; the first instant is drawn at 1."""
REMARK = "no two of the living have a common ancestor on record"
SINCE = "time since lines were founded (ticks)"


@pytest.fixture(scope="module")
def found() -> Any:
    return an_evolution()


@pytest.fixture(scope="module")
def all_axes(found: Any) -> list[Axes]:
    return axes_of(descents.draw, found)


def check_band(axes: Axes, values: np.ndarray) -> None:
    """Check that 95 % of the shadows (S, T) lie in the band."""
    low, high = np.percentile(values, 2.5, axis=0), np.percentile(values, 97.5, axis=0)
    for place in (2, 3, 4):
        edges = edges_at(axes.collections[0], TIME[place])
        np.testing.assert_allclose(edges, (max(low[place], 0), high[place]))


def test_the_shares_of_the_largest_lines_are_drawn_in_order(
    found: Any, all_axes: list[Axes]
) -> None:
    """Of 65 lines 7 have colours, 53 are faint, and 5 are not drawn. The largest is in front."""
    axes = all_axes[0]
    coloured = [each for each in axes.get_lines() if each.get_color() in style.PALETTE]
    assert [each.get_color() for each in coloured] == [*style.PALETTE][::-1]
    for each, place in zip(coloured, found.ranked[:7][::-1], strict=True):
        np.testing.assert_array_equal(each.get_data(), (TIME, found.shares[:, place]))
    faint = [y for _, y in lines(axes, style.SOFT)]
    np.testing.assert_array_equal(faint, found.shares[:, found.ranked[7:60]].T)
    check_band(axes, found.drift.largest)
    names = [f"line of {1000 + found.founders[place]}" for place in found.ranked[:4]]
    assert key(axes) == {
        **dict(zip(names, style.PALETTE, strict=False)),
        "95 % of neutral shadows: largest line": style.SOFT,
    }
    assert labels(axes) == ("65 lines of world 3", SINCE, "share of the living")
    assert axes.get_xlim() == (1, 250)


def test_a_world_with_few_lines_and_without_pairs_is_drawn() -> None:
    none = SimpleNamespace(back=np.zeros(0, int), share=np.zeros(0))
    lost = SimpleNamespace(largest=np.ones((9, 5)), effective=np.array([[2, 2, 2, 1, 0.0]] * 9))
    found = an_evolution(2, sweeps=[], pairs=none, drift=lost)
    axes, effective, diversity, pairs = axes_of(descents.draw, found)
    for colour, place in zip(style.PALETTE, found.ranked, strict=False):
        ((_, share),) = lines(axes, colour)
        np.testing.assert_array_equal(share, found.shares[:, place])
    assert len(key(axes)) == 3
    band = [edges_at(effective.collections[0], at) for at in (10, 100, 250)]
    assert band == [(2, 2), (1, 1), (1, 1)], "no line is left in the last tick"
    assert key(diversity) == {}
    assert REMARK in {each.get_text() for each in pairs.findobj(Text)}
    assert points(pairs, style.BLUE) == [(0, 0)]


def test_the_effective_number_of_lines_is_of_order_two_and_ends_with_the_last_line(
    found: Any, all_axes: list[Axes]
) -> None:
    """At the last tick no line is left, and no point is drawn."""
    axes = all_axes[1]
    assert points(axes, style.BLUE) == [(1, 7), (1, 6), (10, 1), (100, 3)]
    check_band(axes, np.maximum(found.drift.effective, 1))
    assert labels(axes) == ("Effective number of lines", SINCE, "lines")
    assert key(axes) == {"recorded": style.BLUE, "95 % of neutral shadows": style.SOFT}


def test_diversity_is_drawn_with_the_ancestors_that_became_common_since(
    all_axes: list[Axes],
) -> None:
    axes = all_axes[2]
    assert points(axes, style.BLUE) == [*zip(TIME, (900, 700, 800, 300, 100), strict=True)]
    assert [x for x, _ in points(axes, style.ORANGE)] == [1, 1, 110, 110]
    title = "Phylogenetic diversity of the living"
    assert labels(axes) == (title, SINCE, "total length of branches (ticks)")
    assert key(axes) == {"a new common ancestor": style.ORANGE}
    assert axes.get_ylim()[0] == 0


def test_pairs_are_drawn_back_to_the_first_birth_on_record(all_axes: list[Axes]) -> None:
    axes = all_axes[3]
    assert points(axes, style.BLUE) == [(0, 0), (4, 0.25), (20, 0.5)]
    assert points(axes, style.SOFT) == [(0, 0), (9, 0.5), (30, 0.75)]
    assert {each.get_drawstyle() for each in axes.get_lines()} == {"steps-post"}
    assert axes.get_xlim() == (0, 280 - 5)
    title, across, up = labels(axes)
    assert title == "Coalescence of pairs of the living"
    assert (across, up) == ("ticks back to the common ancestor of a pair", "share of pairs")
    assert key(axes) == {"recorded": style.BLUE, "expected from drift": style.SOFT}
    assert REMARK not in {each.get_text() for each in axes.findobj(Text)}


def some_ancestors(count: int, blocks: int = 2, **others: Any) -> Any:
    """Return an invented line of ancestors, as `Ancestors` names them; the last two are alive."""
    rows: list = [(-1, FOUNDER, 30), *((n, COPY, 10 * n) for n in range(count - 3))]
    rows += [(0, MUTANT, 8, "alive"), (0, MUTANT, 0, "alive")]
    line = lives_of(*rows)
    born = line.born * 2 + 3
    ticks = np.array([2, 3, 4, 11, 40])
    found = {
        "organism": 77,
        "world": 2,
        "line": replace(line, id=line.id * 7 + 1, born=born, ended=born + line.lifespan),
        "blocks": [f"block {k}" for k in range(blocks)],
        "changes": np.random.default_rng(2).random((count, blocks)),
        "census": SimpleNamespace(ticks=ticks),
        "shares": lambda places: np.add.outer(ticks / 100, places / 1000),
    }
    return SimpleNamespace(**{**found, **others})


def test_ancestors_are_drawn_at_their_births() -> None:
    lives, changes, _ = axes_of(
        descent.draw, some_ancestors(6, changes=np.arange(12.0).reshape(6, 2))
    )
    assert points(lives, style.BLUE) == [(3, 30), (5, 1), (7, 10), (9, 20)]
    assert points(lives, style.ORANGE) == [(11, 8), (13, 1)]
    assert labels(lives) == ("The ancestors of organism 77 of world 2", "", "ticks lived")
    assert key(lives) == {"dead": style.BLUE, "alive": style.ORANGE}
    births = [3, 5, 7, 9, 11, 13]
    for block, colour in enumerate((style.BLUE, style.ORANGE)):
        assert points(changes, colour) == [(x, 2 * k + block) for k, x in enumerate(births)]
    assert labels(changes)[0] == "Size of mutations, by block of weights"
    assert labels(changes)[2] == "L2 norm of the change"
    assert key(changes) == {"block 0": style.BLUE, "block 1": style.ORANGE}
    assert changes.get_ylim()[0] == 0


def test_up_to_six_blocks_are_named_and_colours_begin_again() -> None:
    for blocks, named in ((6, 6), (7, 0), (9, 0)):
        changes = axes_of(descent.draw, some_ancestors(5, blocks))[1]
        colours = [each.get_color() for each in changes.get_lines()]
        assert colours == [*style.PALETTE, *style.PALETTE][:blocks]
        assert len(key(changes)) == named


def test_sizes_of_mutations_are_drawn_if_any_is_known() -> None:
    unknown = np.full((5, 2), np.nan)
    some = unknown.copy()
    some[2, 0] = 3
    for changes, drawn in ((None, 0), (unknown, 0), (some, 2)):
        axes = axes_of(descent.draw, some_ancestors(5, changes=changes))[1]
        texts = {each.get_text() for each in axes.findobj(Text)}
        assert (len(axes.get_lines()), "mutations are unknown" in texts) == (drawn, not drawn)


@pytest.mark.parametrize("count", [5, 20])
def test_the_shares_of_some_ancestors_are_drawn_from_their_births(count: int) -> None:
    """A short line is drawn whole. A long line is drawn by 7 evenly spaced ancestors, with both ends."""
    found = some_ancestors(count)
    shares = axes_of(descent.draw, found)[2]
    places = [0, 1, 2, 3, 4] if count == 5 else [0, 3, 6, 9, 12, 15, 19]
    for place, colour in zip(places, style.PALETTE, strict=False):
        after = [tick for tick in (2, 3, 4, 11, 40) if tick >= 2 * place + 3]
        expected = [(tick, pytest.approx(tick / 100 + place / 1000)) for tick in after]
        assert points(shares, colour) == expected
    names = [str(place * 7 + 1) for place in places]
    assert key(shares) == dict(zip(names, style.PALETTE, strict=False))
    title = "Descendants of some ancestors, the oldest first"
    assert labels(shares) == (title, "time (ticks)", "share of the living")
    assert shares.get_xlim()[0] == 2
    assert shares.get_ylim() == (0, 1.02)
