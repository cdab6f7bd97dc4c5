"""The space-time figure: its colours, places and words, compared with each organism."""

from collections import Counter
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from primordia.figures import spacetime, style
from primordia.law.world import BirthCause
from primordia.phylogeny.clades import Clades, clades_of
from primordia.runs.lives import Lives
from tests.figures.reading import axes_of, key, labels, run_of
from tests.synthetic import occupants, one_world, world_of, worlds_of

CELLS, LAST = 8, 400


def a_history(seed: int) -> Lives:
    """Return one world of 8 cells in which organisms copy themselves into empty cells and die.

    All organisms die at tick 200. At the last tick all but one die.
    """
    draw = np.random.default_rng(seed)
    born: list[tuple[int, int, int]] = []  # tick, parent, cell
    ended: dict[int, int] = {}
    living: dict[int, int] = {}  # cell -> row
    for tick in range(LAST + 1):
        for cell in sorted(set(range(CELLS)) - set(living)):
            if draw.random() < (0.25 if living else 0.02):
                parent = int(draw.choice([*living.values()])) if living else -1
                living[cell] = len(born)
                born.append((tick, parent, cell))
        deaths = {200: list(living), LAST: list(living)[1:]}
        by_chance = [cell for cell in living if draw.random() < 0.08]
        for cell in deaths.get(tick, by_chance):
            ended[living.pop(cell)] = tick
    ticks, parents, cells = map(np.array, zip(*born, strict=True))
    ends = [ended.get(row, LAST) for row in range(len(born))]
    died = [row in ended for row in range(len(born))]
    cause = np.where(parents < 0, BirthCause.FOUNDER, BirthCause.COPY).astype(np.int8)
    return one_world(ticks, ends, died, parents, cell=cells.astype(np.int32), birth_cause=cause)


def expected_inks(
    lives: Lives, of: Clades, sizes: Counter[tuple[int, int]]
) -> dict[tuple[int, int], tuple[Any, bool]]:
    """Return the colour of each line of each era, and whether the line lasted to the era's end."""
    ends = [*of.renewals.tolist(), LAST + 1]
    lasted = {
        (era, int(of.lines_at(np.array(row), np.array(end - 1))))
        for era, end in enumerate(ends)
        for row in occupants(lives, min(end, LAST)).values()
    }
    hues = [np.array(to_rgb(hue)) for hue in spacetime.HUES]
    strong = [*hues, *(0.6 * hue for hue in hues)]
    inks: dict[tuple[int, int], tuple[Any, bool]] = {}
    for era, begun in enumerate([-1, *ends[:-1]]):
        mine = [which for which in sizes if which[0] == era]
        mine.sort(key=lambda which: (which not in lasted, -sizes[which], which))
        for turn, which in enumerate(mine):
            young = lives.born[which[1]] > begun
            colour = np.array([160 / 255] * 3) if young else strong[(turn + era - 1) % 14]
            inks[which] = (colour, which in lasted)
    return inks


@pytest.mark.parametrize("seed", [2, 11])
def test_the_colour_of_a_line_depends_on_its_size_its_age_and_its_end(seed: int) -> None:
    lives, ticks = a_history(seed), np.arange(0, LAST + 1, 2)
    of = clades_of(lives)
    image = spacetime.picture(lives, of, np.arange(CELLS), ticks)
    line_at: dict[tuple[int, int], tuple[int, int]] = {}
    for place, tick in enumerate(ticks.tolist()):
        era = sum(renewal <= tick for renewal in of.renewals.tolist())
        for cell, row in occupants(lives, tick).items():
            line_at[place, cell] = (era, int(of.lines_at(np.array(row), np.array(tick))))
    inks = expected_inks(lives, of, Counter(line_at.values()))
    expected = np.ones_like(image)
    for (place, cell), which in line_at.items():
        colour, lasted = inks[which]
        expected[place, cell] = colour if lasted else 0.7 + 0.3 * colour
    np.testing.assert_allclose(image, expected)


