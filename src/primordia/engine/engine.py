"""A run in memory: law and habitat of a configuration, advanced chunk by chunk."""

import time
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from primordia import device
from primordia.config import Config
from primordia.engine.fused import Fused
from primordia.engine.hosted import Hosted
from primordia.engine.state import Limits, State, running
from primordia.habitats.contract import AnyHabitat
from primordia.law.events import Events
from primordia.law.genesis import begin
from primordia.law.law import Law
from primordia.random.wide import wide

_running = jax.jit(running)

CHUNK_SECONDS = 0.2
"""Aimed at, so that Ctrl-C is heard in time."""


class Engine:
    """A run in memory: law, habitat and where they stand."""

    def __init__(self, config: Config) -> None:
        device.prepare()
        self.config = config
        habitat = config.build_habitat()
        self.law = config.build_law(habitat)
        self.tallies = habitat.tallies
        self.chunks: Fused | Hosted = _chunks(self.law, habitat)
        seeds = [config.seed + world for world in range(config.seeds)]
        self.state: State = self.chunks.begin(begin(self.law, seeds))
        self._ticks = 1

    @property
    def events(self) -> Events:
        """What happened in the latest chunk; the next one uses it up."""
        return self.chunks.events

    def advance(self, limits: Limits) -> Events:
        """One chunk of about CHUNK_SECONDS -> what happened."""
        start = time.perf_counter()
        self.state, done = self.chunks.advance(self.state, limits, self._ticks)
        spent = time.perf_counter() - start
        if done:
            fitting = int(done * CHUNK_SECONDS / spent)
            self._ticks = min(max(fitting, 1), 4 * self._ticks, 2**30)
        return self.events

    def any_running(self, limits: Limits) -> bool:
        """Whether some world has not come to a limit."""
        return bool(_running(self.state.world.worlds, limits).any())

    def limits(self, stop: dict[str, Any], ticks: np.ndarray | None = None) -> Limits:
        """Limits for all worlds alike; `ticks` (W,) if each has its own."""
        every = np.ones(self.config.seeds, np.uint64)
        most = np.uint64(2**64 - 1)
        each = every * np.uint64(stop.get("ticks") or most) if ticks is None else ticks
        births = every * np.uint64(stop.get("births") or most)
        return Limits(wide(each), wide(births), jnp.bool_(stop.get("until") == "saturation"))

    def arrays(self) -> dict[str, np.ndarray]:
        """The state by name."""
        return self.chunks.save(self.state)

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Stand where `arrays` say."""
        self.state = self.chunks.load(self.state, arrays)


def _chunks(law: Law, habitat: AnyHabitat) -> Fused | Hosted:
    return Hosted(law, habitat) if habitat.kind == "host" else Fused(law, habitat)
