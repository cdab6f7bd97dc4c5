"""The law: everything that is fixed for the worlds of a run."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.brains.contract import Brain
from primordia.brains.layout import Layout
from primordia.habitats.contract import Continuous, Discrete
from primordia.law.metabolism import Metabolism
from primordia.law.motor import Motor
from primordia.law.placement import Placement
from primordia.law.seasons import Ratchet, Schedule
from primordia.mutations.contract import Mutation


@dataclass(frozen=True)
class Law:
    """What holds in W worlds of N cells; everything here is fixed for a run."""

    worlds: int
    cells: int
    """of one world"""
    brain: Brain
    layout: Layout
    """of genomes"""
    memory: int
    """M, the length of an organism's memory"""
    action: Discrete | Continuous
    motor: Motor
    placement: Placement
    mutation: Mutation
    ancestors: np.ndarray | None
    """genomes that founders take in turn, float32 (K, P); None: founders are random"""
    metabolism: Metabolism | None
    beginning: tuple[tuple[str, float], ...]
    """settings that seasons may change, by dotted name, with the values that worlds begin with"""
    inheritance: Literal["parent", "founder"]
    genesis: Literal["one", "fill"]
    seasons: tuple[Schedule | Ratchet, ...]
    saturation_ticks: int
    """a full world in which nobody died for this long is saturated"""
    sample_every: int

    def by_world(self, per_cell: Array) -> Array:
        """(C, ...) -> (W, N, ...)."""
        return per_cell.reshape(self.worlds, self.cells, *per_cell.shape[1:])

    def per_cell(self, per_world: Array) -> Array:
        """(W,) -> (C,)."""
        return jnp.broadcast_to(per_world[:, None], (self.worlds, self.cells)).ravel()

    @cached_property
    def rates(self) -> tuple[str, ...]:
        """Dotted names of the settings that seasons may change."""
        return tuple(name for name, _ in self.beginning)

    def governed(self, setting: str) -> list[str]:
        """Return the names among `rates` that a season of a setting changes; none: it is unknown."""
        part, _, own = setting.partition(".")
        if part == "mutation":
            return [f"mutation.{name}" for name in self.mutation.governed(own, self.layout)]
        return [setting] if setting in self.rates else []

    @property
    def has_hazard(self) -> bool:
        """Whether accidents can happen, now or in a later season."""
        return dict(self.beginning)["hazard"] > 0 or any(
            season.setting == "hazard" for season in self.seasons
        )

    @property
    def cell_numbers(self) -> Array:
        """Number of each cell within its world, int32 (C,)."""
        return jnp.tile(jnp.arange(self.cells, dtype=jnp.int32), self.worlds)
