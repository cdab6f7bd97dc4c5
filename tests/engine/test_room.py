"""Promise 2 when lists are full: whatever happens in one tick, no birth, death or sample is lost."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.compiled import shared
from primordia.config import Config
from primordia.engine.hosted import HostedChunks
from primordia.law import events as log
from primordia.law.events import Events, Rows
from primordia.law.genesis import begin
from primordia.law.law import Law
from primordia.law.sample import note_samples
from tests.worlds import MEADOW, Lived, config, law_of

BUSY = {
    "brain": {"kind": "feed-forward", "hidden": 1},
    "genesis": "fill",
    "replication": 0.9,
    "hazard": 0.4,
    "sample_every": 1,
}
"""Worlds in which a great part of all organisms dies and is born in every tick."""
LISTS = Events._fields


def least(law: Law, which: str) -> int:
    """Return the length of a list that has room for the fullest tick, and for no second one."""
    cells = law.worlds * law.cells
    return (law.worlds if which == "samples" else cells) + log.batch(cells)


def leave_least_room(lived: Lived, which: str) -> None:
    """Cut one of a chunk's lists; the others stay long."""
    chunks: Any = lived.engine.chunks
    name = "_lists" if isinstance(chunks, HostedChunks) else "events"
    lists = log.emptied(getattr(chunks, name))
    rows = getattr(lists, which)
    cut = rows._replace(rows=rows.rows[: least(lived.engine.law, which)])
    setattr(chunks, name, lists._replace(**{which: cut}))


def busy(habitat: str) -> Config:
    inner = {"inner": "meadow"} if habitat == "Mirror" else {}
    where = {"name": f"tests.toys:{habitat}", **inner}
    return config(MEADOW, habitat=where, **BUSY, cells=300, seeds=2)


@pytest.mark.parametrize(
    ("habitat", "which"),
    [("Meadow", "births"), pytest.param("Mirror", "deaths", marks=pytest.mark.slow)],
)
def test_lists_with_the_least_room_lose_nothing(habitat: str, which: str) -> None:
    whole, tight = Lived(busy(habitat), 30), Lived(busy(habitat), 1)
    leave_least_room(tight, which)
    tight.advance_to(30)
    for name in ("births", "deaths", "metrics"):
        expected, actual = (np.concatenate(lived.rows[name]) for lived in (whole, tight))
        np.testing.assert_array_equal(actual, expected, err_msg=name)
    rows = tight.rows["metrics" if which == "samples" else which]
    assert sum(map(len, rows)) > 2 * least(tight.engine.law, which), "it was full again and again"
    worlds = tight.engine.state.world.worlds
    assert len(np.concatenate(tight.rows["births"])) == int(worlds.births.lo.sum())
    assert len(np.concatenate(tight.rows["deaths"])) == int(worlds.deaths.lo.sum())
    assert tight.digests() == whole.digests()


@pytest.mark.parametrize("which", LISTS)
@pytest.mark.parametrize("cells", [8, 701])
def test_the_fullest_tick_fits_whenever_lists_have_room(which: str, cells: int) -> None:
    """Cells are written one at a time in small worlds, and in batches, the last padded, in large ones."""
    law = law_of(MEADOW, cells=cells, seeds=3)
    lists = log.empty(law)
    list_, most = getattr(lists, which), 3 if which == "samples" else 3 * cells
    length, room = len(list_.rows), shared(log.have_room, law)
    longest = max(
        filled
        for filled in range(length - most - 40, length + 1)
        if room(lists._replace(**{which: list_._replace(filled=np.int32(filled))}))
    )
    full = Rows(jnp.full_like(list_.rows, 7), jnp.int32(longest))
    after = noted(law, full, which, most)
    assert int(after.filled) == longest + most <= length
    assert (np.asarray(after.rows[:longest]) == 7).all()
    assert np.asarray(after.rows[longest : longest + most, 0]).tolist() == list(range(most))


def noted(law: Law, full: Rows, which: str, most: int) -> Rows:
    """Return a list with a row for every world, or for every cell."""
    if which == "samples":
        world = begin(law, np.arange(3, dtype=np.uint64))
        return note_samples(law, world, jnp.ones(3, bool), full)

    def note(numbers: Array, valid: Array, carry: tuple[Rows]) -> tuple[Rows]:
        block = jnp.broadcast_to(numbers[:, None].astype(jnp.uint32), (len(numbers), width))
        return (log.append(carry[0], block, valid),)

    width = full.rows.shape[1]
    (after,) = log.for_each(jnp.ones(most, bool), (full,), note)
    return Rows(after.rows, after.filled)


@pytest.mark.parametrize(("cells", "seeds"), [(2, 1), (7, 3), (300, 2), (2, 3000), (2**17, 1)])
def test_empty_lists_have_room_for_the_fullest_tick(cells: int, seeds: int) -> None:
    """A chunk that could not live one tick would never end."""
    law = law_of(MEADOW, cells=cells, seeds=seeds)
    shapes = jax.eval_shape(lambda: log.empty(law))
    lists = jax.tree.map(lambda each: np.broadcast_to(np.uint32(0), each.shape), shapes)
    assert log.have_room(law, Events(*(each._replace(filled=0) for each in lists)))
