"""The worlds of a fork at its first tick, made of two invented worlds."""

from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp

from primordia.config import Config
from primordia.law.world import World, Worlds
from primordia.random.wide import wide
from primordia.runs import fork

COUNTS = {"food": [100, 2**40], "organism_ticks": [300, 2**50]}
"""Counts of the two worlds at the fork. All other counts are 100 and 200."""


def adapted(at: int, old: Config, new: Config) -> Worlds:
    """Return the worlds with the new settings; their `looks` are "looks" before that."""
    worlds: Any = Worlds(*[wide([100, 200])] * len(Worlds._fields))
    worlds = worlds._replace(
        **{name: wide(values) for name, values in COUNTS.items()},
        calm=jnp.array([7, 8]), sample_wait=jnp.array([1, 1]), looks="looks", climate={},
    )  # fmt: skip
    engine: Any = SimpleNamespace(law=SimpleNamespace(beginning=(), seasons=new.seasons))
    organisms: Any = "organisms"
    world = fork._adapt(World(organisms, worlds), engine, engine, old, new, at)
    assert world.organisms == organisms, "organisms keep their energy"
    return world.worlds
