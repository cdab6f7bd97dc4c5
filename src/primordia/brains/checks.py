"""The check of a brain before a run: its blocks and memory, and what it returns."""

import jax
import jax.numpy as jnp

from primordia.brains.contract import Brain
from primordia.settings.tracing import COUNT, Tracing

LARGEST = 2**24
"""Largest number of numbers in an organism's memory."""


def check_brain(brain: Brain, senses: int, outputs: int) -> None:
    """Call and trace the methods of a brain. No thought is computed.

    Args:
        brain: the brain with its settings.
        senses: S, the count of numbers that an organism perceives.
        outputs: A, the count of numbers that the motor takes.

    Raises:
        InputError: a method fails, or its result does not keep the contract; the message says how.
    """
    tracing = Tracing("brain", brain)
    blocks = tracing.called("blocks", brain.blocks, senses, outputs)
    tracing.need(
        isinstance(blocks, dict),
        f"gives blocks as {blocks!r}; return a dictionary of names and shapes",
    )
    layout = brain.layout(senses, outputs)
    length = tracing.called("memory", brain.memory, senses, outputs)
    tracing.need(
        type(length) is int and 0 <= length <= LARGEST,
        f"has a memory of length {length!r}; return a whole number, 0 for none",
    )
    genome = {name: _floats(*shape) for name, shape in layout.blocks}
    thought = tracing.traced("__call__", brain, genome, _floats(length), _floats(senses))
    tracing.need(
        isinstance(thought, tuple) and len(thought) == 2,
        "does not return a pair; return memory and output",
    )
    tracing.typed("its memory", thought[0], (COUNT, length), jnp.float32)
    tracing.typed("its output", thought[1], (COUNT, outputs), jnp.float32)
    _check_uses_of_memory(tracing, brain, senses, outputs)


def _check_uses_of_memory(tracing: Tracing, brain: Brain, senses: int, outputs: int) -> None:
    """Check what a brain's other methods return for memories: `pictured`, `spent`, `passed_on`."""
    length = brain.memory(senses, outputs)
    shown = tracing.traced(
        "pictured", lambda memory: brain.pictured(memory, senses, outputs), _floats(length)
    )
    tracing.need(
        isinstance(shown, dict) and all(map(_is_map, shown.values())),
        "does not give what pictures show as arrays of organisms, rows and columns, by name",
    )
    spent = tracing.traced(
        "spent",
        lambda *both: brain.spent(both[0], both[1], senses, outputs),
        *[_floats(length)] * 2,
    )
    if spent is not None:
        tracing.typed("what thinking costs", spent, (COUNT,), jnp.float32)
    passed_on = tracing.traced(
        "passed_on", lambda memory: brain.passed_on(memory, senses, outputs), _floats(length)
    )
    if passed_on is not None:
        tracing.typed("what children inherit", passed_on, (COUNT, length), jnp.float32)


def _is_map(found: object) -> bool:
    shape: tuple[int, ...] = getattr(found, "shape", ())
    return len(shape) == 3 and shape[0] == COUNT and min(shape) > 0


def _floats(*shape: int) -> jax.ShapeDtypeStruct:
    return jax.ShapeDtypeStruct((COUNT, *shape), jnp.float32)
