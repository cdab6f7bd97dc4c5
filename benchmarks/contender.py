"""A process that plays a game when it is told to: what `arcade.py` sets against each other.

    python benchmarks/contender.py WAY GAME CELLS

It says in a line of JSON that it is ready, or what it lacks. Each line it then reads, `play 1.5`, asks
for so many seconds of play; the answer is a line of JSON. It ends with its standard input. JAX is
loaded late, since Gymnasium forks.
"""

import json
import os
import random
import sys
import time
from collections.abc import Callable
from functools import partial
from importlib.metadata import version
from typing import Any

import numpy as np

TASKS = {"pong": "Pong-survival", "battle_zone": "BattleZone-survival"}
"""the task that is measured in each game"""
BUTTONS_DRAWN = 10_007
"""at random, beforehand; a prime, so that they do not fall into step with anything"""


class Lacking(Exception):  # noqa: N818
    """Why a way of playing is not available, in words."""


class Loop:
    """Plays by repeating a tick."""

    about = ""
    """what should be known of this way, in words"""

    def tick(self) -> int:
        """One tick of all cells, or some frames of one -> frames."""
        raise NotImplementedError

    def play(self, seconds: float) -> dict[str, float]:
        """Frames played in about so many seconds."""
        frames, began = 0, time.perf_counter()
        now = began
        while now - began < seconds:
            frames += self.tick()
            now = time.perf_counter()
        return {"frames": frames, "seconds": now - began}


class Bare(Loop):
    """One emulator with random buttons: what nothing that plays frame by frame can pass."""

    FRAMES = 100
    """from one look at the clock to the next"""

    def __init__(self, game: str, cells: int) -> None:
        from primordia.pool.arcade import RAM, console

        self._ale, self._ram = console(game), np.zeros(RAM, np.uint8)
        self._start = 0
        known = [int(action.value) for action in self._ale.getMinimalActionSet()]
        self._buttons = random.Random(os.getpid()).choices(known, k=BUTTONS_DRAWN)

    def tick(self) -> int:
        """Some frames, RAM read after each."""
        ale, ram, first = self._ale, self._ram, self._start
        for button in self._buttons[first : first + self.FRAMES]:
            ale.act(button)
            ale.getRAM(ram)
            if ale.game_over():
                ale.reset_game()
        frames = min(self.FRAMES, BUTTONS_DRAWN - first)
        self._start = (first + frames) % BUTTONS_DRAWN
        return frames


class Organism:
    """A network of NumPy matrices that plays on a console of its own."""

    def __init__(
        self, weights: list[np.ndarray], ale: Any, buttons: list[int], seen: list[int]
    ) -> None:
        self._weights, self._hidden = weights, np.zeros(len(weights[1]))
        self._ale, self._buttons, self._seen = ale, buttons, seen

    def live(self) -> None:
        """One frame; a new game when it is over."""
        into, recurrent, out = self._weights
        senses = (self._ale.getRAM()[self._seen] - 128.0) / 128.0
        self._hidden = np.tanh(into @ senses + recurrent @ self._hidden)
        self._ale.act(self._buttons[int(np.argmax(out @ self._hidden))])
        if self._ale.game_over():
            self._ale.reset_game()
            self._hidden = np.zeros(len(self._hidden))


class Published(Loop):
    """As one writes it first, and as the paper's code is organised: one object an organism."""

    about = "one Python object an organism, NumPy, one process"

    def __init__(self, game: str, cells: int) -> None:
        from primordia.habitats.atari_games import minimal_actions
        from primordia.pool.arcade import console

        config, habitat, _ = _described(game)
        buttons, seen = list(minimal_actions(game).values()), _seen(habitat)
        hidden, noise = config.brain.hidden, np.random.default_rng(0)
        shapes = ((hidden, len(seen)), (hidden, hidden), (len(buttons), hidden))
        self._organisms = [
            Organism([_founder(config, noise, s) for s in shapes], console(game), buttons, seen)
            for _ in range(cells)
        ]

    def tick(self) -> int:
        """A frame of each."""
        for organism in self._organisms:
            organism.live()
        return len(self._organisms)


