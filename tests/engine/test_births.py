"""Bodies of JAX habitats are made for the newborn only."""

from functools import partial
from typing import ClassVar

import jax
import numpy as np
from jax import Array

from primordia.compiled import jit
from primordia.engine.engine import Engine
from primordia.engine.fused import advance
from primordia.habitats.bodies import MADE
from primordia.law.events import batch
from primordia.settings.tracing import COUNT
from tests.toys import Meadow, Slope
from tests.worlds import MEADOW, config


class Costly(Meadow):
    """A habitat that records how many bodies are made at once."""

    asked: ClassVar[set[int]] = set()

    def reset(self, words: Array) -> Array:
        self.asked.add(len(words))
        return super().reset(words)


def test_bodies_are_never_made_for_all_cells() -> None:
    """Bodies are made in batches; a few are made for all empty cells and for a check. Nothing lives."""
    cells = 1024
    costly = {"name": f"{__name__}:Costly"}
    engine = Engine(config(MEADOW, habitat=costly, cells=cells, genesis="fill"))
    chunk = partial(advance, engine.law, engine.habitat)
    jax.eval_shape(chunk, engine.state, engine.events, engine.limits({"ticks": 5}), np.int32(5))
    assert Costly.asked == {MADE, batch(cells), COUNT}
    assert batch(cells) < 10


def test_a_body_does_not_depend_on_the_number_of_births_in_its_tick() -> None:
    """A reset of many bodies at once would be rounded in another way; births do not depend on it."""
    words = np.random.default_rng(3).integers(0, 2**32, (64, 2), np.uint32)
    born = jit(Slope().reset)
    together = np.asarray(born(words))
    for count in (1, 3):
        some = [np.asarray(born(words[i : i + count])) for i in range(0, 48, count)]
        np.testing.assert_array_equal(np.concatenate(some), together[:48])
