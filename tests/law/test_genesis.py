"""Worlds at their beginning: counts, waits, words for bodies, and ages of organisms."""

from functools import partial

import jax
import numpy as np
import pytest

from primordia.law.genesis import birth_words, body_words
from primordia.law.world import World
from primordia.random.keys import Purpose, stream
from primordia.random.wide import to_host, wide
from tests.law.turning import drawn
from tests.worlds import MEADOW, begun, law_of

RATCHETS = [
    {"kind": "ratchet", "setting": "replication", "when": "food", "above": 0.1, "factor": 0.5,
     "every": every}
    for every in (7, 10, 1)
]  # fmt: skip


@pytest.mark.parametrize(("tick", "births"), [(30, 2**33), (2**33, 1)])
def test_worlds_begin_at_their_tick_and_wait_until_the_next_multiples(
    tick: int, births: int
) -> None:
    at = {"kind": "schedule", "setting": "hazard", "at": 50, "value": 0.5}
    seasons = [RATCHETS[0], at, *RATCHETS[1:]]
    law = law_of(MEADOW, cells=4, seeds=2, sample_every=15, seasons=seasons, hazard=0.125)
    organisms, worlds = begun(law, np.array([8, 2**63], np.uint64), tick, births)
    assert to_host(worlds.seed).tolist() == [8, 2**63]
    assert to_host(worlds.tick).tolist() == [tick] * 2
    assert to_host(worlds.births).tolist() == [births] * 2
    assert worlds.sample_wait.tolist() == [15 - tick % 15] * 2
    assert worlds.looks.wait.tolist() == [[7 - tick % 7, 10 - tick % 10, 1]] * 2
    assert worlds.climate["hazard"].tolist() == [0.125] * 2
    for name in ("saturated", "saturated_births", "fixed", "fixed_births"):
        assert to_host(getattr(worlds, name)).tolist() == [2**64 - 1] * 2, name
    for name in ("deaths", "extinctions", "organism_ticks", "food"):
        assert not to_host(getattr(worlds, name)).any(), name
    assert not organisms.alive.any()
    assert len(organisms.alive) == 8


def test_bodies_get_the_words_of_their_world_tick_of_birth_and_cell() -> None:
    """The high words of all draws are first, then the low words. The last low word is left out if odd."""
    law, words = law_of(MEADOW, cells=3, seeds=2), 3
    organisms, worlds = begun(law, np.array([8, 2**63], np.uint64), tick=70)
    born = [9, 2**40, 11, 12, 9, 9]
    world = World(organisms._replace(born=wide(born)), worlds)
    found = np.asarray(jax.jit(partial(birth_words, law, words=words))(world))
    assert found.shape == (6, words)
    assert found.dtype == np.uint32
    draws = -(-words // 2)
    for cell in range(6):
        seed = (8, 2**63)[cell // 3]
        pairs = [drawn(seed, Purpose.BODY, born[cell], cell % 3, draw) for draw in range(draws)]
        flat = [int(pair.hi) for pair in pairs] + [int(pair.lo) for pair in pairs]
        assert found[cell].tolist() == flat[:words]
    key = stream(wide([8, 2**63]), Purpose.BODY, wide([11, 12]))
    some = jax.jit(body_words, static_argnums=2)(key, np.array([2, 0]), words)
    np.testing.assert_array_equal(some, found[[2, 3]])
