"""Any MuJoCo model as a habitat. Bodies are stepped in parallel on all cores that the process may use.

Schmidgall & Hays 2021, "Reacher", "HalfCheetah", "Walker". Settings define senses, death, food and effort
by expressions of named parts of the state. The simulator is MuJoCo's batch (extra `primordia[mujoco]`).
The results do not depend on the number of threads. A saved row of state includes the warm start of
MuJoCo's solver, so a body goes on exactly.
"""

from functools import cached_property, lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import Field, PrivateAttr, model_validator

from primordia.habitats import conditions
from primordia.habitats.conditions import Expression, Names
from primordia.habitats.contract import Continuous, HostHabitat, Outcome
from primordia.habitats.mujoco import physics
from primordia.habitats.mujoco.adjustable import Adjustable
from primordia.habitats.mujoco.bodies import Bodies
from primordia.habitats.mujoco.simulator import (
    fingerprint,
    load_model,
    needed_files,
    observables,
    package,
    root_translates,
)
from primordia.habitats.mujoco.target import Target
from primordia.random import dice
from primordia.random.gaussian import quantiles
from primordia.settings.base import Settings

if TYPE_CHECKING:
    from PIL.Image import Image

MODELS, RENDERERS = 1024, 4
"""number of bodies whose model is kept, and of bodies for which the means to draw them are kept"""


