"""Any MuJoCo model as a habitat: bodies, stepped side by side on all cores.

Schmidgall & Hays 2021, "Reacher", "HalfCheetah", "Walker". What is perceived, fatal, food and effort is
said in settings, of named parts of the state. The simulator is MuJoCo's batch (extra
`primordia[mujoco]`): results do not depend on the number of threads, and a row of its state, warm start
included, is all that a body needs to go on exactly.
"""

import os
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import Field, PrivateAttr, model_validator

from primordia.habitats import conditions
from primordia.habitats.conditions import Expression, Names
from primordia.habitats.contract import Continuous, HostHabitat, Outcome
from primordia.habitats.mujoco.simulator import (
    ROOT,
    compiled,
    fingerprint,
    moves_about,
    names,
    numbered,
    package,
)
from primordia.habitats.mujoco.target import Target
from primordia.random import dice
from primordia.random.gaussian import quantiles
from primordia.settings.base import Settings

if TYPE_CHECKING:
    from PIL.Image import Image

PLACES = {"xpos", "site", "height", "pitch", "travelled", "com_forward", "reached"}
"""Names of what is not in the state itself, but follows from it."""


class MuJoCo(HostHabitat, Settings):
    """A model as a habitat; actions are its controls, kept within their ranges."""

    file: str = Field(description="an MJCF file, or gymnasium:NAME.xml, one that Gymnasium brings")
    timestep: float | None = Field(None, gt=0, description="seconds a substep, if not the model's")
    substeps: int = Field(1, ge=1, le=1000, description="steps of the simulator in a tick")
    senses: tuple[str, ...] = Field(
        ("qpos", "qvel"), strict=False, description="numbers perceived, such as qpos[1:] or qvel"
    )
    position_noise: float = Field(
        0.0, ge=0, description="bodies are born in positions up to so far from the model's own"
    )
    velocity_noise: float = Field(0.0, ge=0, description="... with velocities up to so large,")
    velocity_sd: float = Field(0.0, ge=0, description="... or with Gaussian ones of so large an sd")
    fatal: str = Field("", description="condition that ends a life; none: nothing does")
    food: str = Field("0", description="amount gathered in a tick")
    effort: str = Field("0", description="amount exerted in a tick")
    target: Target | None = Field(None, description="something to be reached")
    episode: int | None = Field(
        None, ge=1, description="ticks after which an evaluation ends a game; no life ends there"
    )
    scored: dict[str, Any] = Field(
        {}, description="what is different in the game that others score, where food is the score"
    )

    _bodies: Any = PrivateAttr()
    _seen: dict[str, Any] = PrivateAttr()
    """Arrays by name that are always as the bodies are"""
    _ways: dict[str, np.ndarray] = PrivateAttr()
    """The same, of places between which ways are measured"""
    _dice: np.ndarray = PrivateAttr()
    """uint64 (N,), of targets"""

    @model_validator(mode="after")
    def _makes_sense(self) -> "MuJoCo":
        assert self._perceived
        assert self._used is not None
        if (original := self.original()) and original.senses_size != self.senses_size:
            raise ValueError("scored: senses must be as many as in the task itself")
        if self.velocity_noise and self.velocity_sd:
            raise ValueError("velocity_noise or velocity_sd: one or the other")
        if self.target is not None:
            self.target.check(self._model)
        return self

    @cached_property
    def _model(self) -> Any:
        return compiled(self.file, self.timestep)

    @cached_property
    def _names(self) -> Names:
        known = names(self._model)
        return {**known, "reached": "condition"} if self.target else known

    @cached_property
    def _perceived(self) -> list[Expression]:
        return [conditions.parse(each, "numbers", self._names) for each in self.senses]

    @cached_property
    def _is_fatal(self) -> Expression | None:
        return conditions.parse(self.fatal, "condition", self._names) if self.fatal else None

    @cached_property
    def _is_food(self) -> Expression:
        return conditions.parse(self.food, "amount", self._names)

    @cached_property
    def _is_effort(self) -> Expression:
        return conditions.parse(self.effort, "amount", self._names)

    @cached_property
    def _used(self) -> frozenset[str]:
        """Names that are spoken of."""
        judged = [self._is_food, self._is_effort, *filter(None, [self._is_fatal])]
        spoken = frozenset().union(*(each.names for each in (*self._perceived, *judged)))
        return spoken | {"reached"} if self.target else spoken

    @property
    def versions(self) -> dict[str, str]:
        """MuJoCo's, and which model the file holds."""
        return {"mujoco": version("mujoco"), Path(self.file).name: fingerprint(self._model)}

    @property
    def senses_size(self) -> int:
        """How many numbers are perceived."""
        return sum(each.kind if isinstance(each.kind, int) else 1 for each in self._perceived)

    @property
    def action(self) -> Continuous:
        """Controls."""
        return Continuous(self._model.nu)

    @property
    def words(self) -> int:
        """One for each position and velocity, and two for the dice of a target."""
        return self._model.nq + self._model.nv + 2 * (self.target is not None)

    @property
    def rate(self) -> float:
        """Ticks in a second."""
        return 1 / (self._model.opt.timestep * self.substeps)

    def open(self, cells: int, watched: bool = False) -> None:
        """Make room for so many bodies, watched or not."""
        threads = len(os.sched_getaffinity(0))
        self._bodies = package().batch.Batch(self._model, cells, nthread=threads)
        self._dice = np.zeros(cells, np.uint64)
        bound, model, used = self._bodies.bind, self._model, self._used
        self._seen = {name: bound(name) for name in ("qpos", "qvel", "ctrl")}
        if used & {"xpos", "reached"}:
            places = bound("xpos")
            self._seen["xpos"] = {n: places[:, i] for n, i in numbered(model, "body").items()}
        if "site" in used:
            places = bound("site_xpos")
            self._seen["site"] = {n: places[:, i] for n, i in numbered(model, "site").items()}
        if "height" in used:
            self._seen["height"] = bound("xpos")[:, ROOT, 2]
        if "pitch" in used:
            self._seen["frame"] = bound("xmat")[:, ROOT]
        self._ways = {}
        if "forward" in used:
            self._ways["forward"] = self._seen["qpos"][:, 0]
        if used & {"travelled", "com_forward"}:
            self._ways["middle"] = bound("subtree_com")[:, 0, :2]

    @cached_property
    def _stage(self) -> Any:
        """What is computed of a state besides: places, if they are spoken of."""
        stages = package().mjtStage
        return stages.mjSTAGE_POS if self._used & PLACES else stages.mjSTAGE_NONE

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        """The model's own pose, with noise from words uint32 (K, words)."""
        bodies, positions = self._bodies, self._model.nq
        bodies.reset(born, stage=package().mjtStage.mjSTAGE_NONE)
        bodies.qpos[born] += self.position_noise * _uniform(words[:, :positions])
        moved = words[:, positions : positions + self._model.nv]
        gaussian = quantiles()[moved >> np.uint32(16)]
        bodies.qvel[born] = self.velocity_noise * _uniform(moved) + self.velocity_sd * gaussian
        if self.target is not None:
            for cell, (high, low) in zip(born.tolist(), words[:, -2:].tolist(), strict=True):
                self._dice[cell] = dice.begin(high, low)
                self._put_target(self.target, cell)
        bodies.forward(born)
        return self._sensed(self._values(self._stood()))[born]

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """One tick of the bodies that live."""
        np.clip(action, *self._range, out=self._seen["ctrl"])
        before, fault = self._stood(), self._advance(alive)
        values = self._values(before)
        fatal = self._is_fatal(values) if self._is_fatal else False
        told: dict[str, Any] = {
            "fatal": np.full(len(alive), fatal, bool),
            "food": np.full(len(alive), self._is_food(values), np.float32),
            "effort": np.full(len(alive), self._is_effort(values), np.float32),
            "fault": fault,
        }
        if self.target is not None and (reached := values["reached"] & alive).any():
            cells = np.flatnonzero(reached)
            for cell in cells.tolist():
                self._put_target(self.target, cell)
            self._bodies.forward(cells)
        return self._sensed(values), Outcome(**told)

    @cached_property
    def _range(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and largest controls, (nu,) each; infinite where a control has no range."""
        limited, (low, high) = self._model.actuator_ctrllimited, self._model.actuator_ctrlrange.T
        return np.where(limited, low, -np.inf), np.where(limited, high, np.inf)

    def _advance(self, alive: np.ndarray) -> np.ndarray:
        """Step who is alive -> whose simulation failed, bool (N,); the others are not disturbed."""
        fault = np.zeros(len(alive), bool)
        try:
            who = None if alive.all() else np.flatnonzero(alive)
            self._bodies.step(who, nstep=self.substeps, stage=self._stage)
        except package().batch.SimulationError as error:
            fault[error.ids] = True
        return fault

    def _stood(self) -> dict[str, np.ndarray]:
        """From where ways are measured."""
        return {name: place.copy() for name, place in self._ways.items()}

    def _values(self, before: dict[str, np.ndarray]) -> dict[str, Any]:
        """All that is spoken of, as it is now."""
        seen, values = self._seen, dict(self._seen)
        if "forward" in before:
            values["forward"] = self._ways["forward"] - before["forward"]
        if "middle" in before:
            moved = self._ways["middle"] - before["middle"]
            values["com_forward"], values["travelled"] = moved[:, 0], np.hypot(*moved.T)
        if "frame" in seen:
            values["pitch"] = np.arctan2(-seen["frame"][:, 6], seen["frame"][:, 0])
        if self.target is not None:
            values["reached"] = self.target.reached(seen["xpos"])
        return values

    def _sensed(self, values: dict[str, Any]) -> np.ndarray:
        """Float32 (N, S)."""
        parts = [each(values) for each in self._perceived]
        columns = [part if part.ndim == 2 else part[:, None] for part in parts]
        return np.concatenate(columns, axis=1, dtype=np.float32)

    def _put_target(self, target: Target, cell: int) -> None:
        """Somewhere else, at rest."""
        self._dice[cell], place = target.somewhere(int(self._dice[cell]))
        for (position, velocity), along in zip(self._slides, place, strict=True):
            self._seen["qpos"][cell, position] = along
            self._seen["qvel"][cell, velocity] = 0.0

    @cached_property
    def _slides(self) -> list[tuple[int, int]]:
        return self.target.slides(self._model) if self.target else []

    def original(self) -> "MuJoCo | None":
        """The game that others score, if it is said what that is."""
        changed = {**self.model_dump(), "scored": {}, **self.scored}
        return MuJoCo(**changed) if self.scored else None

    def seen(self) -> dict[str, np.ndarray]:
        """Positions of the joints, float64 (N, nq)."""
        return {"qpos": self._seen["qpos"]}

    @cached_property
    def _eye(self) -> Any:
        from primordia.habitats.mujoco.picture import Eye

        return Eye(self._model)

    def picture(self, body: dict[str, np.ndarray], action: np.ndarray) -> "Image":
        """The robot where it stands, with room for words above."""
        return self._eye.draw(body["qpos"])

    def caption(self, body: dict[str, np.ndarray], action: np.ndarray) -> str:
        """How far it has come."""
        return f"x {body['qpos'][0]:,.1f} m" if moves_about(self._model) else ""

    def save(self) -> dict[str, np.ndarray]:
        """MuJoCo's states, float64 (N, L), and the dice of targets."""
        return {"state": self._bodies.state.copy(), "dice": self._dice.copy()}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Take back what `save` gave."""
        self._bodies.state[:], self._dice[:] = arrays["state"], arrays["dice"]
        if self._stage:
            self._bodies.forward(stage=self._stage)


def _uniform(words: np.ndarray) -> np.ndarray:
    """From -1 to 1, float64."""
    return (words >> np.uint32(8)) * 2.0**-23 - 1
