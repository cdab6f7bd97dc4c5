"""Worlds for tests: settings of small tasks, and runs that stay in memory."""

from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np

import primordia
from primordia.config import Config, load, validated
from primordia.engine.engine import Engine
from primordia.engine.state import State
from primordia.law.genesis import begin, initial_looks
from primordia.law.law import Law
from primordia.law.world import World, Worlds
from primordia.random.wide import wide
from primordia.runs.digest import digests
from primordia.runs.loop import recorder_for
from primordia.settings.tables import merged

MEADOW: dict[str, Any] = {"task": "meadow", "habitat": {"name": "tests.toys:Meadow"}, "cells": 16}
MILL: dict[str, Any] = {
    "task": "mill",
    "habitat": {"name": "tests.toys:Mill"},
    "motor": {"kind": "gaussian", "sd": 0.3},
    "cells": 24,
    "metabolism": {"store": 40.0, "gain": 3.0, "effort_cost": 0.25, "cap": 80.0},
    "mutation": {"probability": 0.5, "scale": 0.2, "founder_scale": 0.5},
    "hazard": 0.002,
    "sample_every": 100,
    "seasons": [
        {"kind": "ratchet", "setting": "metabolism.gain", "when": "mean_age", "above": 12.0,
         "factor": 0.9, "every": 70},
        {"kind": "schedule", "setting": "mutation.scale", "at": 333, "value": 0.05},
        {"kind": "ratchet", "setting": "replication", "when": "food", "above": 0.1,
         "factor": 1.01, "every": 50},
    ],
}  # fmt: skip

MILLS: dict[str, Any] = {
    **MILL,
    "cells": 16,
    "seeds": 2,
    "hazard": 0.02,
    "brain": {"hidden": 2},
    "placement": {"topology": "torus4", "rule": "replacing"},
    "replication": 0.08,
    "mutation": {**MILL["mutation"], "blocks": {"output": {"scale": 0.1}}},
    "sample_every": 10,
    "seasons": [
        {"kind": "ratchet", "setting": "metabolism.gain", "when": "mean_age", "above": 12.0,
         "factor": 0.93, "every": 20},
        {"kind": "ratchet", "setting": "replication", "when": "saturation", "above": 0.7,
         "factor": 0.9, "every": 30},
        {"kind": "ratchet", "setting": "mutation.scale", "when": "food", "above": 0.0,
         "factor": 1.25, "every": 40},
        {"kind": "ratchet", "setting": "mutation.blocks.output.scale", "when": "mean_age",
         "above": 8.0, "factor": 0.5, "every": 50},
        {"kind": "schedule", "setting": "metabolism.gain", "at": 205, "value": 2.5},
    ],
}  # fmt: skip
"""Two worlds in which organisms die in every way: hunger, broken wheels, accidents, neighbours. All
kinds of seasons change their climate."""

HERD: dict[str, Any] = {
    **MEADOW,
    "habitat": {"name": "tests.toys:Meadow", "lifespan": 90},
    "brain": {"hidden": 1},
    "placement": {"topology": "torus8"},
    "cells": 24,
    "genesis": "fill",
    "seeds": 3,
    "replication": 0.05,
    "hazard": 0.01,
    "metabolism": {"store": 400.0},
    "sample_every": 10,
}
"""Three small worlds with births, copies and deaths of several causes, for tests of what is recorded."""

CLOCKWORK: dict[str, Any] = {
    **HERD,
    "replication": 0.0,
    "hazard": 1e-9,
    "metabolism": {"store": 30.5},
}
"""The herd's law without chance: all cells are filled, all organisms starve in tick 31, and so on."""

RING: dict[str, Any] = {
    **MEADOW,
    "brain": {"hidden": 3},
    "cells": 12,
    "seeds": 4,
    "replication": 0.05,
    "hazard": 0.002,
    "saturation_ticks": 40,
}
"""Four small worlds without energy, in which all deaths are accidents, for tests of chances."""

HOSTED: dict[str, Any] = {
    "cells": 6,
    "genesis": "fill",
    "brain": {"hidden": 2},
    "metabolism": {"store": 9.0, "drain": 0.0, "gain": 1.0, "effort_cost": 1.0, "cap": 100.0},
    "mutation": {"founder_scale": 0.3},
    "hazard": 1e-9,
}
"""A law for habitats on the host. None starves who makes no effort. Where there are two senses and one
number to put out, all worlds share its compiled code."""

