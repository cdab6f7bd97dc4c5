"""Promise 1: a life is a function of genome, seed and organism, in whatever way it is computed.

`test_strange` tests it with worlds that have everything. Here are many worlds and many bodies.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.brains.contract import find
from primordia.compiled import jit
from primordia.habitats.cartpole.habitat import CartPole
from tests.toys import Mill
from tests.worlds import Lived, config

CARTPOLE = {"seed": 5, "cells": 32}


@pytest.mark.slow
def test_a_world_is_the_same_alone_and_among_a_hundred() -> None:
    among, alone = Lived(config(cells=32, seed=0, seeds=100), 600), Lived(config(**CARTPOLE), 600)
    assert among.digests()[5] == alone.digests()[0]
    assert len(set(among.digests())) == 100


@pytest.mark.slow
def test_a_numpy_habitat_is_exact_in_chunks_of_any_length() -> None:
    host = {"name": "tests.toys:HostCartPole"}
    values = {"task": "host", "habitat": host, "cells": 8}
    whole = Lived(config(values), 400)
    assert len(np.concatenate(whole.rows["births"])) > 10
    assert Lived(config(values), 400, chunk=9).digests() == whole.digests()


@pytest.mark.parametrize(
    ("habitat", "kind"),
    [
        (CartPole(), "recurrent"),
        pytest.param(Mill(), "feed-forward", marks=pytest.mark.slow),
        (Mill(), "gated"),
    ],
)
def test_brains_and_bodies_do_not_depend_on_their_number(kind: str, habitat) -> None:
    """One pole balancer is enough: `matvec` is the same for all brains."""
    brain, sizes = find(kind)(), (habitat.senses_size, habitat.action.size)
    rng, layout = np.random.default_rng(0), brain.layout(*sizes)
    genome = layout.split(rng.normal(size=(1024, layout.length)).astype(np.float32))
    words = rng.integers(0, 2**32, (1024, habitat.words), dtype=np.uint32)

    @jit
    def lives(genome: dict, words: np.ndarray) -> tuple:
        def tick(carry: tuple, _: None) -> tuple:
            memory, bodies = carry
            memory, output = brain(genome, memory, habitat.sense(bodies))
            right = (output[:, 1] > output[:, 0]).astype(jnp.int32)
            action = right if isinstance(habitat, CartPole) else output
            bodies, _ = habitat.step(bodies, action)
            return (memory, bodies), None

        start = jnp.zeros((len(words), brain.memory(*sizes))), habitat.reset(words)
        return jax.lax.scan(tick, start, None, length=50)[0]

    memory, bodies = lives(genome, words)
    for n in (1, 31) if kind == "recurrent" else (31,):
        few_memory, few_bodies = lives({k: v[:n] for k, v in genome.items()}, words[:n])
        np.testing.assert_array_equal(few_memory, memory[:n])
        np.testing.assert_array_equal(few_bodies, bodies[:n])
