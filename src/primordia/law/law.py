"""The law: all settings that are fixed for the worlds of a run."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.brains.contract import Brain
from primordia.habitats.contract import Action
from primordia.law.act import Act
from primordia.law.heredity import Heredity
from primordia.law.metabolism import ONE, Metabolism
from primordia.law.motor import Motor
from primordia.law.placement import Placement
from primordia.law.seasons import Ratchet, Schedule
from primordia.mutations.gaussian import Gaussian
from primordia.settings.islands import Islands


@dataclass(frozen=True)
class Law:
    """The law of W worlds of N cells, which never changes in a run."""

    worlds: int
    cells: int
    """cells of one world"""
    islands: Islands
    brain: Brain
    heredity: Heredity
    senses: int
    """S, the numbers that an organism perceives; see `perceived`"""
    interoception: bool
    """whether an organism perceives its energy"""
    memory: int
    """M, the length of an organism's memory"""
    action: Action
    motor: Motor
    placement: Placement
    metabolism: Metabolism | None
    act: Act | None
    """None: organisms replicate spontaneously, with the probability `replication`"""
    beginning: tuple[tuple[str, float], ...]
    """settings that seasons may change: dotted name -> value at the beginning"""
    genesis: Literal["one", "fill"]
    seasons: tuple[Schedule | Ratchet, ...]
    saturation_ticks: int
    """a full world is saturated after this number of ticks without a death"""
    sample_every: int
    """ticks between samples"""

    def by_world(self, per_cell: Array) -> Array:
        """Return an array with an entry for each cell, split by world: (C, ...) -> (W, N, ...)."""
        return per_cell.reshape(self.worlds, self.cells, *per_cell.shape[1:])

    def per_cell(self, per_world: Array) -> Array:
        """Repeat the entry of each world for its cells: (W,) -> (C,)."""
        return jnp.broadcast_to(per_world[:, None], (self.worlds, self.cells)).ravel()

    def in_cells(
        self, climate: Mapping[str, Array], cells: Array | None = None
    ) -> dict[str, Array]:
        """Return the settings in all cells (C,), or in some (K,), from the settings of worlds (W,).

        Settings of an island replace those of the whole world in its cells.
        """
        if cells is None:
            in_all = {name: self.per_cell(values) for name, values in climate.items()}
            island = np.tile(self.islands.of_cells(np.arange(self.cells)), self.worlds)
            return self.islands.here(in_all, island, jnp.where)
        in_some = {name: values[cells // self.cells] for name, values in climate.items()}
        return self.islands.here(in_some, self.island_of(cells % self.cells), jnp.where)

    def island_of(self, cells: Array) -> Array:
        """Return the numbers of the islands of cells within a world, int32 (K,)."""
        last = jnp.asarray(self.islands.bounds[1:-1], jnp.int32)
        return (cells[:, None] >= last).sum(axis=1, dtype=jnp.int32)

    @property
    def outputs(self) -> int:
        """The number of a brain's outputs: those of the action, and those that decide about copies."""
        return Act.all_outputs(self.action.size, self.act)

    @cached_property
    def rates(self) -> tuple[str, ...]:
        """Dotted names of the settings that seasons may change."""
        return tuple(name for name, _ in self.beginning)

    def governed(self, setting: str) -> list[str]:
        """Return the names among `rates` whose values change if a season changes a setting; [] for
        an unknown setting."""
        island, own = self.islands.split(setting)
        part, _, name_in_part = own.partition(".")
        names = [own]
        if part == "mutation":
            inner = self.heredity.mutation.governed(name_in_part, self.heredity.layout)
            names = [f"mutation.{name}" for name in inner]
        before = f"{island}." if island else ""
        return [before + name for name in names if before + name in self.rates]

    def perceived(self, senses: Any, energy: Any) -> Any:
        """Return what N organisms perceive, float32 (N, S): the habitat's senses (N, S'), followed by
        their energy, int32 (N,), as a share of the store at birth, if they have interoception."""
        if not self.interoception:
            return senses
        steps = np.float32(ONE * dict(self.beginning)["metabolism.store"])
        return jnp.concatenate([senses, (energy.astype(jnp.float32) / steps)[:, None]], axis=1)

    @property
    def has_hazard(self) -> bool:
        """Return whether accidents can happen, now or in a later season."""
        beginning = any(
            value > 0 for name, value in self.beginning if self.islands.split(name)[1] == "hazard"
        )
        return beginning or any(
            self.islands.split(season.setting)[1] == "hazard" for season in self.seasons
        )

    @property
    def compiled(self) -> "Law":
        """Return the law that stands for all laws with the same compiled code.

        They differ in what seasons may change, which is in the climate of a world. Compiled are only
        whether there are accidents, and the store of those that perceive their energy.
        """
        kept = {"hazard": float(self.has_hazard)}
        if self.interoception:
            kept["metabolism.store"] = dict(self.beginning)["metabolism.store"]
        beginning = tuple((name, kept.get(self.islands.split(name)[1], 0.0)) for name in self.rates)
        return replace(self, beginning=beginning, metabolism=self.metabolism and Metabolism())

    @cached_property
    def alone(self) -> "Law":
        """Return the law of an organism without a world, which lives again or plays.

        It stands for all laws that differ in nothing that such an organism meets, so these share the
        compiled code of its life.
        """
        heredity = replace(
            self.heredity, mutation=Gaussian(), recombination=None, ancestors=None, worlds=1
        )
        beginning = tuple(pair for pair in self.compiled.beginning if pair[0] == "metabolism.store")
        return replace(
            self.compiled,
            worlds=1,
            cells=1,
            islands=Islands(("",), (0, 1)),
            heredity=heredity,
            placement=Placement(),
            beginning=beginning,
            genesis="one",
            seasons=(),
            saturation_ticks=1,
            sample_every=1,
        )

    @property
    def cell_numbers(self) -> Array:
        """Number of each cell within its world, int32 (C,)."""
        return jnp.tile(jnp.arange(self.cells, dtype=jnp.int32), self.worlds)
