"""Promise 2 when lists are full: whatever happens in one tick, no birth, death or sample is lost."""

import jax
import numpy as np
import pytest

from primordia.law import events as log
from primordia.law.events import Events, Rows
from tests.worlds import MEADOW, Lived, config

BUSY = {
    "brain": {"kind": "feed-forward", "hidden": 1},
    "genesis": "fill",
    "replication": 0.9,
    "hazard": 0.4,
    "sample_every": 1,
}
"""Worlds in which a great part of all organisms dies and is born in every tick."""
CLOCKWORK = {**BUSY, "replication": 0.0, "hazard": 1.0}
"""Worlds in which all organisms die and are born in every tick."""


def leave_least_room(lived: Lived) -> None:
    """Cut the lists to the least room with which a chunk can go on: that of one tick."""
    law, chunks = lived.engine.law, lived.engine.chunks
    cells = law.worlds * law.cells
    most = cells, cells, law.worlds
    lists = chunks.events if lived.config.habitat["name"].endswith("Meadow") else chunks._lists
    cut = Events(*(
        Rows(rows.rows[: least + log.batch(cells)], rows.filled)
        for rows, least in zip(log.emptied(lists), most, strict=True)
    ))  # fmt: skip
    assert log.have_room(law, cut)
    chunks.events = chunks._lists = cut


@pytest.mark.parametrize(
    ("habitat", "busy", "cells"),
    [("Meadow", BUSY, 300), ("Mirror", BUSY, 300), ("Meadow", CLOCKWORK, 24)],
)
def test_lists_with_the_least_room_lose_nothing(
    habitat: str, busy: dict[str, object], cells: int
) -> None:
    """Cells are written one at a time in small worlds, and in batches in large ones."""
    inner = {"inner": "meadow"} if habitat == "Mirror" else {}
    where = {"name": f"tests.toys:{habitat}", **inner}
    settings = config(MEADOW, habitat=where, **busy, cells=cells, seeds=2)
    roomy, tight = Lived(settings, 30), Lived(settings, 1)
    leave_least_room(tight)
    tight.advance_to(30)
    for name in ("births", "deaths", "metrics"):
        expected, actual = (np.concatenate(lived.rows[name]) for lived in (roomy, tight))
        np.testing.assert_array_equal(actual, expected, err_msg=name)
        assert len(actual) > 2 * max(map(len, tight.rows[name])), "lists were full many times"
    worlds = tight.engine.state.world.worlds
    assert len(np.concatenate(tight.rows["births"])) == int(worlds.births.lo.sum())
    assert len(np.concatenate(tight.rows["deaths"])) == int(worlds.deaths.lo.sum())
    assert tight.digests() == roomy.digests()


@pytest.mark.parametrize(("cells", "seeds"), [(2, 1), (7, 3), (300, 2), (2, 3000), (2**17, 1)])
def test_empty_lists_have_room_for_the_fullest_tick(cells: int, seeds: int) -> None:
    """A chunk that could not live one tick would never end."""
    made = config(MEADOW, cells=cells, seeds=seeds)
    law = made.build_law(made.build_habitat())
    shapes = jax.eval_shape(lambda: log.empty(law))
    lists = jax.tree.map(lambda each: np.broadcast_to(np.uint32(0), each.shape), shapes)
    assert log.have_room(law, Events(*(each._replace(filled=0) for each in lists)))
