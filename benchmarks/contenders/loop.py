"""Tasks, a loop and brains, shared by all ways of playing."""

import time
from importlib import import_module
from typing import Any

import numpy as np

TASKS = {
    "pong": "Pong-survival",
    "battle_zone": "BattleZone-survival",
    "HalfCheetah-v5": "HalfCheetah-forager",
    "Walker2d-v5": "Walker-survival-forager",
    "Reacher-v5": "Reacher-forager",
    "CartPole-v1": "gym:CartPole-v1",
    "Acrobot-v1": "gym:Acrobot-v1",
}
"""the task that is measured, by game or by Gymnasium's name of a robot or another environment"""
ROBOTS = [game for game in TASKS if game.endswith("-v5")]
ENVIRONMENTS = [game for game, task in TASKS.items() if task.startswith("gym:")]
NO_DEATH: dict[str, dict] = {
    game: {"metabolism": "none", "habitat": {"fatal": ""}}
    if game in ROBOTS
    else {}
    if game in ENVIRONMENTS
    else {"habitat": {"fatal": "game_over", "sticky": 0.25}}
    for game in TASKS
}
"""settings under which organisms die only by accident, or when the game is over

Buttons are sticky, since otherwise no course of a game is emulated twice."""


class Lacking(Exception):  # noqa: N818
    """A way of playing is not available; the message says why."""


class Loop:
    """A way of playing that repeats a tick."""

    about = ""
    """remarks about this way, for readers"""

    def tick(self) -> int:
        """Play one tick of all cells, or some frames of one cell, and return the frames."""
        raise NotImplementedError

    def play(self, seconds: float) -> dict[str, float]:
        """Play for about `seconds` and return frames and seconds."""
        frames, began = 0, time.perf_counter()
        now = began
        while now - began < seconds:
            frames += self.tick()
            now = time.perf_counter()
        return {"frames": frames, "seconds": now - began}


def envpool() -> Any:
    """Import EnvPool and return it.

    Raises:
        Lacking: it cannot be imported.
    """
    try:
        return import_module("envpool")
    except Exception as error:
        name = type(error).__name__
        raise Lacking(f"import envpool fails ({name}): pip install envpool") from None


def described(game: str) -> tuple:
    """Return the settings, habitat and law of a game's task."""
    from primordia.config import load

    config = load(TASKS[game])
    habitat = config.build_habitat()
    return config, habitat, config.build_law(habitat)


def scales(law: Any) -> list[float]:
    """Return the standard deviation of a founder's weights in each block."""
    return law.heredity.mutation.per_block("founder_scale", law.heredity.layout)


class Brains:
    """Brains of one founder per cell, with one compiled call per tick."""

    def __init__(self, game: str, cells: int) -> None:
        import jax
        import jax.numpy as jnp

        from primordia.habitats.contract import Discrete
        from primordia.law.motor import argmax

        _, habitat, law = described(game)
        noise, discrete = np.random.default_rng(0), isinstance(habitat.action, Discrete)
        self._genome = {
            name: jnp.asarray(scale * noise.standard_normal((cells, *shape)), jnp.float32)
            for scale, (name, shape) in zip(scales(law), law.heredity.layout.blocks, strict=True)
        }
        self._memory = jnp.zeros((cells, law.memory), jnp.float32)

        def think(genome: Any, memory: Any, senses: Any) -> tuple:
            memory, output = law.brain(genome, memory, senses)
            return memory, argmax(output) if discrete else output

        self._think = jax.jit(think)

    def __call__(self, senses: np.ndarray) -> np.ndarray:
        """Return actions, int32 (N,) or float32 (N, A), for senses, float32 (N, S).

        Memory is kept from game to game.
        """
        self._memory, action = self._think(self._genome, self._memory, senses)
        return np.asarray(action)
