"""What the submarine of `experiments/skill/seaquest.py` perceives."""

import jax.numpy as jnp
import numpy as np
import pytest

BELOW_RIGHT = [2, 2, 6]
"""Row and column around the submarine, and the channel of divers."""


@pytest.mark.parametrize(("row", "column"), [(0, 0), (5, 4), (8, 9)])
def test_a_submarine_perceives_the_cells_around_it_and_both_gauges(row: int, column: int) -> None:
    """A diver is below to the right, or outside the grid; six cells of oxygen, and one diver on board."""
    from experiments.skill.seaquest import Seaquest  # only here: Pgx takes half a second

    inside = column < 9
    grid = np.zeros((10, 10, 10), bool)
    grid[row, column, 0] = grid[9, 8, 8] = True
    grid[9, :6, 7] = True
    if inside:
        grid[row + 1, column + 1, 9] = True
    senses = np.asarray(Seaquest()._senses(jnp.asarray(grid)))
    around, oxygen, divers = np.split(senses, [72, 82])
    near = around.reshape(3, 3, 8)
    assert np.argwhere(near[..., :7]).tolist() == ([BELOW_RIGHT] if inside else [])
    rows, columns = np.mgrid[row - 1 : row + 2, column - 1 : column + 2]
    outside = (rows < 0) | (rows > 9) | (columns < 0) | (columns > 9)
    np.testing.assert_array_equal(near[..., 7], outside)
    assert oxygen.tolist() == [1] * 6 + [0] * 4
    assert divers.tolist() == [0] * 5 + [1]
