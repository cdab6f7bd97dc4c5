"""Environments of some cells, in one process. A life begins with a reset seeded from the birth's word.

A saved state is restored in one of two ways (`saving`). `snapshot`: the environment's attributes
are saved as plain data. `replay`: the seed and the actions are saved, and the life is lived again.
The life must end in the same observation.
"""

import json
from contextlib import suppress
from typing import Any

import numpy as np
from gymnasium import Env

from primordia.errors import Trouble
from primordia.habitats.gymnasium import environment, state
from primordia.habitats.gymnasium.spaces import Acting, Observation
from primordia.habitats.silence import quiet

MESSAGE = 240
"""bytes of the line that says why an environment failed"""
SCREEN = "screen"
"""An optional field, uint8 (height, width, 3), which is filled after each tick."""


def fields(observation: Observation, acting: Acting, info: dict[str, int]) -> dict[str, Any]:
    """Return dtype and shape of the arrays that environments and the run share, for one cell."""
    return {
        "seed": ("uint32", ()),
        "action": ("float64", (acting.columns,)),
        "obs": (observation.dtype, (observation.width,)),
        "reward": ("float64", ()),
        "food": ("float64", ()),
        "terminated": ("bool", ()),
        "truncated": ("bool", ()),
        "fault": ("bool", ()),
        "message": ("uint8", (MESSAGE,)),
        "info": ("float64", (max(sum(info.values()), 1),)),
    }


class _Life:
    """An environment, and the course of the present life in it."""

    def __init__(self, env: Env) -> None:
        self.env = env
        self.seed: int | None = None
        self.actions: list[bytes] = []
        self.failed: str | None = None


class Environments:
    """The environments of some cells."""

    def __init__(
        self,
        arrays: dict[str, np.ndarray],
        env: str,
        options: dict[str, Any],
        saving: str,
        fresh: bool,
        food: str,
        info: dict[str, int],
    ) -> None:
        self._arrays, self._saving, self._fresh, self._info = arrays, saving, fresh, info
        self._making = env, options, SCREEN in arrays
        self._lives: dict[int, _Life] = {}
        self._food = environment.food_function(food) if food else None

    def make(self, cell: int) -> None:
        """Make an environment for another cell."""
        env = environment.make(*self._making)
        self._observation = Observation(env.observation_space)
        self._acting = Acting(env.action_space)
        self._lives[cell] = _Life(env)

    def reset(self, cell: int) -> None:
        """Begin a new life. If the environment fails here, the first tick reports the fault."""
        with quiet():
            self._begin(cell, int(self._arrays["seed"][cell]) >> 1)

    def step(self, cells: list[int]) -> None:
        """Step the environments of cells by one tick."""
        with quiet():
            for cell in cells:
                self._act(cell, self._arrays["action"][cell])

    def _begin(self, cell: int, seed: int) -> None:
        life = self._lives[cell]
        if life.failed is not None or (self._fresh and life.seed is not None):
            with suppress(Exception):  # a failed environment may also fail to close
                life.env.close()
            life.env = environment.make(*self._making)
        life.seed, life.actions, life.failed = seed, [], None
        self._clear(cell)
        try:
            observation, info = life.env.reset(seed=seed)
            self._tell(cell, observation, info)
        except (Exception, SystemExit) as error:  # games may leave by sys.exit
            self._arrays["obs"][cell] = 0
            life.failed = environment.line(error)

    def _clear(self, cell: int) -> None:
        """Erase the results of the last tick, except for the observation."""
        for name in ("reward", "food", "terminated", "truncated", "fault", "info"):
            self._arrays[name][cell] = 0

    def _act(self, cell: int, row: np.ndarray) -> None:
        life, arrays = self._lives[cell], self._arrays
        if life.failed is not None:  # the life could not begin
            self._fail(cell, life.failed)
            return
        if self._saving == "replay":
            life.actions.append(row.tobytes())
        try:
            action = self._acting.build(row)
            observation, reward, terminated, truncated, info = life.env.step(action)
            arrays["reward"][cell] = reward
            arrays["terminated"][cell], arrays["truncated"][cell] = terminated, truncated
            if self._food is not None:
                given = (observation, reward, terminated, truncated, info)
                arrays["food"][cell] = self._food(*given)
            self._tell(cell, observation, info)
        except (Exception, SystemExit) as error:  # games may leave by sys.exit
            self._fail(cell, environment.line(error))

    def _tell(self, cell: int, observation: Any, info: dict[str, Any]) -> None:
        """Store the observation and the needed numbers of `info`; a missing number is 0."""
        self._observation.fill(self._arrays["obs"][cell], observation)
        place = 0
        for key, width in self._info.items():
            own = slice(place, place + width)
            self._arrays["info"][cell, own] = np.ravel(info.get(key, 0.0))
            place += width
        if SCREEN in self._arrays:
            self._arrays[SCREEN][cell] = self._lives[cell].env.render()

    def _fail(self, cell: int, message: str) -> None:
        """Report a fault, and no results; the next life in the cell gets a new environment."""
        self._lives[cell].failed = message
        self._clear(cell)
        text = message.encode()[:MESSAGE]
        self._arrays["fault"][cell] = True
        self._arrays["message"][cell] = 0
        self._arrays["message"][cell, : len(text)] = np.frombuffer(text, np.uint8)

    def save(self, cell: int) -> bytes:
        """Return the present state in saved form; before a life or after a failure, seed and error."""
        life = self._lives[cell]
        if life.seed is None or life.failed is not None:
            return json.dumps({"seed": life.seed, "failed": life.failed}).encode()
        if self._saving == "snapshot":
            return b"s" + state.encode(life.env)
        observed = self._arrays["obs"][cell].tobytes()
        head = json.dumps({"seed": life.seed, "ticks": len(life.actions)}).encode()
        return b"\n".join([b"r" + head, observed + b"".join(life.actions)])

    def load(self, cell: int, saved: bytes) -> None:
        """Restore a state that `save` returned.

        Raises:
            Trouble: a life did not repeat.
        """
        with quiet():
            self._load(cell, saved)

    def _load(self, cell: int, saved: bytes) -> None:
        life, kind = self._lives[cell], saved[:1]
        if kind == b"{":
            stored = json.loads(saved)
            life.seed, life.failed = stored["seed"], stored["failed"]
        elif kind == b"s":
            self._begin(cell, 1)
            state.decode(life.env, saved[1:])
        else:
            head, _, rest = saved[1:].partition(b"\n")
            self._live_again(cell, json.loads(head), rest)

    def _live_again(self, cell: int, head: dict[str, int], rest: bytes) -> None:
        row, observed = self._arrays["action"][cell], self._arrays["obs"][cell]
        before, actions = rest[: observed.nbytes], rest[observed.nbytes :]
        self._begin(cell, head["seed"])
        for tick in range(head["ticks"]):
            one = actions[tick * row.nbytes : (tick + 1) * row.nbytes]
            self._act(cell, np.frombuffer(one, row.dtype))
        if observed.tobytes() != before:
            raise Trouble(
                f"the environment of cell {cell} did not repeat its life of {head['ticks']} ticks,"
                " since it depends on more than seed and actions; begin a new run with"
                " --habitat.saving restart"
            )
