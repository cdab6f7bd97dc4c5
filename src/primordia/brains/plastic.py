"""A brain that learns within its life: a local rule changes fast weights beside the inherited ones."""

from typing import Literal, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import Hidden, layer, linear, matvec
from primordia.brains.layout import Shape

COEFFICIENTS = ("a", "b", "c", "d", "rate")
"""blocks of the rule's coefficients"""


class _Memory(NamedTuple):
    """What a plastic brain keeps from one tick to the next; first axis N."""

    senses: Array
    """x of the last tick, (N, S)"""
    hidden: Array
    """h of the last tick, (N, H)"""
    active: Array
    """p of the last tick, (N, A)"""
    fast: Array
    """F, with the shape of the block `output`"""


class Plastic(Brain):
    """One hidden layer, and an output layer whose weights change in every tick of a life.

        m  = tanh(modulator_gain M (x - x'))
        F  = clip((1 - decay) F' + m (1 + tanh r) (a h' p' + b h' + c p' + d), -bound, bound)
        h  = tanh(gain W1 x)
        y  = (W2 + F) h
        p  = 1 for the largest output and -1 for the others, or tanh y

    x', h', p' and F' are those of the last tick. They are 0 at birth, so nothing learned is
    inherited, unless `inherited` is set: then F' is the parent's F at the birth. The weights W1, W2 and
    M and the coefficients a, b, c, d and r are inherited in any case. The rule is that of Najarro &
    Risi 2020, "Meta-learning through Hebbian plasticity in random networks" (arXiv 2007.02686, eq. 2),
    times m: a signal for each output, which the brain computes from the change of its senses
    (neuromodulation; Soltoggio et al. 2018, arXiv 1703.10371, sec. 4).
    """

    hidden: Hidden = 8
    coefficients: Literal["connection", "layer"] = Field(
        "connection",
        description="connection: each connection of the output layer has coefficients of its own;"
        " layer: all connections share them (Pedersen & Risi 2021)",
    )
    activity: Literal["winner", "graded"] = Field(
        "winner",
        description="signal of an output in the rule. winner: 1 for the largest output, -1 for the"
        " others, for a choice; graded: tanh of the output, for amounts",
    )
    decay: float = Field(
        0.2, ge=0, le=1, description="share of each fast weight that is lost in a tick"
    )
    bound: float = Field(
        5.0, ge=0, le=1e6, description="largest size of a fast weight; 0: the brain does not learn"
    )
    gain: float = Field(5.0, gt=0, le=1e6, description="factor of the senses")
    modulator_gain: float = Field(
        20.0, gt=0, le=1e6, description="factor of the change of the senses"
    )

    price: float = Field(
        0.0, ge=0, le=1e6, description="energy that a change of a fast weight by 1 costs"
    )
    inherited: bool = Field(
        False,
        description="true: a child begins with the fast weights that its parent has at the birth"
        " (Lamarckian inheritance); false: with 0",
    )

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return `input` (W1), `output` (W2), `modulator` (M), and the coefficients, COEFFICIENTS."""
        output = layer("output", self.hidden, outputs)
        each = output["output"] if self.coefficients == "connection" else (1, 1)
        return {
            **layer("input", senses, self.hidden),
            **output,
            **layer("modulator", senses, outputs),
            **dict.fromkeys(COEFFICIENTS, each),
        }

    def memory(self, senses: int, outputs: int) -> int:
        """Return the number of last senses, neurons and outputs, and of fast weights."""
        return senses + self.hidden + outputs + self.hidden * outputs

    def innate(self) -> "Plastic":
        """Return the brain whose fast weights stay 0."""
        return self.model_copy(update={"bound": 0.0})

    def spent(self, before: Array, after: Array, senses: int, outputs: int) -> Array | None:
        """Return `price` times the sum of the changes of all fast weights."""
        if not self.price:
            return None
        shape = layer("output", self.hidden, outputs)["output"]
        was, now = (self._split(memory, senses, shape).fast for memory in (before, after))
        change = jnp.abs(now - was).reshape(len(now), 1, -1)
        each = jnp.full((len(now), change.shape[2]), np.float32(self.price))
        return matvec(change, each)[:, 0]

    def passed_on(self, memory: Array, senses: int, outputs: int) -> Array | None:
        """Return memories with the fast weights, and 0 for the last tick; None unless `inherited`."""
        if not self.inherited:
            return None
        return memory.at[:, : -self.hidden * outputs].set(0)

    def pictured(self, memory: Array, senses: int, outputs: int) -> dict[str, Array]:
        """Return the fast weights as shares of the bound, a row for each output; none without a bound."""
        if not self.bound:
            return {}
        shape = layer("output", self.hidden, outputs)["output"]
        fast = self._split(memory, senses, shape).fast / np.float32(self.bound)
        return {"fast weights": fast.swapaxes(1, 2) if self.hidden <= outputs else fast}

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; see `Brain`."""
        last = self._split(memory, senses.shape[1], genome["output"].shape[1:])
        change = linear(genome, "modulator", senses - last.senses)
        signal = jnp.tanh(np.float32(self.modulator_gain) * change)
        bound, kept = np.float32(self.bound), np.float32(1 - self.decay)
        fast = jnp.clip(kept * last.fast + self._rule(genome, last, signal), -bound, bound)
        hidden = jnp.tanh(np.float32(self.gain) * linear(genome, "input", senses))
        output = matvec(genome["output"] + fast, hidden)
        now = _Memory(senses, hidden, self._activity(output), fast.reshape(len(fast), -1))
        return jnp.concatenate(now, axis=1), output

    def _split(self, memory: Array, senses: int, shape: Shape) -> _Memory:
        """Return the parts of memories (N, M); `shape` is that of the block `output`."""
        outputs = shape[0] * shape[1] // self.hidden
        ends = np.cumsum([senses, self.hidden, outputs])
        before, hidden, active, fast = jnp.split(memory, ends, axis=1)
        return _Memory(before, hidden, active, fast.reshape(-1, *shape))

    def _rule(self, genome: Genome, last: _Memory, signal: Array) -> Array:
        """Return the change of each fast weight, with the shape of the block `output`."""
        a, b, c, d, rate = (genome[name] for name in COEFFICIENTS)
        if self.hidden <= signal.shape[1]:  # the shape is (hidden, outputs); see `layer`
            pre, post, m = last.hidden[:, :, None], last.active[:, None, :], signal[:, None, :]
        else:
            pre, post, m = last.hidden[:, None, :], last.active[:, :, None], signal[:, :, None]
        return m * (1 + jnp.tanh(rate)) * (a * pre * post + b * pre + c * post + d)

    def _activity(self, output: Array) -> Array:
        if self.activity == "graded":
            return jnp.tanh(output)
        winner = output == output.max(axis=1, keepdims=True)
        return jnp.where(winner, np.float32(1), np.float32(-1))
