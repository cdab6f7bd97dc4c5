"""Any Atari game as a habitat, sensed through the console's memory.

Schmidgall & Hays 2021, "Atari": RAM as senses, one frame a tick, the game's minimal action set, no sticky
actions. Settings define death and food by expressions of RAM, points and lives. The emulator is the
Arcade Learning Environment (extra `primordia[atari]`).
"""

from collections.abc import Callable
from functools import cached_property, partial
from importlib.metadata import version
from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import Field, PrivateAttr, model_validator

from primordia.habitats import conditions
from primordia.habitats.atari.games import facts, legal_actions
from primordia.habitats.atari.simulator import FIELDS, RAM, SCREEN
from primordia.habitats.conditions import Expression, Names
from primordia.habitats.contract import Discrete, HostHabitat, Outcome, Stepped
from primordia.habitats.states import packed, unpacked
from primordia.pool.contract import Pool
from primordia.pool.opening import open_pool
from primordia.settings.base import Settings

if TYPE_CHECKING:
    from PIL.Image import Image

NAMES: Names = {
    "ram": RAM,
    "points": "amount",
    "lives": "amount",
    "lives_lost": "amount",
    "game_over": "condition",
}
"""Names in conditions and amounts: RAM and lives after the tick; points and lost lives of the tick."""
SCALED = (np.arange(256, dtype=np.float32) - 128) / 128
"""The number perceived for each value of a byte."""
PIXEL = (4, 2)
"""width and height of a pixel of the console in a picture: pixels are wide, as on a television"""
FRAME_RATE = 60
"""frames a second"""


