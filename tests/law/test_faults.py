"""Lives end for the gravest reason that a habitat, or the law, gives; however a simulation fails."""

from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.habitats import Outcome
from primordia.habitats.on_host import OnHost
from primordia.random.keys import Purpose
from tests.law.turning import drawn
from tests.toys import Meadow
from tests.worlds import MEADOW, Lived, config

AGE = 7
WAYS = ["fault"] * 4 + ["fatal", "time-limit"]


class Ending(Meadow):
    """A meadow in which the time of all bodies is up at an age: four ways to fail, to die, or no more."""

    def reset(self, words: Array) -> Array:
        way = (words[:, 0] % np.uint32(len(WAYS))).astype(jnp.float32)
        return jnp.stack([jnp.zeros_like(way), way], axis=1)

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        clock, way = bodies[:, 0] + 1, bodies[:, 1]
        ended = clock >= AGE
        outcome = Outcome(
            fatal=ended & (way != 5),
            fault=ended & (way == 0),
            food=jnp.where(ended & (way == 1), -jnp.inf, 0.0),
            effort=jnp.where(ended & (way == 2), jnp.nan, 0.0),
            expired=ended,
        )
        clock = jnp.where(ended & (way == 3), jnp.inf, clock)
        return jnp.stack([clock, way], axis=1), outcome


class EndingOnHost(OnHost):
    """The same habitat on the host."""

    def __init__(self, **options: Any) -> None:
        super().__init__(Ending(**options))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["Ending", "EndingOnHost"])
def test_the_gravest_reason_to_die_is_the_cause(kind: str) -> None:
    """The last organisms have a store that is empty in the tick of the limit; hunger comes first."""
    still = {
        "replication": 0.0,
        "genesis": "fill",
        "metabolism": {"store": 100.0, "effort_cost": 1},
    }
    habitat = {"name": f"{__name__}:{kind}"}
    lived = Lived(config(MEADOW, habitat=habitat, **still, cells=64, brain={"hidden": 1}), AGE)
    lived.change({"metabolism.store": AGE})
    lived.advance_to(3 * AGE)
    deaths, seed = lived.table("deaths"), lived.config.world_seeds[0]
    assert deaths["tick"].tolist() == np.repeat([AGE, 2 * AGE, 3 * AGE], 64).tolist()
    for generation, last in enumerate(["time-limit", "time-limit", "starved"]):
        ways = drawn(seed, Purpose.BODY, generation * AGE, np.arange(64)).hi % len(WAYS)
        assert len(set(ways.tolist())) == len(WAYS)
        causes = deaths["cause"][deaths["tick"] == (generation + 1) * AGE]
        assert causes.tolist() == [last if WAYS[way] == "time-limit" else WAYS[way] for way in ways]
    assert not deaths["food"].any(), "food that is not finite was not eaten"
    assert not lived.table("metrics")["food"].any()
