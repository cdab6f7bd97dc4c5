"""Any Gymnasium environment as a habitat (Towers et al. 2024; extra `primordia[gymnasium]`).

Settings define death, food and effort by expressions of the observation, the reward, `terminated`,
`truncated` and `info`. The environment's own time limit is off. Every birth resets an environment
with a seed from the birth's own random word. Environments run in worker processes, or in this
process.
"""

from collections.abc import Callable
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, PrivateAttr, model_validator

from primordia.errors import InputError, Trouble
from primordia.habitats import conditions
from primordia.habitats.conditions import Expression, Names
from primordia.habitats.contract import Ability, Action, HostHabitat, Outcome, Stepped
from primordia.habitats.states import packed, unpacked
from primordia.pool.contract import Pool
from primordia.pool.opening import open_pool
from primordia.settings.base import Settings
from primordia.settings.tables import modules_of

if TYPE_CHECKING:
    from PIL.Image import Image

    from primordia.habitats.gymnasium.probe import Probe
    from primordia.habitats.gymnasium.spaces import Senses

SIMULATOR = "primordia.habitats.gymnasium.simulator"
NOT_INSTALLED = "this needs Gymnasium: pip install 'primordia[gymnasium]'"


class Gymnasium(HostHabitat, Settings):
    """An environment of Gymnasium as a habitat; senses are the observation, flattened and scaled."""

    env: str = Field(min_length=1, description="registered name, or module:NAME")
    options: dict[str, Any] = Field({}, description="keyword arguments of the environment")
    fatal: str = Field(
        "terminated", description='condition that ends a life; "": no condition ends it'
    )
    food: str = Field("0", description="amount gathered in a tick, or module:function")
    effort: str = Field("0", description="amount exerted in a tick")
    time_limit: int | None = Field(None, ge=1, description="ticks after which a life ends")
    scale: tuple[float, ...] = Field(
        (),
        strict=False,
        description="numbers by which observations without bounds are divided: one for each number of the"
        " observation, or one for all (default: 1)",
    )
    squash: bool = Field(
        False, description="true: an observation x without bounds becomes x / (1 + |x|)"
    )
    saving: Literal["snapshot", "replay", "restart"] = Field(
        "replay",
        description="how a life goes on after an interruption. snapshot: from its saved state; replay:"
        " the life is lived again; restart: with a new body. `primordia check` measures what works",
    )
    fresh: bool = Field(False, description="make a new environment for each life; slow")
    faults: int = Field(
        100,
        ge=0,
        description="largest number of deaths by errors in the environment; one more stops the run",
    )
    workers: int | None = Field(
        None,
        ge=0,
        description="number of processes, at most one for each cell; 0: environments in this process;"
        " lives do not depend on it (default: one for each core, 0 if there is one core)",
    )

    _pool: Pool = PrivateAttr()
    _age: np.ndarray = PrivateAttr()
    """ticks lived, int64 (N,)"""
    _failed: int = PrivateAttr(0)

    @staticmethod
    def files_with(file: str) -> list[str]:
        """Return the full paths of a file, and of the files that it needs if it is a model of MuJoCo."""
        from primordia.habitats.mujoco.simulator import needed_files

        return needed_files(file) if file.endswith(".xml") else [file]

    @model_validator(mode="after")
    def _check_settings(self) -> "Gymnasium":
        assert self._conditions
        if self._food_function:
            from primordia.habitats.gymnasium.probe import check_food

            check_food(self.env, self.options, self._food_function)
        count = self._probe.observation.width
        if len(self.scale) not in (0, 1, count) or any(each <= 0 for each in self.scale):
            raise ValueError(f"scale: give 1 number or {count} numbers, all above 0")
        return self

    @cached_property
    def _probe(self) -> "Probe":
        try:
            from primordia.habitats.gymnasium.probe import probe
        except ImportError:
            raise ValueError(NOT_INSTALLED) from None
        return probe(self.env, self.options)

    @cached_property
    def _conditions(self) -> dict[str, Expression]:
        texts = {"effort": self.effort} | ({"fatal": self.fatal} if self.fatal else {})
        texts |= {} if self._food_function else {"food": self.food}
        return {
            name: conditions.parse(text, "condition" if name == "fatal" else "amount", self._names)
            for name, text in texts.items()
        }

    @property
    def _food_function(self) -> str:
        """The function that measures food, or ""."""
        module, colon, function = self.food.partition(":")
        dotted = all(each.isidentifier() for each in (*module.split("."), function))
        return self.food if colon and dotted else ""

    @cached_property
    def _names(self) -> Names:
        return {
            "obs": self._probe.observation.width,
            "reward": "amount",
            "terminated": "condition",
            "truncated": "condition",
            "info": {key: width or "amount" for key, width in self._info.items()},
        }

    @cached_property
    def _info(self) -> dict[str, int]:
        """The keys of `info` that settings name, with their numbers of values; 0 is a single number."""
        from primordia.habitats.gymnasium.probe import info_of

        texts = f"{self.fatal} {self.food} {self.effort}"
        if "info" not in texts:
            return {}
        known = info_of(self.env, self.options)
        used = {key: width for key, width in known.items() if key in texts}
        return used or known

    @property
    def senses_size(self) -> int:
        """Number of senses."""
        return self._senses.size

    @cached_property
    def _senses(self) -> "Senses":
        count = self._probe.observation.width
        scale = np.broadcast_to(np.array(self.scale or (1.0,)), count)
        return self._probe.observation.senses(scale, self.squash)

    @property
    def action(self) -> Action:
        """The environment's action, with one part for each part of the environment's action space."""
        return self._probe.acting.kind

    words: ClassVar = 1

    @property
    def rate(self) -> float | None:
        """Ticks a second, if the environment states them."""
        return self._probe.rate

    @property
    def episode(self) -> int | None:
        """The environment's registered time limit, at which an evaluation ends a game."""
        return self._probe.limit

    @cached_property
    def versions(self) -> dict[str, str]:
        """Versions of the packages that the environment comes from."""
        from primordia.habitats.gymnasium.environment import versions

        return versions(self.env) if self._probe else {}

    def lacks(self, ability: Ability) -> list[str]:
        """Return the methods that are lacking for an ability."""
        if ability is Ability.PICTURE and not self._probe.pictures:
            return ["picture"]
        if ability is Ability.SAVE and self.saving == "restart":
            return ["save", "load"]
        return super().lacks(ability)

    def original(self) -> "Gymnasium":
        """Return the game that the benchmark scores: the reward is food, and a game's end is fatal."""
        own = {
            "fatal": "terminated or truncated",
            "food": "reward",
            "effort": "0",
            "time_limit": None,
        }
        return Gymnasium(**{**self.model_dump(), **own})

    def open(self, cells: int, watched: bool = False) -> None:
        """Make the environments.

        Raises:
            InputError: the environments are watched, but cannot draw.
        """
        from primordia.habitats.gymnasium.probe import screen_shape
        from primordia.habitats.gymnasium.simulator import SCREEN, fields

        shared = fields(self._probe.observation, self._probe.acting, self._info)
        settings = self.model_dump(include={"env", "options", "saving", "fresh"})
        settings |= {
            "food": self._food_function,
            "info": {k: max(n, 1) for k, n in self._info.items()},
        }
        if watched:
            try:
                shape = screen_shape(self.env, self.options)
            except ValueError as error:
                raise InputError(f"habitat: {error}") from None
            shared[SCREEN] = ("uint8", shape)
        own = modules_of(self.model_dump(), "env")
        simulator = f"{SIMULATOR}:Environments"
        self._pool = open_pool(simulator, settings, shared, cells, self.workers, own)
        self._age = np.zeros(cells, np.int64)

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Begin a life in each of the cells."""
        arrays, todo = self._pool.arrays, np.zeros(len(self._age), bool)
        todo[cells] = True
        arrays["seed"][cells] = words[:, 0]
        self._pool.reset(todo)
        self._age[cells] = 0
        return self._senses(arrays["obs"][cells])

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the environments of the living by one tick."""
        return self.begin(action, alive)()

    def begin(self, action: np.ndarray, alive: np.ndarray) -> Callable[[], Stepped]:
        """Let the environments begin; see `HostHabitat.begin`."""
        self._pool.arrays["action"][:] = self._probe.acting.rows(action)
        self._pool.begin(alive)
        return partial(self._finish, alive)

    def _finish(self, alive: np.ndarray) -> Stepped:
        arrays = self._pool.arrays
        self._pool.finish()
        self._age += alive
        names = ("obs", "reward", "terminated", "truncated")
        values = {name: arrays[name] for name in names} | {"info": self._of_info(arrays["info"])}
        fault: Any = arrays["fault"] & alive
        if fault.any():
            self._count_faults(fault)
        expired: Any = arrays["truncated"] | (self._age >= (self.time_limit or 2**62))
        measured = self._measured(values)
        for each in measured.values():
            each[fault] = 0  # since the observation is still that of the tick before
        outcome = Outcome(**measured, expired=expired, fault=fault)
        return self._senses(arrays["obs"]), outcome

    def _measured(self, values: dict[str, Any]) -> dict[str, Any]:
        """Return fatal (bool), food and effort (float32) of all cells, (N,) each."""
        count = len(self._age)
        measured = {
            name: each.of_all(values, count, bool if name == "fatal" else np.float32)
            for name, each in self._conditions.items()
        }
        none = {
            "fatal": np.zeros(count, bool),
            "food": self._pool.arrays["food"].astype(np.float32),
        }
        return none | measured

    def _of_info(self, columns: np.ndarray) -> dict[str, np.ndarray]:
        """Return the values of `info` by key, (N,) or (N, K)."""
        values, place = {}, 0
        for key, width in self._info.items():
            values[key] = columns[:, place : place + width] if width else columns[:, place]
            place += max(width, 1)
        return values

    def _count_faults(self, fault: np.ndarray) -> None:
        """Count errors in the environments, and stop the run if there are too many.

        Raises:
            Trouble: there are too many errors; the message has the latest error.
        """
        self._failed += int(fault.sum())
        if self._failed > self.faults:
            last = self.message(int(np.flatnonzero(fault)[-1]))
            raise Trouble(
                f"{self._failed} organisms died of errors in {self.env}, the last error: {last}."
                " Mend the environment, or raise habitat.faults"
            )

    def message(self, cell: int) -> str:
        """Return the last line of the error in a cell's environment."""
        arrays = self._pool.arrays
        text = arrays["message"][cell].tobytes() if arrays["fault"][cell] else b""
        return text.rstrip(b"\0").decode(errors="replace")

    def seen(self) -> dict[str, np.ndarray]:
        """Return the observation, the reward, and the screen if it is watched."""
        arrays = self._pool.arrays
        return {name: arrays[name] for name in ("obs", "reward", "screen") if name in arrays}

    def picture(self, body: dict[str, np.ndarray], action: np.ndarray) -> "Image":
        """Return the environment's own picture, with a margin for captions above."""
        from PIL import Image

        from primordia.habitats.framed import framed

        return framed(Image.fromarray(body["screen"]))

    def caption(self, body: dict[str, np.ndarray], action: np.ndarray) -> str:
        """Return the action and the reward of the tick."""
        return f"{super().caption(body, action)}   reward {float(body['reward']):.2f}"

    def close(self) -> None:
        """Close the environments."""
        self._pool.close()

    def save(self) -> dict[str, np.ndarray]:
        """Return the states of the environments (`states.packed`), and ages."""
        return {**packed(self._pool.save()), "age": self._age.copy()}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore the states that `save` returned."""
        self._pool.load(unpacked(arrays))
        self._age[:] = arrays["age"]
