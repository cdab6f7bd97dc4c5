"""Any brain with an efference copy: it also perceives the senses and its own command of the last tick."""

import jax.numpy as jnp
from jax import Array, nn
from pydantic import InstanceOf

from primordia.brains.contract import Brain, Genome
from primordia.brains.layout import Shape
from primordia.habitats.contract import Compound, Continuous, Discrete
from primordia.law.motor import argmax, outputs_of


class Efferent(Brain):
    """A brain whose senses are those of this tick, those of the last tick, and the last command.

    The command is 1 for each chosen output of a choice and 0 for the others, and tanh of the outputs that
    are amounts, before the motor's noise. All are 0 at birth. The setting `brain.efference` makes such a
    brain of any other (von Holst & Mittelstaedt 1950, "Das Reafferenzprinzip").
    """

    inner: InstanceOf[Brain]
    action: InstanceOf[Discrete] | InstanceOf[Continuous] | InstanceOf[Compound]

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return the blocks of the inner brain with all its senses."""
        return self.inner.blocks(2 * senses + self.action.size, outputs)

    def memory(self, senses: int, outputs: int) -> int:
        """Return the length of the inner memory, of the senses and of the command together."""
        last = senses + self.action.size
        return self.inner.memory(senses + last, outputs) + last

    def innate(self) -> Brain | None:
        """Return the inner brain without learning, with the same senses; None if it is the same."""
        inner = self.inner.innate()
        return None if inner is None else self.model_copy(update={"inner": inner})

    def pictured(self, memory: Array, senses: int, outputs: int) -> dict[str, Array]:
        """Return what pictures show of the inner memory."""
        last = senses + self.action.size
        return self.inner.pictured(memory[:, :-last], senses + last, outputs)

    def spent(self, before: Array, after: Array, senses: int, outputs: int) -> Array | None:
        """Return the energy that thinking costs the inner brain."""
        last = senses + self.action.size
        return self.inner.spent(before[:, :-last], after[:, :-last], senses + last, outputs)

    def passed_on(self, memory: Array, senses: int, outputs: int) -> Array | None:
        """Return what the inner brain passes on, and 0 for the last senses and the last command."""
        last = senses + self.action.size
        inner = self.inner.passed_on(memory[:, :-last], senses + last, outputs)
        return None if inner is None else jnp.pad(inner, ((0, 0), (0, last)))

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; see `Brain`."""
        kept = senses.shape[1] + self.action.size
        own, last = memory[:, :-kept], memory[:, -kept:]
        own, output = self.inner(genome, own, jnp.concatenate([senses, last], axis=1))
        return jnp.concatenate([own, senses, self._command(output)], axis=1), output

    def _command(self, output: Array) -> Array:
        parts = [
            nn.one_hot(argmax(output[:, own]), part.size, dtype=jnp.float32)
            if isinstance(part, Discrete)
            else jnp.tanh(output[:, own])
            for part, own in outputs_of(self.action)
        ]
        return jnp.concatenate(parts, axis=1)
