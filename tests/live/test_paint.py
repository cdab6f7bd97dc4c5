"""Heights, lights and colours of drawn cells."""

import colorsys

import numpy as np
import pytest

from primordia.live.paint import (
    EMPTY,
    Cells,
    colour,
    field,
    levels,
    mosaic,
    photograph,
    shades,
    skyline,
)
from tests.live.drawn import colours, text

BARS = " ▁▂▃▄▅▆▇█"
AGES = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])


def test_age_is_on_a_logarithmic_scale_up_to_the_full_age() -> None:
    """log(10) is half of log(100), and log(1) is 0."""
    cells = Cells.of(np.zeros(6, np.int64), np.array([-3, 0, 9, 99, 100, 10**12]), full=99)
    np.testing.assert_allclose(cells.age, [0, 0, 0.5, 1, 1, 1])


def aged(line: list[int], ticks: list[int]) -> Cells:
    """Return cells of some lines and ages; 1,000 ticks is the full age."""
    return Cells.of(np.array(line), np.array(ticks), full=1000)


@pytest.mark.parametrize(("tall", "most"), [(1, 7), (3, 24)])
def test_a_bar_grows_in_equal_steps_from_one_eighth_to_all_of_its_rows(
    tall: int, most: int
) -> None:
    """A single row ends one eighth below the row above. Dots are empty cells."""
    heights = [1 + round(age * (most - 1)) for age in AGES]
    expected = [
        [BARS[min(max(height - 8 * below, 0), 8)] for height in heights]
        for below in reversed(range(tall))
    ]
    for below, row in zip(reversed(range(tall)), expected, strict=True):
        row.append(" " if below else "·")
    cells = Cells(np.array([0] * 6 + [EMPTY]), np.append(AGES, 1.0))
    assert text(skyline(cells, wide=1, tall=tall)) == ["".join(row) for row in expected]
    for bar in (1, 2):
        wide = ["".join(bar * glyph + " " for glyph in row) for row in expected]
        assert text(skyline(cells, wide=bar + 1, tall=tall)) == wide


def test_each_line_has_its_own_colour() -> None:
    cells = Cells(np.array([0, 0, 1, 64]), np.ones(4))
    ((first, second, third),) = skyline(cells, wide=1, tall=1)
    assert (first.text, second.text, third.text) == ("▇▇", "▇", "▇"), "a segment for each style"
    assert first.style == third.style != second.style


def test_light_grows_with_each_quarter_of_the_age() -> None:
    ages = np.array([0, 0.249, 0.25, 0.5, 0.749, 0.75, 1.0, 1.0])
    line = np.array([3, 3, 3, 3, 3, 3, 67, EMPTY])
    assert shades(Cells(line, ages)).tolist() == [12, 12, 13, 14, 14, 15, 15, -1]


def test_neighbouring_hues_are_a_golden_section_apart_and_differ_in_lightness() -> None:
    for hue in range(64):
        angle, light, _ = colorsys.rgb_to_hls(*(part / 255 for part in colour(hue)))
        around = (angle - hue * (5**0.5 - 1) / 2) % 1
        assert min(around, 1 - around) < 0.01
        assert light == pytest.approx(0.6 if hue % 2 else 0.7, abs=0.01)


def test_a_character_of_a_mosaic_has_two_cells_each_as_light_as_its_age() -> None:
    """The shade is 4 x hue + light; the lights are 40, 60, 80 and 100 % of the colour."""
    (first, second), (third, last) = mosaic(np.array([[20, 21], [22, 23], [EMPTY, 20]]))
    full = np.array(colour(5))
    for segment, lights in ((first, (0.4, 0.8)), (second, (0.6, 1.0))):
        np.testing.assert_allclose(colours(segment), np.outer(lights, full), atol=1)
    assert colours(third) == ((45, 45, 45), None), "nothing is below an odd number of rows"
    assert colours(last)[1] is None


def test_a_cell_of_two_columns_has_one_row_and_a_cell_of_four_has_two() -> None:
    cells = Cells(np.array([1, 2, 3, 4]), np.zeros(4))
    for scale, high in ((1, 1), (2, 2), (4, 4)):
        assert text(field(cells, columns=2, scale=scale)) == ["▀" * 2 * scale] * high
    (upper, _), (lower, _) = field(cells, columns=2, scale=2)
    for segment, line in ((upper, 1), (lower, 3)):
        one, other = colours(segment)
        assert one == other, "both halves belong to one cell"
        np.testing.assert_allclose(one, 0.4 * np.array(colour(line)), atol=1)


def test_a_picture_keeps_its_colours_to_four_bits() -> None:
    """Two points, one above the other, are a character."""
    pixels = np.array(
        [[[255, 15, 16], [1, 2, 3]], [[0, 255, 0], [255, 0, 0]], [[16, 31, 255], [0, 0, 0]]],
        np.uint8,
    )
    drawn = [[colours(each) for each in row] for row in photograph(pixels)]
    assert drawn == [
        [((255, 0, 17), (0, 255, 0)), ((0, 0, 0), (255, 0, 0))],
        [((17, 17, 255), None), ((0, 0, 0), None)],
    ]


def test_levels_go_in_eight_equal_steps_from_minus_one_to_one() -> None:
    steps = [-1 + 2 * step / 7 for step in range(8)]
    assert levels(np.array(steps)) == "▁▂▃▄▅▆▇█"
    assert levels(np.array([-9.0, 9.0, -np.inf, np.inf])) == "▁█▁█"
    assert levels(np.array([np.nan])) == levels(np.array([0.0])), "an undefined value is drawn as 0"
