"""A run in memory: the law and the habitat of a configuration, advanced chunk by chunk."""

import time
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from primordia import device
from primordia.config import Config
from primordia.engine import memory
from primordia.engine.fused import FusedChunks
from primordia.engine.hosted import HostedChunks
from primordia.engine.sharded import ShardedChunks
from primordia.engine.state import Limits, State, running
from primordia.habitats.contract import AnyHabitat
from primordia.law.events import Events
from primordia.law.law import Law
from primordia.random.wide import wide

CHUNK_SECONDS = 0.2
"""Target time of a chunk, short enough for Ctrl-C to take effect soon."""


class Engine:
    """A run in memory: law, habitat and state."""

    def __init__(self, config: Config) -> None:
        """Raise InputError if there is not enough memory."""
        device.prepare()
        self.config = config
        habitat = config.build_habitat()
        self.law = config.build_law(habitat)
        devices = device.sharing(config.seeds) if habitat.kind == "jax" else [device.default()]
        memory.check(self.law, habitat, devices)
        self.habitat, self.tallies = habitat, habitat.tallies
        self.chunks: FusedChunks | HostedChunks = _chunks(self.law, habitat, devices)
        self.state: State = self.chunks.begin(config.world_seeds)
        self._ticks = 1
        self.longest: int | None = None
        """largest number of ticks of a chunk, for a live view; None: no limit but CHUNK_SECONDS"""

    @property
    def events(self) -> Events:
        """The events of the latest chunk; the next chunk overwrites them."""
        return self.chunks.events

    @property
    def faults(self) -> list[str]:
        """A line for each organism whose body failed in the latest chunk, if the habitat says why."""
        return self.chunks.faults if isinstance(self.chunks, HostedChunks) else []

    def advance(self, limits: Limits) -> Events:
        """Advance by a chunk of about CHUNK_SECONDS, and return its events."""
        start = time.perf_counter()
        ticks = min(self._ticks, self.longest or self._ticks)
        self.state, done = self.chunks.advance(self.state, limits, ticks)
        spent = time.perf_counter() - start
        if done:
            fitting = int(done * CHUNK_SECONDS / spent)
            self._ticks = min(max(fitting, 1), 4 * self._ticks, 2**30)
        return self.events

    def any_running(self, limits: Limits) -> bool:
        """Return whether some world has not reached a limit."""
        of_host = jax.tree.map(np.asarray, (self.state.world.worlds, limits))
        return bool(running(*of_host).any())

    def limits(self, stop: dict[str, Any], ticks: np.ndarray | None = None) -> Limits:
        """Return the limits of all worlds, from settings of `stop`.

        Args:
            stop: settings of `settings.limits.Stop`; a missing setting or None means no limit.
            ticks: a limit in ticks for each world, (W,); it replaces the limit in `stop`.
        """

        def for_all(limit: int | None) -> np.ndarray:
            return np.full(self.config.seeds, limit or 2**64 - 1, np.uint64)

        ticks = for_all(stop.get("ticks")) if ticks is None else ticks
        births = for_all(stop.get("births"))
        return Limits(wide(ticks), wide(births), jnp.bool_(stop.get("until") == "saturation"))

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the arrays of the state, by name."""
        return self.chunks.save(self.state)

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore the state from its arrays.

        Raises:
            Trouble: an array is missing, or does not fit.
        """
        self.state = self.chunks.load(self.state, arrays)


def _chunks(law: Law, habitat: AnyHabitat, devices: list[jax.Device]) -> FusedChunks | HostedChunks:
    if habitat.kind == "host":
        return HostedChunks(law, habitat)
    return ShardedChunks(law, habitat, devices) if devices[1:] else FusedChunks(law, habitat)
