"""A brain as a function `policy(senses) -> action`, for use in any other program."""

from collections.abc import Mapping
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np

from primordia.compiled import shared
from primordia.errors import InputError
from primordia.habitats.contract import Discrete
from primordia.law.law import Law
from primordia.law.motor import chosen
from primordia.organism import onnx


class Policy:
    """The brain of an organism as a function. A brain with memory remembers from call to call."""

    def __init__(self, law: Law, genome: np.ndarray) -> None:
        """Use a genome, float32 (P,)."""
        self._law = law
        blocks = law.heredity.layout.split(np.array(genome, np.float32)[None])
        self._genome = {name: jax.device_put(block) for name, block in blocks.items()}
        self._think = shared(type(law.brain).__call__, law.brain)
        self.reset()

    @property
    def weights(self) -> dict[str, np.ndarray]:
        """The weights by block, each float32 (*shape), as in a state dictionary."""
        return {name: np.asarray(block)[0] for name, block in self._genome.items()}

    @property
    def memory(self) -> np.ndarray:
        """The present memory, float32 (M,)."""
        return np.asarray(self._memory)[0]

    @property
    def pictured(self) -> dict[str, np.ndarray]:
        """What the brain shows of its present memory, by name, float32 (rows, columns) each; see
        `Brain.pictured`."""
        shown = self._law.brain.pictured(self._memory, self._law.senses, self._law.outputs)
        return {name: np.asarray(each)[0] for name, each in shown.items()}

    def to_onnx(self, path: str | Path, about: Mapping[str, str] | None = None) -> None:
        """Write the brain as an ONNX model, with `about` as metadata; see `onnx.write`."""
        onnx.write(Path(path), self._law, self.weights, dict(about or {}))

    def reset(self) -> None:
        """Clear the memory, as at birth."""
        self._memory = jnp.zeros((1, self._law.memory), jnp.float32)

    def __call__(self, senses: np.ndarray) -> int | np.ndarray:
        """Return the action for one tick.

        Args:
            senses: scaled senses as from the habitat, (S,).

        Returns:
            The chosen number if actions are discrete; else float32 (K,), without the motor's noise.

        Raises:
            InputError: there are more or fewer senses than the brain has.
        """
        row = jnp.asarray(senses, jnp.float32).reshape(1, -1)
        if row.shape[1] != self._law.senses:
            raise InputError(f"{row.shape[1]} senses are given; the brain has {self._law.senses}")
        self._memory, output = self._think(self._genome, self._memory, row)
        action = chosen(self._law.action, output, output)[0]
        return int(action) if isinstance(self._law.action, Discrete) else np.asarray(action)
