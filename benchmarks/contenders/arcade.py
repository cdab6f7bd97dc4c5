"""Atari games: bare emulators, the published way, Gymnasium's vector environments, EnvPool."""

import os
import random
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

import numpy as np

from contenders.loop import Brains, Lacking, Loop, described, envpool, scales
from primordia import cores

BUTTONS_DRAWN = 10_007
"""random buttons drawn in advance; a prime number, so that no other period divides it"""


class Bare(Loop):
    """One emulator with random buttons: the upper bound for all ways that play frame by frame."""

    FRAMES = 100
    """frames between two readings of the clock"""

    def __init__(self, game: str, cells: int) -> None:
        from primordia.habitats.atari.simulator import RAM, console

        self._ale, self._ram = console(game), np.zeros(RAM, np.uint8)
        self._start = 0
        known = [int(action.value) for action in self._ale.getMinimalActionSet()]
        self._buttons = random.Random(os.getpid()).choices(known, k=BUTTONS_DRAWN)

    def tick(self) -> int:
        """Play some frames and read RAM after each."""
        ale, ram, first = self._ale, self._ram, self._start
        for button in self._buttons[first : first + self.FRAMES]:
            ale.act(button)
            ale.getRAM(ram)
            if ale.game_over():
                ale.reset_game()
        frames = min(self.FRAMES, BUTTONS_DRAWN - first)
        self._start = (first + frames) % BUTTONS_DRAWN
        return frames


class InStep(Loop):
    """Our worker processes with random buttons, no brains and no law.

    It is the upper bound for every law that waits for all frames of a tick before the next tick.
    """

    about = "our workers, random buttons, no brains and no law"

    def __init__(self, game: str, cells: int) -> None:
        habitat = described(game)[1]
        habitat.open(cells)
        self._habitat, self._everyone, self._number = habitat, np.ones(cells, bool), 0
        self._begin(self._everyone)
        choices = np.random.default_rng(0).integers
        self._buttons = choices(habitat.action.size, size=(997, cells), dtype=np.int32)

    def tick(self) -> int:
        """Play a frame in each cell; start a new game when one is over."""
        pool = self._habitat._pool
        self._number = (self._number + 1) % len(self._buttons)
        pool.arrays["action"][:] = self._buttons[self._number]
        pool.step(self._everyone)
        if pool.arrays["game_over"].any():
            self._begin(pool.arrays["game_over"])
        return len(self._everyone)

    def _begin(self, which: np.ndarray) -> None:
        born = np.flatnonzero(which)
        self._habitat.reset(born, np.zeros((len(born), self._habitat.words), np.uint32))


class Organism:
    """A network of NumPy matrices that plays on its own console."""

    def __init__(
        self, weights: list[np.ndarray], ale: Any, buttons: list[int], seen: list[int]
    ) -> None:
        self._weights, self._hidden = weights, np.zeros(len(weights[1]))
        self._ale, self._buttons, self._seen = ale, buttons, seen

    def live(self) -> None:
        """Play one frame; start a new game when one is over."""
        into, recurrent, out = self._weights
        senses = (self._ale.getRAM()[self._seen] - 128.0) / 128.0
        self._hidden = np.tanh(into @ senses + recurrent @ self._hidden)
        self._ale.act(self._buttons[int(np.argmax(out @ self._hidden))])
        if self._ale.game_over():
            self._ale.reset_game()
            self._hidden = np.zeros(len(self._hidden))


class Published(Loop):
    """A first version as it is often written, and as the paper's code is: one object per organism."""

    about = "one Python object an organism, NumPy, one process"

    def __init__(self, game: str, cells: int) -> None:
        from primordia.habitats.atari.games import facts
        from primordia.habitats.atari.simulator import console

        config, habitat, law = described(game)
        buttons, seen = list(facts(game).actions.values()), _seen(habitat)
        hidden, noise = config.brain["hidden"], np.random.default_rng(0)
        shapes = ((hidden, len(seen)), (hidden, hidden), (len(buttons), hidden))
        blocks = list(zip(scales(law), shapes, strict=True))
        self._organisms = [
            Organism(
                [s * noise.standard_normal(b) for s, b in blocks], console(game), buttons, seen
            )
            for _ in range(cells)
        ]

    def tick(self) -> int:
        """Play a frame in each cell."""
        for organism in self._organisms:
            organism.live()
        return len(self._organisms)


class Gymnasium(Loop):
    """Gymnasium's vector environments; the tick in which it resets a game counts as a frame."""

    def __init__(self, mode: str, game: str, cells: int) -> None:
        try:
            import ale_py
            import gymnasium
        except ImportError as error:
            raise Lacking(f"{error.name} is not installed") from None
        ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
        gymnasium.register_envs(ale_py)
        self._envs = gymnasium.make_vec(
            f"ALE/{_pascal(game)}-v5",
            num_envs=cells,
            vectorization_mode=mode,
            obs_type="ram",
            frameskip=1,
            repeat_action_probability=0.0,
            full_action_space=False,
            disable_env_checker=True,
        )
        self.about = f"gymnasium {version('gymnasium')}, {type(self._envs).__name__}"
        self._cells, self._ram = cells, self._envs.reset(seed=0)[0]
        self._brains, self._sensed = Brains(game, cells), _sight(game)

    def tick(self) -> int:
        """Play a frame in each cell."""
        self._ram = self._envs.step(self._brains(self._sensed(self._ram)))[0]
        return self._cells


class Pool(Loop):
    """EnvPool. It always makes a picture of every frame, so pictures are as small as possible."""

    def __init__(self, game: str, cells: int) -> None:
        package = envpool()
        self._envs = package.make_gymnasium(
            f"{_pascal(game)}-v5",
            num_envs=cells,
            num_threads=cores.count(),
            frame_skip=1,
            repeat_action_probability=0.0,
            full_action_space=False,
            noop_max=1,
            use_fire_reset=False,
            max_episode_steps=108_000,
            stack_num=1,
            img_height=8,
            img_width=8,
            use_inter_area_resize=False,
        )
        info = self._envs.reset()[1]
        if "ram" not in info:
            raise Lacking(f"envpool {package.__version__} does not give the console's memory")
        self.about = f"envpool {package.__version__}; also makes a picture of every frame"
        self._cells, self._ram = cells, info["ram"]
        self._brains, self._sensed = Brains(game, cells), _sight(game)

    def tick(self) -> int:
        """Play a frame in each cell."""
        self._ram = self._envs.step(self._brains(self._sensed(self._ram)))[-1]["ram"]
        return self._cells


def _sight(game: str) -> Callable[[np.ndarray], np.ndarray]:
    """Return the function from RAM, uint8 (N, 128), to senses, float32 (N, S)."""
    from primordia.habitats.atari.habitat import SCALED

    seen = _seen(described(game)[1])
    return lambda ram: SCALED.take(ram[:, seen])


def _seen(habitat: Any) -> list[int]:
    """Return the addresses that are perceived."""
    return list(habitat.senses or range(128))


def _pascal(game: str) -> str:
    """Return a game's name as other packages write it, such as BattleZone."""
    return game.title().replace("_", "")