class Brains:
    """Those of as many founders as there are cells, in one compiled call a tick."""

    def __init__(self, game: str, cells: int) -> None:
        import jax
        import jax.numpy as jnp

        from primordia.habitats.atari import SCALED
        from primordia.motor import argmax

        config, habitat, brain = _described(game)
        noise = np.random.default_rng(0)
        self._scaled, self._seen = SCALED, _seen(habitat)
        self._genome = {
            name: jnp.asarray(_founder(config, noise, (cells, *shape)), jnp.float32)
            for name, shape in brain.blocks.items()
        }
        self._memory = jnp.zeros((cells, brain.memory), jnp.float32)

        def think(genome: Any, memory: Any, senses: Any) -> tuple:
            memory, output = brain(genome, memory, senses)
            return memory, argmax(output)

        self._think = jax.jit(think)

    def __call__(self, ram: np.ndarray) -> np.ndarray:
        """RAM, uint8 (N, 128) -> actions, int32 (N,). Memory is kept from game to game."""
        senses = self._scaled.take(ram[:, self._seen])
        self._memory, action = self._think(self._genome, self._memory, senses)
        return np.asarray(action)


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
        self._brains = Brains(game, cells)

    def tick(self) -> int:
        """A frame of each."""
        self._ram = self._envs.step(self._brains(self._ram))[0]
        return self._cells


class EnvPool(Loop):
    """EnvPool, which cannot leave out a picture a frame: it is made as small as is of use."""

    def __init__(self, game: str, cells: int) -> None:
        try:
            import envpool
        except Exception as error:
            raise Lacking(
                f"import envpool fails ({type(error).__name__}): pip install envpool"
            ) from None
        self._envs = envpool.make_gymnasium(
            f"{_pascal(game)}-v5",
            num_envs=cells,
            num_threads=len(os.sched_getaffinity(0)),
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
        told = self._envs.reset()[1]
        if "ram" not in told:
            raise Lacking(f"envpool {envpool.__version__} does not give the console's memory")
        self.about = f"envpool {envpool.__version__}; makes a picture of every frame besides RAM"
        self._cells, self._ram = cells, told["ram"]
        self._brains = Brains(game, cells)

    def tick(self) -> int:
        """A frame of each."""
        self._ram = self._envs.step(self._brains(self._ram))[-1]["ram"]
        return self._cells


def _described(game: str) -> tuple:
    """The task's settings, habitat and brain."""
    from primordia.config import load

    config = load(TASKS[game])
    habitat = config.build_habitat()
    return config, habitat, config.build_brain(habitat)


def _seen(habitat: Any) -> list[int]:
    """Addresses perceived."""
    return list(habitat.senses or range(128))


def _founder(config: Any, noise: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    """Random weights, spread as the task says."""
    return config.mutation.founder_scale * noise.standard_normal(shape)


def _pascal(game: str) -> str:
    """How others write a game's name: BattleZone."""
    return game.title().replace("_", "")


def _ours(game: str, cells: int) -> Any:
    from arcade_world import Ours

    return Ours(TASKS[game], cells)


WAYS: dict[str, Callable[[str, int], Any]] = {
    "bare": Bare,
    "ours": _ours,
    "async": partial(Gymnasium, "async"),
    "sync": partial(Gymnasium, "sync"),
    "published": Published,
    "envpool": EnvPool,
}


def main() -> None:
    """Make ready, then do as asked until nothing more is."""
    way, game, cells = sys.argv[1:]
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # what libraries print is not an answer
    try:
        player = WAYS[way](game, int(cells))
    except Lacking as lacking:
        print(json.dumps({"not available": str(lacking)}), file=answers)
        return
    player.play(0.5)
    print(json.dumps({"about": player.about}), file=answers)
    for line in sys.stdin:
        asked, seconds = line.split()
        print(json.dumps(getattr(player, asked)(float(seconds))), file=answers)


if __name__ == "__main__":
    main()
