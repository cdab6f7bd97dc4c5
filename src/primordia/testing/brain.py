"""The check of brains."""

from collections.abc import Callable

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.brains import checks
from primordia.brains.contract import Brain, Genome
from primordia.compiled import jit
from primordia.random.trials import normal
from primordia.testing.report import ALL, COUNTS, SUMMED, advise, kept, last, need, same

TICKS = 6


def check_brain(brain: Brain, senses: int = 33, outputs: int = 5) -> None:
    """Check types, purity, and that bits are the same for any number of organisms, compiled or not.

    Args:
        brain: the brain with its settings.
        senses: S, how many numbers an organism perceives.
        outputs: A, how many numbers the motor takes.

    Raises:
        ContractError: the brain does not keep the contract of `brains.contract`.
    """
    with kept():
        checks.check_brain(brain, senses, outputs)
    genome, memory, seen = _minds(brain, senses, outputs)
    _keeps_its_arguments(brain, genome, memory, seen[0])
    think = jit(lambda *given: brain(*given))
    whole = think(genome, memory, seen[0])
    _depends_on_its_own_only(brain, think, genome, memory, seen[0])
    for count in COUNTS:
        few = think(*last((genome, memory, seen[0]), count))
        says = (
            f"when {count} instead of {ALL} think together; sum with brains.layers.matvec instead"
            " of (w * x).sum(-1)"
        )
        same(brain, last(whole, count), few, says, ALL - count)
    same(brain, whole, brain(genome, memory, seen[0]), f"when compiled{SUMMED}")
    remembered, outputs_ = jit(lambda *given: _thoughts(brain, *given))(genome, memory, seen)
    for tick in range(TICKS):
        memory, output = think(genome, memory, seen[tick])
        same(brain, output, outputs_[tick], f"in a compiled loop{SUMMED}")
    same(brain, memory, remembered, f"in a compiled loop{SUMMED}")
    _passes_on_the_same(brain, memory, senses, outputs)
    advise(brain)


def _minds(brain: Brain, senses: int, outputs: int) -> tuple[Genome, Array, Array]:
    """Return genomes and memories of ALL organisms, and their senses (TICKS, ALL, S)."""
    layout = brain.layout(senses, outputs)
    need(
        layout == brain.layout(senses, outputs),
        brain,
        "has different blocks of weights at each call; blocks depend on settings, senses and"
        " outputs only",
    )
    length = brain.memory(senses, outputs)
    genome = {
        name: jnp.asarray(normal(place, ALL, *shape))
        for place, (name, shape) in enumerate(layout.blocks)
    }
    memory = jnp.tanh(normal(len(genome), ALL, length))
    return genome, memory, jnp.asarray(normal(len(genome) + 1, TICKS, ALL, senses))


def _keeps_its_arguments(brain: Brain, genome: Genome, memory: Array, seen: Array) -> None:
    given = dict(genome)
    brain(given, memory, seen)
    need(
        list(given) == list(genome) and all(given[name] is genome[name] for name in given),
        brain,
        "changes its genome argument; put new arrays into new variables",
    )


def _depends_on_its_own_only(
    brain: Brain, think: Callable, genome: Genome, memory: Array, seen: Array
) -> None:
    """Compare thoughts with those of a second trace, and of a batch with one broken genome."""
    whole = think(genome, memory, seen)
    again = jit(lambda *given: brain(*given))(genome, memory, seen)
    says = (
        "when it is traced again, so it depends on more than genome, memory and senses; keep no"
        " counters and no generators"
    )
    same(brain, whole, again, says)
    broken = {name: np.array(block) for name, block in genome.items()}
    for block in broken.values():
        block[0] = np.nan
    beside = think(broken, memory, seen)
    says = "when organism 0 has another genome; sum nothing over the first axis, that of organisms"
    same(brain, last(whole, ALL - 1), last(beside, ALL - 1), says, 1)


def _passes_on_the_same(brain: Brain, memory: Array, senses: int, outputs: int) -> None:
    """Compare what children inherit from all parents with what they inherit from a few."""
    pass_on = jit(lambda memory: brain.passed_on(memory, senses, outputs))
    whole = pass_on(memory)
    for count in COUNTS:
        says = f"when {count} instead of {ALL} pass on their memories"
        same(brain, last(whole, count), pass_on(last(memory, count)), says, ALL - count)


def _thoughts(brain: Brain, genome: Genome, memory: Array, seen: Array) -> tuple[Array, Array]:
    """Think for TICKS ticks in one loop. Return memory (N, M) and outputs (TICKS, N, A)."""
    return lax.scan(lambda memory, senses: brain(genome, memory, senses), memory, seen)
