"""N bodies of a task as a Gymnasium vector environment: one call steps them all."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from primordia import config
from primordia.envs.bodies import Births, Bodies, action_space, as_rows, observation_space
from primordia.law.world import Cause


class LifeVectorEnv(VectorEnv):
    """N lives in one of Primordia's tasks; all values equal those of N `LifeEnv` environments.

    Life number n of body i is determined by n and the body's seed. See `LifeEnv` for
    observations and `info`.
    """

    def __init__(
        self,
        task: str | Path,
        num_envs: int = 1,
        settings: dict[str, Any] | None = None,
        reward: float = 0.0,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        render_mode: None = None,
    ) -> None:
        """Make the bodies.

        Args:
            task: name of a task, or a file, as for `primordia run`.
            num_envs: number N of bodies.
            settings: settings that differ from those of the task, as nested tables.
            reward: the reward of each tick that is lived; the reward of the tick of death is 0.
            autoreset_mode: with NEXT_STEP, the step after a death begins the next life. With DISABLED,
                only `reset` begins a life; `options={"reset_mask": mask}` names the bodies, bool (N,).
            render_mode: None; a vector environment draws nothing.

        Raises:
            InputError: there is no such task, or a setting is wrong.
            ValueError: the autoreset mode is SAME_STEP, which loses the last observation of a life; or
                `num_envs` is not a whole number from 1 to 2^24.
        """
        if type(num_envs) is not int or not 1 <= num_envs <= 2**24:
            raise ValueError(f"num_envs: {num_envs!r} is not a whole number from 1 to 2^24")
        mode = AutoresetMode(autoreset_mode)
        if mode is AutoresetMode.SAME_STEP:
            raise ValueError("autoreset_mode: use NEXT_STEP or DISABLED")
        self.num_envs, self.render_mode, self._reward = num_envs, render_mode, reward
        self.metadata = {"autoreset_mode": mode}
        self._bodies = Bodies(config.load(task, settings), num_envs)
        self.single_observation_space = observation_space(self._bodies)
        self.single_action_space = action_space(self._bodies)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._seeds, self._lives = np.zeros(num_envs, np.uint64), np.zeros(num_envs, np.int64)
        self._alive, self._begun = np.zeros(num_envs, bool), False

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin lives in all bodies, or in those of `options["reset_mask"]`, bool (N,).

        With a single seed s, body i gets the seed s + i.

        Raises:
            ValueError: there is not one seed, or one value of the mask, for each body.
        """
        chosen = np.asarray((options or {}).get("reset_mask", np.ones(self.num_envs, bool)), bool)
        first = self._seeds_of(seed)
        if chosen.shape != (self.num_envs,) or len(first) != self.num_envs:
            raise ValueError(
                f"give one seed and one value of reset_mask for each of {self.num_envs} bodies"
            )
        for cell, own in enumerate(first):
            if own is not None and (chosen[cell] or not self._begun):
                self._seeds[cell], self._lives[cell] = int(own) % 2**64, -1
        self._begun = True
        self._lives[chosen] += 1
        self._begin(chosen)
        return self._bodies.senses.copy(), self._info(np.full(self.num_envs, -1))

    def _seeds_of(self, seed: int | Sequence[int | None] | None) -> list[int | None]:
        """Return the new seed of each body; None: it keeps its own. Before the first life, bodies
        without a given seed get random ones."""
        if isinstance(seed, int | np.integer):
            self._np_random_seed = int(seed)
            return [int(seed) + cell for cell in range(self.num_envs)]
        given: list[int | None] = [None] * self.num_envs if seed is None else list(seed)
        if self._begun:
            return given
        first = self.np_random_seed or 0
        return [first + cell if own is None else own for cell, own in enumerate(given)]

    def _begin(self, chosen: np.ndarray) -> None:
        cells = np.flatnonzero(chosen)
        births = Births(self._seeds[cells], self._lives[cells], np.zeros(len(cells), np.int32))
        self._bodies.begin(cells, births)
        self._alive[chosen] = True

    def step(
        self, actions: Any
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Live one tick in the living bodies; with NEXT_STEP the other bodies begin a life.

        Raises:
            ResetNeeded: `reset` was not called.
            ValueError: there is no such action, or not one action for each body.
        """
        if not self._begun:
            raise ResetNeeded("no life has begun: call reset first")
        alive = self._alive.copy()
        rows = as_rows(actions, self._bodies.habitat.action, self.num_envs)
        cause = self._bodies.step(rows, alive)
        died = cause >= 0
        self._alive &= ~died
        if self.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP and not alive.all():
            self._lives[~alive] += 1
            self._begin(~alive)
        else:
            died = ~self._alive
        rewards = np.where(alive & ~died, self._reward, 0.0)
        return self._bodies.senses.copy(), rewards, died, np.zeros_like(died), self._info(cause)

    def _info(self, cause: np.ndarray) -> dict[str, Any]:
        bodies, every = self._bodies, np.ones(self.num_envs, bool)
        info: dict[str, Any] = {"food": bodies.food.copy(), "_food": every}
        if bodies.energy is not None:
            info |= {"energy": bodies.energy.copy(), "_energy": every}
        if (died := cause >= 0).any():
            words = np.array([Cause(each).label if each >= 0 else None for each in cause], object)
            info |= {"cause": words, "_cause": died}
        return info

    def close_extras(self, **kwargs: Any) -> None:
        """Release the bodies."""
        self._bodies.close()
