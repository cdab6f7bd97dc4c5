"""What goes on inside organisms: outputs of brains, what brains show of their memories, and changes.

Films and the live view show them if a brain shows something, or if the world changes within lives.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.brains.contract import Genome
from primordia.habitats.changing import changes_at, is_changing
from primordia.habitats.contract import Action, AnyHabitat, Bodies, Discrete
from primordia.law.law import Law
from primordia.law.motor import outputs_of

LOW, MIDDLE, HIGH = (
    np.array(colour, np.float32) for colour in ((38, 84, 160), (251, 250, 247), (200, 85, 61))
)
"""Red, green and blue of -1, 0 and 1: the ends differ for colour-blind eyes too."""
CHANGED = "#7a3fb0"
"""Colour of the changes of a world."""
NEWS = 0.5
"""seconds for which a change is shown as new"""


class Inside(NamedTuple):
    """Ticks of brains, first axis N: of N organisms, or N ticks of one."""

    output: Array
    """float32 (N, A)"""
    shown: dict[str, Array]
    """what the brain shows of its memory after the tick, (N, rows, columns) each; see `Brain.pictured`"""


def is_shown(law: Law, habitat: AnyHabitat) -> bool:
    """Return whether a world's pictures show the inside of organisms."""
    return is_changing(habitat) or _shows(law)


def news_of(habitat: AnyHabitat) -> int:
    """Return for how many ticks a change is shown as new."""
    return max(round(NEWS * (habitat.rate or 1)), 1)


def since_change(habitat: AnyHabitat, body: Bodies, age: int) -> int | None:
    """Return the ticks since the world of a body of this age changed; None if nothing is new."""
    if not is_changing(habitat):
        return None
    ago = np.arange(news_of(habitat))
    found = ago[changes_at(habitat, body, age - ago)]
    return int(found[0]) if len(found) else None


def look(law: Law, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Inside]:
    """Think for one tick with memory (N, M) and senses (N, S). Return the memory after it, and more."""
    memory, output = law.brain(genome, memory, senses)
    shown = law.brain.pictured(memory, senses.shape[1], output.shape[1])
    return memory, Inside(output, shown)


def look_on(
    law: Law, genome: Genome, memory: Array, senses: Array, count: int
) -> tuple[Array, Inside]:
    """Think for ticks of one organism, with memory (1, M) and senses (n, S); see `look`.

    Only the first `count` ticks are real: the memory returned is that after them.
    """

    def tick(memory: Array, given: tuple[Array, Array]) -> tuple[Array, Inside]:
        now, real = given
        after, inside = look(law, genome, memory, now)
        return jnp.where(real, after, memory), inside

    real = jnp.arange(len(senses)) < count
    memory, seen = lax.scan(tick, memory, (senses[:, None], real))
    return memory, jax.tree.map(lambda each: each[:, 0], seen)


def _shows(law: Law) -> bool:
    """Return whether the brain shows anything of its memory."""
    blocks = {name: (1, *shape) for name, shape in law.heredity.layout.blocks}
    *_, inside = jax.eval_shape(
        lambda *given: look(law, *given),
        {name: jax.ShapeDtypeStruct(shape, jnp.float32) for name, shape in blocks.items()},
        *(jax.ShapeDtypeStruct((1, length), jnp.float32) for length in (law.memory, law.senses)),
    )
    return bool(inside.shown)


def acting(action: Action, output: np.ndarray) -> np.ndarray:
    """Return which outputs (A,) act, bool (A,): the largest of each choice, and all amounts."""
    found = np.zeros(len(output), bool)
    for part, own in outputs_of(action):
        if isinstance(part, Discrete):
            found[own.start + int(np.argmax(output[own]))] = True
        else:
            found[own] = True
    return found


def squashed(output: np.ndarray) -> np.ndarray:
    """Return outputs between -1 and 1: y / (1 + |y|); 0 for a number that is not finite."""
    finite = np.where(np.isfinite(output), output, 0)
    return finite / (1 + np.abs(finite))


def tints(values: np.ndarray) -> np.ndarray:
    """Return colours of numbers from -1 to 1 (...), uint8 (..., 3): blue, pale at 0, red."""
    values = np.clip(np.nan_to_num(values), -1, 1)[..., None]
    ends = np.where(values < 0, LOW, HIGH)
    return (MIDDLE + (ends - MIDDLE) * np.abs(values)).round().astype(np.uint8)
