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
    """A meadow whose simulation fails at an age, and says so in one way."""

    how: str = "fault"

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        bodies, outcome = super().step(bodies, action)
        failed = bodies[:, 0] >= AGE
        if self.how == "body":
            return jnp.where(failed[:, None], jnp.inf, bodies), outcome
        values = {"fault": failed, "food": jnp.where(failed, -jnp.inf, 0.0),
                  "effort": jnp.where(failed, jnp.nan, 0.0)}  # fmt: skip
        return bodies, outcome._replace(**{self.how: values[self.how]})


class FailingOnHost(OnHost):
    """The same habitat on the host."""

    def __init__(self, **options: Any) -> None:
        super().__init__(Failing(**options))


@pytest.mark.parametrize("kind", [Failing, FailingOnHost])
@pytest.mark.parametrize("how", ["fault", "body", "food", "effort"])
def test_all_die_of_the_fault_in_the_tick_in_which_it_happens(kind: type, how: str) -> None:
    """The fault is the cause of death even if the body dies in that tick for another reason."""
    habitat = {"name": f"{__name__}:{kind.__name__}", "how": how, "lifespan": AGE}
    still = {"replication": 0.0, "genesis": "fill", "metabolism": HUNGRY, "brain": {"hidden": 1}}
    lived = Lived(config(MEADOW, habitat=habitat, **still), 3 * AGE)
    deaths = lived.table("deaths")
    assert set(deaths["cause"]) == {"fault"}
    np.testing.assert_array_equal(np.unique(deaths["tick"]), [AGE, 2 * AGE, 3 * AGE])
    assert len(deaths["tick"]) == 3 * 16
    assert not deaths["food"].any(), "food that is not finite was not eaten"
    assert not lived.table("metrics")["food"].any()
