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
from primordia.law.mutation import BlockSetting, Mutation
from primordia.law.placement import Placement
from primordia.law.seasons import Columns, Ratchet, Schedule


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
    replication: float
    hazard: float
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
    def founder_scale(self) -> np.ndarray:
        """Standard deviation of each of a founder's weights, float32 (P,)."""
        scales = self.mutation.of_blocks("founder_scale", self.layout.names)
        return np.repeat(np.array(scales, np.float32), self.layout.sizes)

    @cached_property
    def columns(self) -> Columns:
        """Which blocks each setting under `mutation` governs."""
        found: Columns = {}
        fields: tuple[BlockSetting, ...] = ("probability", "scale")
        for field in fields:
            own = self.mutation.own(field, self.layout.names)
            found[f"mutation.{field}"] = [i for i, value in enumerate(own) if value is None]
            for i, block in enumerate(self.layout.names):
                found[f"mutation.blocks.{block}.{field}"] = [i]
        return found

    @property
    def has_hazard(self) -> bool:
        """Whether accidents can happen, now or in a later season."""
        return self.hazard > 0 or any(season.setting == "hazard" for season in self.seasons)

    @property
    def cell_numbers(self) -> Array:
        """Number of each cell within its world, int32 (C,)."""
        return jnp.tile(jnp.arange(self.cells, dtype=jnp.int32), self.worlds)
