"""A brain by itself: `policy(senses) -> action`, to be used anywhere."""

import jax.numpy as jnp
import numpy as np

from primordia.compiled import shared
from primordia.habitats.contract import Discrete
from primordia.law.law import Law
from primordia.law.motor import argmax


class Policy:
    """What an organism would do. It remembers from call to call, as far as its brain has memory."""

    def __init__(self, law: Law, genome: np.ndarray) -> None:
        """`genome` is float32 (P,)."""
        self._law = law
        self._genome = law.layout.split(jnp.asarray(genome, jnp.float32)[None])
        self._think = shared(type(law.brain).__call__, law.brain)
        self.reset()

    def reset(self) -> None:
        """Forget, as at birth."""
        self._memory = jnp.zeros((1, self._law.memory), jnp.float32)

    def __call__(self, senses: np.ndarray) -> int | np.ndarray:
        """One tick.

        Args:
            senses: as the habitat gives them, (S,).

        Returns:
            the choice, if actions are discrete; else float32 (A,), without the motor's noise.
        """
        seen = jnp.asarray(senses, jnp.float32).reshape(1, -1)
        self._memory, output = self._think(self._genome, self._memory, seen)
        if isinstance(self._law.action, Discrete):
            return int(argmax(output)[0])
        return np.asarray(output[0])
