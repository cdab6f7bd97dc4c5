"""One body of a task as a Gymnasium environment."""

from pathlib import Path
from typing import Any

import gymnasium
import jax
import numpy as np
from gymnasium.error import ResetNeeded

from primordia import config
from primordia.envs.bodies import (
    Births,
    Bodies,
    action_space,
    as_rows,
    observation_space,
    zeros,
)
from primordia.habitats.contract import Ability, Compound
from primordia.law.world import Cause

FIRST = np.array([0])


class LifeEnv(gymnasium.Env):
    """A life in one of Primordia's tasks: `terminated` is death, and there is no time limit.

    Observations are an organism's senses, float32 (S,). `info` has `food`, the food gathered so
    far; `energy`, if the task has a metabolism; and `cause` in the tick of death. All numbers equal
    those of an organism with the same actions in a run.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 30}  # noqa: RUF012
    """`render_fps` of an instance is the habitat's ticks for each second; 30 if it has no clock."""

    def __init__(
        self,
        task: str | Path,
        settings: dict[str, Any] | None = None,
        reward: float = 0.0,
        render_mode: str | None = None,
    ) -> None:
        """Make a body.

        Args:
            task: name of a task, or a file, as for `primordia run`.
            settings: settings that differ from those of the task, as nested tables.
            reward: the reward of each tick that is lived; the reward of the tick of death is 0.
            render_mode: `rgb_array`, or None.

        Raises:
            InputError: there is no such task, or a setting is wrong.
            ValueError: there is no such render mode.
        """
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ValueError(f"render_mode: {render_mode!r}; use 'rgb_array' or None")
        self.render_mode = render_mode
        self._reward, self._episode = reward, -1
        self._bodies = Bodies(config.load(task, settings), 1, watched=render_mode is not None)
        if (rate := self._bodies.habitat.rate) is not None:
            self.metadata = {**self.metadata, "render_fps": rate}
        self.observation_space = observation_space(self._bodies)
        self.action_space = action_space(self._bodies)
        self._alive = np.zeros(1, bool)
        self._action: np.ndarray | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin a life, determined by the seed and the number of lives since the seed was given.

        `options` may have `tick` and `cell`. With the seed of a run's world, the body is that of
        the organism born at this tick in this cell.

        Raises:
            ValueError: an option is unknown, or not a whole number from 0 to 2^31 - 1.
        """
        born = options or {}
        for name, value in born.items():
            whole = isinstance(value, int | np.integer) and 0 <= value < 2**31
            if name not in ("tick", "cell") or not whole:
                says = "give whole numbers as tick and cell"
                raise ValueError(f"options: {name} = {value!r}; {says}")
        super().reset(seed=seed)
        self._episode = 0 if seed is not None else self._episode + 1
        place = born.get("tick", self._episode), born.get("cell", 0)
        seeds = np.array([(self.np_random_seed or 0) % 2**64], np.uint64)
        self._bodies.begin(FIRST, Births(seeds, *(np.array([each]) for each in place)))
        self._alive[:] = True
        self._action = zeros(self._bodies.habitat.action)
        return self._bodies.senses[0].copy(), self._info(-1)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Live one tick.

        Raises:
            ResetNeeded: no life has begun, or the body has died.
            ValueError: there is no such action.
        """
        if not self._alive[0]:
            raise ResetNeeded("there is no life to go on with: call reset first")
        kind = self._bodies.habitat.action
        one = [[part] for part in action] if isinstance(kind, Compound) else [action]
        self._action = as_rows(one, kind, 1)
        cause = int(self._bodies.step(self._action, self._alive)[0])
        self._alive[0] = not (died := cause >= 0)
        senses = self._bodies.senses[0].copy()
        return senses, 0.0 if died else self._reward, died, False, self._info(cause)

    def _info(self, cause: int) -> dict[str, Any]:
        bodies = self._bodies
        info: dict[str, Any] = {"food": float(bodies.food[0])}
        if bodies.energy is not None:
            info["energy"] = float(bodies.energy[0])
        return info | ({"cause": Cause(cause).label} if cause >= 0 else {})

    def render(self) -> np.ndarray | None:
        """Return a picture of the body, uint8 (height, width, 3); None if none can be drawn.

        Raises:
            ResetNeeded: no life has begun.
        """
        if self._action is None:
            raise ResetNeeded("there is no body to see: call reset first")
        habitat = self._bodies.habitat
        if self.render_mode is None or not habitat.can(Ability.PICTURE):
            return None
        body = jax.tree.map(lambda leaf: np.asarray(leaf)[0], habitat.seen())
        return np.asarray(habitat.picture(body, self._action[0]).convert("RGB"))

    def close(self) -> None:
        """Release the body."""
        self._bodies.close()
