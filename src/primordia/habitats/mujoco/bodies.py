"""The bodies of a run: MuJoCo's batch, and its observables after a tick."""

from collections.abc import Collection
from typing import Any

import numpy as np

from primordia import cores
from primordia.habitats.mujoco.simulator import FORCES, ROOT, ids_by_name, package, sensors

DERIVED = {"xpos", "site", "height", "pitch", "travelled", "com_forward", "reached"}
"""Observables that MuJoCo derives from the positions after a step."""
SENSED = {"sensordata", "sensor"}
"""Observables that sensors measure after a step."""
STATE = ("qpos", "qvel", "ctrl", "act", "time")
"""Observables that are parts of the state."""


class Bodies:
    """A batch of bodies of one model, which a habitat steps."""

    def __init__(self, model: Any, cells: int, observed: Collection[str]) -> None:
        """Allocate the bodies, and observe the `simulator.observables` named in `observed`."""
        # With one thread the batch starts none: the calling thread steps the bodies.
        self.batch = package().batch.Batch(model, cells, nthread=cores.count())
        self.mass = np.full(cells, model.body_subtreemass[0])
        """masses of the whole bodies, float64 (N,), kg"""
        bind, wanted = self.batch.bind, set(observed)
        self.views: dict[str, Any] = {name: bind(name) for name in STATE}
        """Views of the bodies' state by name, which change as the bodies do"""
        if wanted & {"xpos", "reached"}:
            xpos, bodies = bind("xpos"), ids_by_name(model, "body")
            self.views["xpos"] = {name: xpos[:, number] for name, number in bodies.items()}
        if "site" in wanted:
            xpos, sites = bind("site_xpos"), ids_by_name(model, "site")
            self.views["site"] = {name: xpos[:, number] for name, number in sites.items()}
        if "height" in wanted:
            self.views["height"] = bind("xpos")[:, ROOT, 2]
        if "pitch" in wanted:
            self.views["rotation"] = bind("xmat")[:, ROOT]
        if "cfrc_ext" in wanted:
            forces, bodies = bind("cfrc_ext"), ids_by_name(model, "body")
            self.views["cfrc_ext"] = {name: forces[:, number] for name, number in bodies.items()}
        if wanted & SENSED:
            columns = sensors(model)
            data = bind("sensordata")[:, : columns.pop(FORCES, slice(None)).start]
            self.views["sensordata"] = data
            self.views["sensor"] = {name: data[:, each] for name, each in columns.items()}
        self._tracked: dict[str, np.ndarray] = {}
        """Views of the positions whose displacement in a tick is observed"""
        if "forward" in wanted:
            self._tracked["forward"] = self.views["qpos"][:, 0]
        if wanted & {"travelled", "com_forward"}:
            self._tracked["com"] = bind("subtree_com")[:, 0, :2]
        self._stage = _stage(model, wanted)
        """the stage up to which MuJoCo computes derived quantities after a step"""

    def step(self, alive: np.ndarray, substeps: int) -> np.ndarray:
        """Step the bodies of the living, and return those whose simulation failed, bool (N,)."""
        fault = np.zeros(len(alive), bool)
        try:
            cells = None if alive.all() else np.flatnonzero(alive)
            self.batch.step(cells, nstep=substeps, stage=self._stage)
        except package().batch.SimulationError as error:
            fault[error.ids] = True
        return fault

    def positions(self) -> dict[str, np.ndarray]:
        """Return a copy of the positions whose displacement is observed."""
        return {name: position.copy() for name, position in self._tracked.items()}

    def observe(self, before: dict[str, np.ndarray]) -> dict[str, Any]:
        """Return the present values of the observables, given `positions` before the tick."""
        views, values = self.views, {**self.views, "mass": self.mass}
        if "forward" in before:
            values["forward"] = self._tracked["forward"] - before["forward"]
        if "com" in before:
            displacement = self._tracked["com"] - before["com"]
            values["com_forward"] = displacement[:, 0]
            values["travelled"] = np.hypot(*displacement.T)
        if "rotation" in views:
            values["pitch"] = np.arctan2(-views["rotation"][:, 6], views["rotation"][:, 0])
        return values

    def load(self, state: np.ndarray) -> None:
        """Restore MuJoCo's states, float64 (N, L)."""
        self.batch.state[:] = state
        if self._stage:
            self.batch.forward(stage=self._stage)


def _stage(model: Any, wanted: Collection[str]) -> Any:
    """Return the first stage of MuJoCo after which all observables are computed.

    Forces and accelerations are those of the new state with the controls of the tick that led to it.
    """
    stages = package().mjtStage
    needed = [stages.mjSTAGE_NONE]
    if DERIVED & set(wanted):
        needed.append(stages.mjSTAGE_POS)
    if SENSED & set(wanted):
        needed += [stages(each) for each in model.sensor_needstage]
    if "cfrc_ext" in wanted:
        needed.append(stages.mjSTAGE_ACC)
    return max(needed, key=int)
