"""The table of a phylogeny: the ALife data standard, PhyloFrame's `ancestor_id`, and further facts.

The standard is that of Lalejini et al. 2019, "Data Standards for Artificial Life Software", ALIFE 2019,
https://alife-data-standards.github.io/alife-data-standards/phylogeny.html.
"""

from collections.abc import Iterator

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from primordia.errors import Trouble
from primordia.law.world import BirthCause, Cause
from primordia.phylogeny.phylogeny import ISLAND, MATE, MIGRATIONS, Phylogeny
from primordia.runs.lives import ALIVE
from primordia.runs.schema import named

WORLD = 10**12
"""Number of ids of one world. An id is the world times this number, plus the birth number."""
ROOT = "[NONE]"
"""The `ancestor_list` of an organism without a parent."""
ROWS = 2**18
"""Rows of a batch."""


def table(whole: Phylogeny) -> pa.Table:
    """Return the phylogeny as an Arrow table; see `batches`."""
    return pa.Table.from_batches([*batches(whole), batch(whole.take(slice(0, 0)))])


def batches(whole: Phylogeny) -> Iterator[pa.RecordBatch]:
    """Yield the rows of the table, parents before children, some at a time.

    Raises:
        Trouble: a birth number is too large for an id.
    """
    if len(whole) and whole.lives.id.max() >= WORLD:
        raise Trouble(
            f"organism {whole.lives.id.max()}: the table can hold birth numbers below 10^12 only"
        )
    for first in range(0, len(whole), ROWS):
        yield batch(whole.take(slice(first, first + ROWS)))


def batch(some: Phylogeny) -> pa.RecordBatch:
    """Return rows of the table, in the order of the organisms."""
    lives = some.lives
    own, of_births = ids(lives.world, lives.id), dict(some.of_births)
    if (mate := of_births.pop(MATE, None)) is not None:
        mate = pc.add(mate, pa.array(ids(lives.world, 0)))  # null without a mate
    places = {name: of_births.pop(name) for name in (ISLAND, MIGRATIONS) if name in of_births}
    root = lives.parent < 0
    parent = np.where(root, own, ids(lives.world, lives.parent))
    alive = lives.cause == ALIVE
    columns = {
        "id": pa.array(own),
        "ancestor_list": _lists(parent, root, mate),
        "ancestor_id": pa.array(parent),
        "origin_time": pa.array(lives.born.astype(np.float64)),
        "destruction_time": pa.array(np.where(alive, np.inf, lives.ended)),
        "world": pa.array(lives.world),
        "cell": pa.array(lives.cell),
        "birth_cause": named(lives.birth_cause, BirthCause),
        "death_cause": named(lives.cause, Cause, alive),
        "lifespan": pa.array(lives.lifespan),
        **places,
    }
    for name, values in {
        **of_births,
        **some.of_deaths,
    }.items():  # a habitat or a mutation may have a name of ours
        columns[f"{name}_" if name in columns else name] = values
    return pa.RecordBatch.from_pydict(columns)


def ids(world: np.ndarray, number: np.ndarray | int) -> np.ndarray:
    """Return the ids of organisms by world and birth number, int64."""
    return world.astype(np.int64) * WORLD + number


def _lists(parent: np.ndarray, root: np.ndarray, mate: pa.Array | None) -> pa.Array:
    """Return lists of parents as text, such as `[12]` and `[12,7]`."""
    first = pa.array(parent).cast(pa.string())
    if mate is None:
        both = first
    else:
        two = pc.binary_join_element_wise(first, mate.cast(pa.string()), ",")
        both = pc.coalesce(two, first)
    return pc.if_else(pa.array(root), ROOT, pc.binary_join_element_wise("[", both, "]", ""))