class MuJoCo(HostHabitat, Settings):
    """A MuJoCo model as a habitat; actions are the controls of the model, kept within their ranges."""

    file: str = Field(description="an MJCF file, or gymnasium:NAME.xml for a model of Gymnasium")
    timestep: float | None = Field(
        None, gt=0, description="seconds in a substep (default: as in the model)"
    )
    substeps: int = Field(1, ge=1, le=1000, description="steps of the simulator in a tick")
    senses: tuple[str, ...] = Field(
        ("qpos", "qvel"),
        strict=False,
        description="numbers that organisms perceive, such as qpos[1:] or qvel",
    )
    position_noise: float = Field(
        0.0, ge=0, description="largest difference between a position at birth and the model's"
    )
    velocity_noise: float = Field(
        0.0, ge=0, description="velocities at birth are uniform from minus to plus this number"
    )
    velocity_sd: float = Field(
        0.0, ge=0, description="velocities at birth are Gaussian with this standard deviation"
    )
    fatal: str = Field("", description='condition that ends a life; "": no condition ends it')
    food: str = Field("0", description="amount gathered in a tick")
    effort: str = Field("0", description="amount exerted in a tick")
    capacity: str = Field(
        "", description="""energy that a body holds at most, as a share of metabolism.cap; "": 1"""
    )
    target: Target | None = Field(None, description="an object that the robot must reach")
    adjustable: dict[str, Annotated[tuple[str, ...], Field(strict=False)]] = Field(
        {},
        description="physical parameters by name, and the attributes of the model that each multiplies,"
        " such as geom.thigh.size[1]",
    )
    episode: int | None = Field(
        None,
        ge=1,
        description="ticks after which an evaluation ends a game; lives have no such limit",
    )
    scored: dict[str, Any] = Field(
        {}, description="settings that differ in the standard benchmark, in which food is the score"
    )

    _bodies: Bodies = PrivateAttr()
    _models: list[Any] = PrivateAttr()
    """the model of each body, [N]; they differ only with `adjustable` parameters"""
    _refused: dict[int, str] = PrivateAttr()
    """why MuJoCo refuses the body of a cell, which has the usual model instead"""
    _dice: np.ndarray = PrivateAttr()
    """uint64 (N,): dice from which targets get their positions"""

    @model_validator(mode="after")
    def _check_settings(self) -> "MuJoCo":
        assert self._sense_expressions
        assert self._observed is not None
        if self.adjustable:
            assert self._model_of
        if taken := set(self.adjustable) & set(physics.FIELDS):
            raise ValueError(
                f"adjustable: {min(taken)} is a parameter already; choose another name"
            )
        if (original := self.original()) and original.senses_size != self.senses_size:
            raise ValueError(
                f"scored: these settings must give {self.senses_size} senses, as in the task"
            )
        if self.velocity_noise and self.velocity_sd:
            raise ValueError("velocity_noise and velocity_sd exclude each other; set one to 0")
        if self.target is not None:
            self.target.check(self._model)
        return self

    @staticmethod
    def files_with(file: str) -> list[str]:
        """Return the full paths of a model's file and of all files that it needs."""
        return needed_files(file)

    @cached_property
    def _model(self) -> Any:
        return load_model(self.file, self.timestep)

    @cached_property
    def _names(self) -> Names:
        known = observables(self._model)
        return {**known, "reached": "condition"} if self.target else known

    @cached_property
    def _sense_expressions(self) -> list[Expression]:
        return [conditions.parse(text, "numbers", self._names) for text in self.senses]

    @cached_property
    def _results(self) -> dict[str, Expression]:
        """The expressions of the results of a tick, by their name in `Outcome`."""
        texts = {"food": self.food, "effort": self.effort}
        texts |= {"capacity": self.capacity} if self.capacity else {}
        results = {
            name: conditions.parse(each, "amount", self._names) for name, each in texts.items()
        }
        if self.fatal:
            results["fatal"] = conditions.parse(self.fatal, "condition", self._names)
        return results

    @cached_property
    def _observed(self) -> frozenset[str]:
        """Names of the observables that the settings use."""
        expressions = [*self._sense_expressions, *self._results.values()]
        observed = frozenset().union(*(expression.names for expression in expressions))
        return observed | {"reached"} if self.target else observed

    @property
    def versions(self) -> dict[str, str]:
        """Version of MuJoCo, and the fingerprint of the model's files."""
        return {"mujoco": version("mujoco"), Path(self.file).name: fingerprint(self.file)}

    @property
    def senses_size(self) -> int:
        """Number of senses."""
        kinds = [expression.kind for expression in self._sense_expressions]
        return sum(kind if isinstance(kind, int) else 1 for kind in kinds)

    @property
    def action(self) -> Continuous:
        """Controls of the model."""
        low, high = (tuple(each.tolist()) for each in self._range)
        return Continuous(self._model.nu, (low, high))

    @property
    def words(self) -> int:
        """A random word for each position and velocity, and two for the dice of a target."""
        return self._model.nq + self._model.nv + (2 if self.target else 0)

    @property
    def rate(self) -> float:
        """Ticks a second."""
        return 1 / (self._model.opt.timestep * self.substeps)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Physical parameters that may differ from body to body, and change within a life."""
        return *physics.offered(self._model), *self.adjustable

    def open(self, cells: int, watched: bool = False) -> None:
        """Allocate the bodies."""
        model = self._model
        if "cfrc_ext" in self._observed:
            model = load_model(self.file, self.timestep, forces=True)
        self._bodies = Bodies(model, cells, self._observed)
        self._dice = np.zeros(cells, np.uint64)
        self._models, self._refused = [model] * cells, {}

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Put the bodies of cells into the model's pose, with noise from words uint32 (K, words)."""
        bodies, positions = self._bodies.batch, self._model.nq
        bodies.reset(cells, stage=package().mjtStage.mjSTAGE_NONE)
        bodies.qpos[cells] += self.position_noise * _uniform(words[:, :positions])
        of_velocity = words[:, positions : positions + self._model.nv]
        uniform, gaussian = _uniform(of_velocity), quantiles()[of_velocity >> np.uint32(16)]
        bodies.qvel[cells] = self.velocity_noise * uniform + self.velocity_sd * gaussian
        if self.target is not None:
            for cell, (high, low) in zip(cells.tolist(), words[:, -2:].tolist(), strict=True):
                self._dice[cell] = dice.begin(high, low)
                self._move_target(self.target, cell)
        bodies.forward(cells)
        return self._compute_senses(self._observe(self._bodies.positions()))[cells]

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies of the living by one tick."""
        bodies = self._bodies  # pydantic finds a private attribute slowly
        np.clip(action, *self._range, out=bodies.views["ctrl"])
        before, fault = bodies.positions(), bodies.step(alive, self.substeps)
        fault[[*self._refused]] = True
        values = self._observe(before)
        outcome = self._judge(values, fault)
        if self.target is not None and (reached := values["reached"] & alive).any():
            cells = np.flatnonzero(reached)
            for cell in cells.tolist():
                self._move_target(self.target, cell)
            bodies.batch.forward(cells)
        return self._compute_senses(values), outcome

    @cached_property
    def _range(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and largest controls, (nu,) each; infinite where a control has no range."""
        limited, (low, high) = self._model.actuator_ctrllimited, self._model.actuator_ctrlrange.T
        return np.where(limited, low, -np.inf), np.where(limited, high, np.inf)

    def set_factors(self, cells: np.ndarray, factors: np.ndarray) -> None:
        """Multiply the parameters of the bodies in cells; see `HostHabitat.set_factors`."""
        bodies = self._bodies
        if self.adjustable:
            self._remake(cells, factors)
            bodies.mass[cells] = [self._models[c].body_subtreemass[0] for c in cells.tolist()]
        else:
            physics.scale(self._model, bodies.batch, cells, factors)
            of_mass = factors[:, self.parameters.index(physics.DERIVING)]
            bodies.mass[cells] = self._model.body_subtreemass[0] * of_mass.astype(float)

    def _remake(self, cells: np.ndarray, factors: np.ndarray) -> None:
        """Give bodies models of their own; a body that MuJoCo refuses fails in its next tick."""
        for cell, row in zip(cells.tolist(), factors.tolist(), strict=True):
            self._refused.pop(cell, None)
            try:
                self._models[cell] = self._model_of(tuple(row))
            except ValueError as error:
                self._models[cell] = self._model
                self._refused[cell] = " ".join(str(error).split())
        self._bodies.batch.set_models(self._models)

    @cached_property
    def _model_of(self) -> Any:
        """The function that returns the model of a body from its factors; equal bodies share one."""
        forces = "cfrc_ext" in self._observed
        return lru_cache(MODELS)(
            Adjustable(self.file, self.timestep, self.adjustable, forces).model
        )

    def message(self, cell: int) -> str:
        """Return why MuJoCo refused a body; "" for a simulation that failed."""
        return self._refused.get(cell, "")

    def _judge(self, values: dict[str, Any], fault: Any) -> Outcome:
        """Return the outcome of a tick, from the values of the observables after it."""
        results: dict[str, Any] = {"fatal": np.zeros(len(fault), bool), "fault": fault}
        for name, expression in self._results.items():
            dtype = bool if name == "fatal" else np.float32
            results[name] = expression.of_all(values, len(fault), dtype)
        return Outcome(**results)

    def _observe(self, before: dict[str, np.ndarray]) -> dict[str, Any]:
        """Return the present values of the observables, given the positions before the tick."""
        values = self._bodies.observe(before)
        if self.target is not None:
            values["reached"] = self.target.reached(values["xpos"])
        return values

    def _compute_senses(self, values: dict[str, Any]) -> np.ndarray:
        """Return the senses of all cells, float32 (N, S)."""
        parts = [expression(values) for expression in self._sense_expressions]
        columns = [part if part.ndim == 2 else part[:, None] for part in parts]
        return np.concatenate(columns, axis=1, dtype=np.float32)

    def _move_target(self, target: Target, cell: int) -> None:
        """Move a cell's target to a random position, at rest."""
        self._dice[cell], position = target.draw_position(int(self._dice[cell]))
        for (qpos, qvel), coordinate in zip(self._target_joints, position, strict=True):
            self._bodies.views["qpos"][cell, qpos] = coordinate
            self._bodies.views["qvel"][cell, qvel] = 0.0

    @cached_property
    def _target_joints(self) -> list[tuple[int, int]]:
        return self.target.joint_addresses(self._model) if self.target else []

    def original(self) -> "MuJoCo | None":
        """Return the game as the standard benchmark scores it; None if `scored` is not set."""
        changed = {**self.model_dump(), "scored": {}, **self.scored}
        return MuJoCo(**changed) if self.scored else None

    def seen(self) -> dict[str, np.ndarray]:
        """Return the positions of the joints, float64 (N, nq)."""
        return {"qpos": self._bodies.views["qpos"]}

    @cached_property
    def _renderer(self) -> Any:
        from primordia.habitats.mujoco.picture import Renderer

        return Renderer(self._model)

    def picture(self, body: dict[str, np.ndarray], action: np.ndarray) -> "Image":
        """Return a picture of the robot, with a margin for captions above."""
        return self._renderer.draw(body["qpos"])

    def picture_scaled(
        self, body: dict[str, np.ndarray], action: np.ndarray, factors: np.ndarray
    ) -> "Image":
        """Return a picture of a robot with other lengths; other parameters are not to be seen."""
        if not self.adjustable:
            return self.picture(body, action)
        return self._renderer_of(tuple(factors.tolist())).draw(body["qpos"])

    @cached_property
    def _renderer_of(self) -> Any:
        from primordia.habitats.mujoco.picture import Renderer

        drawn = Adjustable(self.file, self.timestep, self.adjustable, textures=True)
        return lru_cache(RENDERERS)(lambda factors: Renderer(drawn.model(factors)))

    def caption(self, body: dict[str, np.ndarray], action: np.ndarray) -> str:
        """Return the distance travelled along x, if the robot can travel."""
        return f"x {body['qpos'][0]:,.1f} m" if root_translates(self._model) else ""

    def save(self) -> dict[str, np.ndarray]:
        """Return MuJoCo's states, float64 (N, L), and the dice of targets."""
        return {"state": self._bodies.batch.state.copy(), "dice": self._dice.copy()}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore the states that `save` returned."""
        self._bodies.load(arrays["state"])
        self._dice[:] = arrays["dice"]


def _uniform(words: np.ndarray) -> np.ndarray:
    """Return words uint32 as numbers from -1 to 1, float64."""
    return (words >> np.uint32(8)) * 2.0**-23 - 1
