"""Promise 2 when lists are full: whatever happens in one tick, no birth, death or sample is lost."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.compiled import jit, shared
from primordia.law import events as log
from primordia.law.events import Events, Rows
from primordia.law.genesis import begin
from primordia.law.law import Law
from primordia.law.sample import note_samples
from tests.worlds import HERD, MEADOW, Lived, config, law_of

LISTS = Events._fields


@pytest.mark.parametrize("habitat", ["Meadow", pytest.param("Mirror", marks=pytest.mark.slow)])
def test_full_lists_lose_nothing(habitat: str) -> None:
    """Numbers of births have no gap, nothing dies twice, and each sample counts the births so far."""
    inner = {"inner": "meadow"} if habitat == "Mirror" else {}
    where = {**HERD["habitat"], "name": f"tests.toys:{habitat}", **inner}
    lived = Lived(config({**HERD, "habitat": where}), 1)
    lived.change({"replication": 0.9, "hazard": 0.4})
    lived.advance_to(8_000, chunk=10**6)
    assert len(lived.rows["births"]) > 3, "a chunk ended since lists were full, again and again"
    births, deaths, metrics = (lived.table(name) for name in ("births", "deaths", "metrics"))
    worlds = lived.engine.state.world.worlds
    alive = np.asarray(lived.engine.state.world.organisms.alive).reshape(3, -1)
    for world in range(3):
        born, died = (each["id"][each["world"] == world] for each in (births, deaths))
        assert sorted(born) == list(range(int(worlds.births.lo[world])))
        assert len(set(died)) == len(died) == int(worlds.deaths.lo[world].sum())
        assert alive[world].sum() == len(born) - len(died)
        sampled = metrics["world"] == world
        assert metrics["tick"][sampled].tolist() == list(range(10, 8_001, 10))
        ticks = births["tick"][births["world"] == world]
        expected = ticks.searchsorted(range(10, 8_001, 10), side="right")
        assert metrics["births"][sampled].tolist() == expected.tolist()


PAIRS = [(name, 8) for name in LISTS]
LARGE = [pytest.param(name, 701, marks=pytest.mark.slow) for name in LISTS]
"""`tests/law/test_events.py` has such batches."""


@pytest.mark.parametrize(
    ("which", "cells"),
    [*PAIRS, *LARGE],
)
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
        return jit(partial(note_samples, law))(world, jnp.ones(3, bool), full)

    def note(numbers: Array, valid: Array, carry: tuple[Rows]) -> tuple[Rows]:
        block = jnp.broadcast_to(numbers[:, None].astype(jnp.uint32), (len(numbers), width))
        return (log.append(carry[0], block, valid),)

    width = full.rows.shape[1]
    (after,) = jit(partial(log.for_each, act=note))(jnp.ones(most, bool), (full,))
    return Rows(after.rows, after.filled)


@pytest.mark.parametrize(("cells", "seeds"), [(2, 1), (7, 3), (300, 2), (2, 3000), (2**17, 1)])
def test_empty_lists_have_room_for_the_fullest_tick(cells: int, seeds: int) -> None:
    """A chunk that could not live one tick would never end."""
    law = law_of(MEADOW, cells=cells, seeds=seeds)
    shapes = jax.eval_shape(lambda: log.empty(law))
    lists = jax.tree.map(lambda each: np.broadcast_to(np.uint32(0), each.shape), shapes)
    assert log.have_room(law, Events(*(each._replace(filled=0) for each in lists)))