def drawn(lives: Lives, world: int = 0, **settings: Any) -> Axes:
    return axes_of(spacetime.draw, run_of(lives, **settings), world)[0]


def test_the_picture_goes_from_the_first_birth_to_the_last(monkeypatch: pytest.MonkeyPatch) -> None:
    """A picture with fewer pixels than births or cells has evenly spaced ones."""
    monkeypatch.setattr(spacetime, "ROWS", 5)
    monkeypatch.setattr(spacetime, "COLUMNS", 4)
    other = [(0, 5, True), (1, 9, False)]
    mine = [(tick * tick, 30, True) for tick in range(12)]
    axes = drawn(worlds_of(other, mine, other, until=200), 1, cells=CELLS, seeds=3)
    (image,) = axes.images
    lives = world_of(mine, until=200)
    births = lives.born[[0, 2, 5, 8, 11]]
    cells = np.array([0, 2, 4, 6])
    expected = spacetime.picture(lives, clades_of(lives), cells, births)
    np.testing.assert_array_equal(image.get_array(), expected)
    assert list(image.get_extent()) == [-0.5, 7.5, 12.5, 0.5]
    assert labels(axes) == (
        "Lines of descent, world 1 (of 3)",
        "cell of the ring; 4 of 8 shown",
        "organisms born so far",
    )
    assert key(axes) == {"strong: lines that lasted;  pale: died out;  white: empty": style.SOFT}
    alone = drawn(world_of(mine, until=200), cells=3)
    assert labels(alone)[:2] == ("Lines of descent", "cell of the ring")
    two = drawn(worlds_of(mine, other, until=200), cells=3, seeds=2)
    assert labels(two)[0] == "Lines of descent, world 0 (of 2)"


def test_round_ticks_stand_at_the_number_of_births_by_then() -> None:
    """Births in a round tick count. A mark stands more than a 25th of all births after the mark before.
    No mark stands after the last birth."""
    births = {
        0: 50, 10: 1, 20: 39, 50: 8, 51: 6, 100: 6, 150: 60, 500: 10, 999: 10, 1000: 9, 2000: 1
    }  # fmt: skip
    born = [tick for tick, count in births.items() for _ in range(count)]
    axes = drawn(world_of([(tick, 1, True) for tick in born], until=3000), cells=300)
    (right,) = axes.child_axes
    places = 51, 90, 110, 170, 180, 199
    assert [*right.yaxis.get_major_locator().tick_values(0, 1)] == [*places]
    written = [right.yaxis.get_major_formatter()(place, 0) for place in places]
    assert written == ["10", "20", "100", "200", "500", "1k"]
    assert right.get_ylabel() == "time (ticks)"
    halves = drawn(world_of([(0, 1, True)] * 50 + [(15, 1, True)] * 50, until=90), cells=300)
    assert [*halves.child_axes[0].yaxis.get_major_locator().tick_values(0, 1)] == [50]


def test_the_first_renewal_and_eight_takeovers_are_marked() -> None:
    """A mark stands before the births of its tick, since these have the colours of the new lines. Near
    the top the words of a mark are below its line."""
    lives = world_of([(tick, 2, True) for tick in range(210)], until=300)
    takeover = [False, *[True] * 3, False, *[True] * 6, False, True]
    renewals = np.array([3, 9, 10, *range(20, 120, 10)])
    axes = Figure().subplots()
    found: Any = SimpleNamespace(renewals=renewals, by_takeover=np.array(takeover))
    spacetime._mark_renewals(axes, lives, found)
    marked = [3, 9, 10, 20, 40, 50, 60, 70, 80]
    assert [line.get_ydata()[0] for line in axes.get_lines()] == [tick + 0.5 for tick in marked]
    notes = [each for each in axes.texts if isinstance(each, Annotation)]
    assert [each.xy for each in notes] == [(1, tick + 0.5) for tick in marked]
    first, *others = (each.get_text() for each in notes)
    assert first == "1 alive: each begins a line"
    assert others == ["one line has taken over"] * 8
    below = [each.get_verticalalignment() == "top" for each in notes]
    assert below == [True, True, *[False] * 7]
