"""A simulation that fails is a fault, however it fails, in habitats in JAX and on the host."""

from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.habitats import Outcome
from primordia.habitats.on_host import OnHost
from tests.toys import Meadow
from tests.worlds import MEADOW, Lived, config

AGE = 7
HUNGRY = {"store": 100.0, "effort_cost": 1.0}


class Failing(Meadow):
    """A meadow whose bodies fail at an age, each in one of four ways."""

    def reset(self, words: Array) -> Array:
        way = (words[:, 0] % np.uint32(4)).astype(jnp.float32)
        return jnp.stack([jnp.zeros_like(way), way], axis=1)

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        _, outcome = super().step(bodies, action)
        clock, way = bodies[:, 0] + 1, bodies[:, 1]
        failed = clock >= AGE
        outcome = outcome._replace(
            fault=failed & (way == 0),
            food=jnp.where(failed & (way == 1), -jnp.inf, 0.0),
            effort=jnp.where(failed & (way == 2), jnp.nan, 0.0),
        )
        clock = jnp.where(failed & (way == 3), jnp.inf, clock)
        return jnp.stack([clock, way], axis=1), outcome


class FailingOnHost(OnHost):
    """The same habitat on the host."""

    def __init__(self, **options: Any) -> None:
        super().__init__(Failing(**options))


@pytest.mark.parametrize("kind", [Failing, FailingOnHost])
def test_all_die_of_the_fault_in_the_tick_in_which_it_happens(kind: type) -> None:
    """The fault is the cause of death even if the body dies in that tick for another reason."""
    habitat = {"name": f"{__name__}:{kind.__name__}", "lifespan": AGE}
    still = {"replication": 0.0, "genesis": "fill", "metabolism": HUNGRY, "brain": {"hidden": 1}}
    lived = Lived(config(MEADOW, habitat=habitat, **still), 3 * AGE)
    deaths = lived.table("deaths")
    assert set(deaths["cause"]) == {"fault"}
    np.testing.assert_array_equal(np.unique(deaths["tick"]), [AGE, 2 * AGE, 3 * AGE])
    assert len(deaths["tick"]) == 3 * 16
    assert not deaths["food"].any(), "food that is not finite was not eaten"
    assert not lived.table("metrics")["food"].any()
