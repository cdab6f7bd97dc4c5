"""Facts of the organisms in a picture: births, lives, parents, and nearest ancestors."""

from typing import Any

import numpy as np

from primordia.history.ancestry import children, generations, nearest, places_of
from primordia.law.world import BirthCause, Cause
from primordia.report.packed import packed
from primordia.runs.lives import Lives

CAUSES = [cause.label for cause in Cause]
BIRTHS = [cause.label for cause in BirthCause]


def organisms(lives: Lives, rows: np.ndarray) -> dict[str, Any]:
    """Return the facts of some organisms of one world, for `organisms.js`.

    Args:
        lives: the lives of the world.
        rows: rows of the organisms, int64 (R,), ascending.

    Returns:
        Packed arrays (R,). `parent`: the parent's birth number plus 1; 0 if none. `ancestor`: 1 +
        the place, among these organisms, of the nearest ancestor; 0 if none. `cause`: cause of
        death plus 1; 0 if alive. `born`: ticks from the first birth on record; add `first` to get
        the tick.
    """
    some = lives.take(rows)
    first = int(lives.born[0])
    return {
        "first": first,
        "number": packed(some.id, rising=True),
        "born": packed(some.born - first, rising=True),
        "lifespan": packed(some.lifespan),
        "cell": packed(some.cell),
        "origin": packed(some.birth_cause),
        "cause": packed(some.cause.astype(np.int64) + 1),
        "parent": packed(some.parent + 1),
        "ancestor": packed(nearest_among(lives.parent_row, rows) + 1),
        "generation": packed(generations(lives.parent_row)[rows]),
        "children": packed(children(lives.parent_row)[rows]),
        "causes": CAUSES,
        "origins": BIRTHS,
    }


def nearest_among(parent_row: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return where in `rows` each of these organisms has its nearest ancestor, int64 (R,); -1 if nowhere.

    Args:
        parent_row: row of each organism's parent, or -1; int64 (L,).
        rows: some organisms, int64 (R,), ascending.
    """
    known = np.append(nearest(parent_row, rows), -1)  # the last entry is for a missing parent, -1
    return places_of(rows, known[parent_row[rows]])