LEARNERS: dict[str, Any] = {
    "habitat": {"change": [{"kind": "reverse-actions", "at": [6, 17, 40]}]},
    "brain": {"kind": "plastic", "hidden": 3},
    "cells": 8,
    "seed": 2,
    "genesis": "fill",
    "replication": 0.1,
}
"""Settings of CartPole with plastic brains, whose buttons swap at the ages 6, 17 and 40."""


def config(base: str | dict[str, Any] = "CartPole-survival", **settings: Any) -> Config:
    """Return the settings of a task, given by name or as values, with some of them changed."""
    if isinstance(base, str):
        return load(base, settings)
    return validated(merged(base, settings), source=base["task"])


def law_of(base: str | dict[str, Any] = "CartPole-survival", **settings: Any) -> Law:
    """Return the law of a task with some settings changed."""
    made = config(base, **settings)
    return made.build_law(made.build_habitat())


def begun(law: Law, seeds: np.ndarray, tick: int = 0, births: int = 0) -> World:
    """Return worlds without organisms, with these counts of ticks and births."""
    organisms, worlds = begin(law, seeds)
    return World(organisms, late_worlds(law, worlds, tick, births))


def late_worlds(law: Law, worlds: Worlds, tick: int, births: int) -> Worlds:
    """Return the counts of worlds as if they had lived for some ticks, with some births."""
    count = law.worlds
    return worlds._replace(
        tick=wide(np.full(count, tick, np.uint64)),
        births=wide(np.full(count, births, np.uint64)),
        sample_wait=jnp.full(count, law.sample_every - tick % law.sample_every, jnp.int32),
        looks=initial_looks(law, count, tick),
    )


def digests_of(place: Path) -> list[str]:
    """Return the digest of each world of a run or of an arm."""
    return [world["digest"] for world in primordia.load(place).info()["worlds"]]


class Lived:
    """A run in memory, advanced to some tick, with its records."""

    def __init__(
        self,
        config: Config,
        ticks: int,
        chunk: int | None = None,
        start: tuple[int, int] = (0, 0),
        **stop: Any,
    ) -> None:
        """`start`: the counts of ticks and births that the run starts at."""
        self.config, self.engine, self.start = config, Engine(config), start
        if any(start):
            world, bodies = self.engine.state
            late = World(world.organisms, late_worlds(self.engine.law, world.worlds, *start))
            self.engine.state = State(late, bodies)
        self.recorder = recorder_for(self.engine, None)
        self.rows: dict[str, list[np.ndarray]] = {"births": [], "deaths": [], "metrics": []}
        self.advance_to(ticks, chunk, **stop)

    def advance_to(self, ticks: int, chunk: int | None = None, **stop: Any) -> None:
        """Advance the run to a tick, or until a limit in `stop` is reached."""
        limits = self.engine.limits({"ticks": ticks, **stop})
        while self.engine.any_running(limits):
            if chunk is not None:
                self.engine._ticks = chunk
            events = self.engine.advance(limits)
            self.recorder.append(events)
            for name, table in zip(self.rows, events, strict=True):
                self.rows[name].append(np.asarray(table.rows)[: int(table.filled)].copy())

    def change(self, settings: dict[str, Any]) -> None:
        """Change settings of all worlds alike, or of each, as seasons do; this compiles nothing."""
        world, bodies = self.engine.state
        every = np.ones(self.config.seeds, np.float32)
        new = {name: jnp.asarray(every * np.float32(value)) for name, value in settings.items()}
        assert new.keys() <= world.worlds.climate.keys()
        worlds = world.worlds._replace(climate=world.worlds.climate | new)
        self.engine.state = type(self.engine.state)(world._replace(worlds=worlds), bodies)

    def table(self, name: str) -> dict[str, np.ndarray]:
        """Return the columns of a table as NumPy arrays."""
        arrow = self.recorder.schema.arrow(name, np.concatenate(self.rows[name]))
        return {
            column: arrow[column].to_numpy(zero_copy_only=False) for column in arrow.column_names
        }

    def genomes(self) -> np.ndarray:
        """Return the genomes of the living, float32 (n, P)."""
        organisms = self.engine.state.world.organisms
        blocks = {name: np.asarray(block) for name, block in organisms.genome.items()}
        return self.engine.law.heredity.layout.join(blocks)[np.asarray(organisms.alive)]

    def digests(self) -> list[str]:
        """Return the digest of each world."""
        return digests(
            self.recorder.digests(),
            self.engine.arrays(),
            self.config.seeds,
            self.config.islands,
        )
