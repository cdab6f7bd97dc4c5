"""A process that plays a game when it is told to: what `hosted.py` sets against each other.

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

TASKS = {
    "pong": "Pong-survival",
    "battle_zone": "BattleZone-survival",
    "HalfCheetah-v5": "HalfCheetah-forager",
    "Walker2d-v5": "Walker-survival-forager",
    "Reacher-v5": "Reacher-forager",
}
"""the task that is measured in each game, or with each of Gymnasium's robots"""
ROBOTS = [game for game in TASKS if game.endswith("-v5")]
NO_DEATH: dict[str, dict] = {
    game: {"metabolism": "none", "habitat": {"fatal": ""}}
    if game in ROBOTS
    else {"habitat": {"fatal": "game_over"}}
    for game in TASKS
}
"""settings under which nobody dies but by accident, or when the game is over"""
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


class Batch(Loop):
    """MuJoCo's own batch on all cores with random controls: nothing that plays tick by tick can pass it.

    A walker that falls goes on where it lies.
    """

    def __init__(self, game: str, cells: int) -> None:
        habitat = _described(game)[1]
        habitat.open(cells)
        habitat.reset(np.arange(cells), _words(cells, habitat.words))
        self._bodies, self._substeps = habitat._bodies, habitat.substeps
        noise = np.random.default_rng(0)
        self._controls = noise.uniform(-1, 1, (64, cells, habitat.action.size))
        self._cells, self._number = cells, 0

    def tick(self) -> int:
        """A tick of each."""
        self._number = (self._number + 1) % len(self._controls)
        self._bodies.ctrl[:] = self._controls[self._number]
        self._bodies.step(nstep=self._substeps)
        return self._cells


class Robots(Loop):
    """Gymnasium's vector environments with brains, but no law. Its reacher perceives a number less."""

    def __init__(self, mode: str, game: str, cells: int) -> None:
        try:
            import gymnasium
        except ImportError as error:
            raise Lacking(f"{error.name} is not installed") from None
        habitat = _described(game)[1]
        changed = {"frame_skip": habitat.substeps}
        self._envs = gymnasium.make_vec(
            game, num_envs=cells, vectorization_mode=mode, disable_env_checker=True, **changed
        )
        self.about = f"gymnasium {version('gymnasium')}, {type(self._envs).__name__}"
        self._cells, self._seen = cells, self._envs.reset(seed=0)[0]
        self._senses = np.zeros((cells, habitat.senses_size), np.float32)
        self._brains, self._size = (
            Brains(game, cells),
            min(habitat.senses_size, self._seen.shape[1]),
        )

    def tick(self) -> int:
        """A tick of each."""
        self._senses[:, : self._size] = self._seen[:, : self._size]
        self._seen = self._envs.step(np.clip(self._brains(self._senses), -1, 1))[0]
        return self._cells


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

        config, habitat, brain = _described(game)
        buttons, seen = list(minimal_actions(game).values()), _seen(habitat)
        hidden, noise = config.brain.hidden, np.random.default_rng(0)
        shapes = ((hidden, len(seen)), (hidden, hidden), (len(buttons), hidden))
        blocks = list(zip(_scales(config, brain), shapes, strict=True))
        self._organisms = [
            Organism(
                [s * noise.standard_normal(b) for s, b in blocks], console(game), buttons, seen
            )
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

        from primordia.motor import Discrete, argmax

        config, habitat, brain = _described(game)
        noise, discrete = np.random.default_rng(0), isinstance(habitat.action, Discrete)
        self._genome = {
            name: jnp.asarray(scale * noise.standard_normal((cells, *shape)), jnp.float32)
            for scale, (name, shape) in zip(
                _scales(config, brain), brain.blocks.items(), strict=True
            )
        }
        self._memory = jnp.zeros((cells, brain.memory), jnp.float32)

        def think(genome: Any, memory: Any, senses: Any) -> tuple:
            memory, output = brain(genome, memory, senses)
            return memory, argmax(output) if discrete else output

        self._think = jax.jit(think)

    def __call__(self, senses: np.ndarray) -> np.ndarray:
        """Float32 (N, S) -> actions, int32 (N,) or float32 (N, A). Memory is kept from game to game."""
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
        self._brains, self._sensed = Brains(game, cells), _sight(game)

    def tick(self) -> int:
        """A frame of each."""
        self._ram = self._envs.step(self._brains(self._sensed(self._ram)))[0]
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
        self._brains, self._sensed = Brains(game, cells), _sight(game)

    def tick(self) -> int:
        """A frame of each."""
        self._ram = self._envs.step(self._brains(self._sensed(self._ram)))[-1]["ram"]
        return self._cells


def _described(game: str) -> tuple:
    """The task's settings, habitat and brain."""
    from primordia.config import load

    config = load(TASKS[game])
    habitat = config.build_habitat()
    return config, habitat, config.build_brain(habitat)


def _sight(game: str) -> Callable[[np.ndarray], np.ndarray]:
    """RAM, uint8 (N, 128) -> what is perceived of it, float32 (N, S)."""
    from primordia.habitats.atari import SCALED

    seen = _seen(_described(game)[1])
    return lambda ram: SCALED.take(ram[:, seen])


def _words(cells: int, each: int) -> np.ndarray:
    """Random words for births."""
    return np.random.default_rng(0).integers(0, 2**32, (cells, each), np.uint32)


def _seen(habitat: Any) -> list[int]:
    """Addresses perceived."""
    return list(habitat.senses or range(128))


def _scales(config: Any, brain: Any) -> list[float]:
    """How far a founder's weights are spread in each block."""
    return config.mutation.of_blocks("founder_scale", list(brain.blocks))


def _pascal(game: str) -> str:
    """How others write a game's name: BattleZone."""
    return game.title().replace("_", "")


def _ours(game: str, cells: int) -> Any:
    from hosted_world import Ours

    return Ours(TASKS[game], cells, NO_DEATH[game])


def _gymnasium(mode: str, game: str, cells: int) -> Loop:
    return (Robots if game in ROBOTS else Gymnasium)(mode, game, cells)


WAYS: dict[str, Callable[[str, int], Any]] = {
    "bare": Bare,
    "ours": _ours,
    "batch": Batch,
    "async": partial(_gymnasium, "async"),
    "sync": partial(_gymnasium, "sync"),
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