class Atari(HostHabitat, Settings):
    """An Atari game as a habitat: senses are bytes of RAM, (byte - 128) / 128."""

    game: str = Field(description="the game's name, such as pong or space_invaders")
    senses: tuple[Annotated[int, Field(ge=0, lt=RAM)], ...] = Field(
        (),
        strict=False,
        description="addresses of RAM that organisms perceive (default: all)",
    )
    blind: bool = Field(False, description="true: senses are constant (a control)")
    fatal: str = Field("game_over", description="condition that ends a life")
    food: str = Field("0", description="amount gathered in a tick")
    actions: str = Field(
        "minimal", description="minimal, full, or names separated by spaces, such as NOOP UPFIRE"
    )
    frame_skip: int = Field(1, ge=1, le=100, description="frames in a tick")
    sticky: float = Field(
        0.0, ge=0, lt=1, description="probability that a frame repeats the last button"
    )
    noops: int = Field(
        0, ge=0, le=10_000, description="largest number of random no-ops before a life begins"
    )
    mode: int | None = Field(None, ge=0, description="the game's mode")
    difficulty: int | None = Field(None, ge=0, description="the game's difficulty")
    workers: int | None = Field(
        None,
        ge=0,
        description="number of emulator processes, at most one for each cell; 0: emulators in this"
        " process; lives do not depend on it (default: one for each core, 0 if there is one core)",
    )

    _pool: Pool = PrivateAttr()
    _tally: np.ndarray = PrivateAttr()
    """int32 (N, 3)"""
    _lives: np.ndarray = PrivateAttr()
    """lives left after the latest tick, (N,), a view of the tally"""

    @model_validator(mode="after")
    def _check_game(self) -> "Atari":
        known = facts(self.game).actions
        if unknown := [name for name in self._action_names if name not in legal_actions()]:
            raise ValueError(
                f"actions: there is no {', '.join(unknown)}; {self.game} takes {', '.join(known)}"
            )
        for option in ("mode", "difficulty"):
            value, available = getattr(self, option), facts(self.game).options[option]
            if value is not None and value not in available:
                raise ValueError(f"{option}: {self.game} has {available}, not {value}")
        assert self._fatal_condition
        assert self._food_amount
        return self

    @cached_property
    def _fatal_condition(self) -> Expression:
        return conditions.parse(self.fatal, "condition", NAMES)

    @cached_property
    def _food_amount(self) -> Expression:
        return conditions.parse(self.food, "amount", NAMES)

    @property
    def versions(self) -> dict[str, str]:
        """Version of the emulator, whose package contains the games."""
        return {"ale-py": version("ale-py")}

    @property
    def senses_size(self) -> int:
        """Number of bytes perceived."""
        return len(self._addresses)

    @cached_property
    def _addresses(self) -> np.ndarray:
        return np.array(self.senses or range(RAM))

    @property
    def _action_names(self) -> list[str]:
        """Names of the actions, in order."""
        if self.actions in ("minimal", "full"):
            known = facts(self.game).actions if self.actions == "minimal" else legal_actions()
            return list(known)
        return self.actions.split()

    @cached_property
    def _buttons(self) -> list[int]:
        """Codes of the actions."""
        return [legal_actions()[name] for name in self._action_names]

    @property
    def action(self) -> Discrete:
        """A choice among the buttons."""
        return Discrete(len(self._buttons))

    @property
    def buttons(self) -> tuple[str, ...]:
        """Names of the buttons, in order, such as noop and upfire."""
        return tuple(name.lower() for name in self._action_names)

    @property
    def words(self) -> int:
        """Number of random words for no-ops and sticky actions; 0 if the settings have neither."""
        return 2 if self.noops or self.sticky else 0

    @property
    def tallies(self) -> tuple[str, ...]:
        """Names of the counts that are kept only for people to read."""
        return "score", "kills", "lives"

    @property
    def rate(self) -> float:
        """Ticks a second."""
        return FRAME_RATE / self.frame_skip

    def open(self, cells: int, watched: bool = False) -> None:
        """Make the emulators, with screens if they are watched."""
        screen = {SCREEN: ("uint8", (*facts(self.game).screen, 3))} if watched else {}
        settings = {
            **self.model_dump(
                include={"game", "mode", "difficulty", "frame_skip", "sticky", "noops"}
            ),
            "actions": self._buttons,
        }
        kind = "simulator:Arcade" if self.sticky or watched else "tree:TreeArcade"
        self._pool = open_pool(
            f"primordia.habitats.atari.{kind}",
            settings,
            FIELDS | screen,
            cells,
            self.workers,
        )
        self._tally = np.zeros((cells, len(self.tallies)), np.int32)
        self._lives = self._tally[:, 2]

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Start a game in each of the cells."""
        pool, todo = self._pool, np.zeros(len(self._lives), bool)
        todo[cells] = True
        pool.arrays["words"][cells, : self.words] = words
        pool.reset(todo)
        self._tally[cells] = 0
        self._lives[cells] = pool.arrays["lives"][cells]
        return self._compute_senses()[cells]

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the games of the living by one tick."""
        return self.begin(action, alive)()

    def begin(self, action: np.ndarray, alive: np.ndarray) -> Callable[[], Stepped]:
        """Let the emulators begin; see `HostHabitat.begin`."""
        self._pool.arrays["action"][:] = action
        self._pool.begin(alive)
        return partial(self._finish, alive)

    def _finish(self, alive: np.ndarray) -> Stepped:
        pool, lives = self._pool, self._lives
        pool.finish()
        values = {name: pool.arrays[name] for name in ("ram", "points", "lives", "game_over")}
        values["lives_lost"] = np.maximum(lives - values["lives"], 0)
        lives[:] = values["lives"]
        if values["points"].any():
            self._count(values["points"], alive)
        fatal = self._fatal_condition.of_all(values, len(lives), bool)
        food = self._food_amount.of_all(values, len(lives), np.float32)
        return self._compute_senses(), Outcome(fatal, food)

    def _count(self, points: np.ndarray, alive: np.ndarray) -> None:
        """Tally the points (N,) of a tick; points of the opponent are negative."""
        points = points.astype(np.int32) * alive
        self._tally[:, 0] += points
        self._tally[:, 1] += points > 0

    def tally(self) -> np.ndarray:
        """Return score, kills (ticks in which points were made) and lives left, int32 (N, 3)."""
        return self._tally

    def original(self) -> "Atari":
        """Return a habitat for the whole game as the benchmark scores it: points are food."""
        return Atari(**{**self.model_dump(), "fatal": "game_over", "food": "points"})

    def seen(self) -> dict[str, np.ndarray]:
        """Return RAM, tally, and the screen if it is watched, uint8 (N, height, width, 3)."""
        arrays = self._pool.arrays
        shown = {name: arrays[name] for name in ("ram", SCREEN) if name in arrays}
        return {**shown, "tally": self._tally}

    def picture(self, body: dict[str, np.ndarray], action: np.ndarray) -> "Image":
        """Return the screen, with a margin for captions above."""
        from PIL import Image

        from primordia.habitats.framed import framed

        height, width = body[SCREEN].shape[:2]
        size = width * PIXEL[0], height * PIXEL[1]
        return framed(Image.fromarray(body[SCREEN]).resize(size, Image.Resampling.NEAREST))

    def caption(self, body: dict[str, np.ndarray], action: np.ndarray) -> str:
        """Return the score so far, and the button."""
        return f"score {body['tally'][0]:,}   {self._action_names[int(action)]}"

    def close(self) -> None:
        """Stop the emulators."""
        self._pool.close()

    def _compute_senses(self) -> np.ndarray:
        """Return the senses of all cells, float32 (N, S)."""
        if self.blind:
            return np.ones((len(self._lives), self.senses_size), np.float32)
        ram = self._pool.arrays["ram"]
        return SCALED.take(ram[:, self._addresses] if self.senses else ram)

    def save(self) -> dict[str, np.ndarray]:
        """Return the serialised states (`states.packed`), and the tally."""
        return {**packed(self._pool.save()), "tally": self._tally.copy()}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore the states that `save` returned."""
        self._pool.load(unpacked(arrays))
        self._tally[:] = arrays["tally"]
