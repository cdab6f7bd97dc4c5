"""The contract of brains: `(genome, memory, senses) -> (memory, output)`, for all organisms at once.

A genome is a flat float32 vector (P,) in records and files. Brains get genomes as named blocks
of weights, each (N, *shape). A compiled loop that cuts a flat (N, P) array into matrices copies these
matrices at every tick (measured on a CPU: 2.5 times slower).

The setting `kind` in a task's `[brain]` table is a key of KNOWN, or `module:Class` of any `Brain`.
The other keys of the table are the class's own settings.
"""

from abc import ABC, abstractmethod
from typing import TypeAlias

from jax import Array
from pydantic import Field

from primordia.brains.layout import Layout, Shape
from primordia.settings import parts
from primordia.settings.base import Settings

Genome: TypeAlias = dict[str, Array]

KNOWN = {
    "recurrent": "primordia.brains.recurrent:Recurrent",
    "feed-forward": "primordia.brains.feedforward:FeedForward",
    "gated": "primordia.brains.gated:Gated",
    "linear": "primordia.brains.linear:Linear",
    "plastic": "primordia.brains.plastic:Plastic",
}


class Brain(Settings, ABC):
    """A brain's settings and its behaviour.

    A brain is pure and treats each organism independently. It gives the same bits for every number
    of organisms and of threads; `layers.matvec` ensures that for sums.
    """

    efference: bool = Field(
        False,
        description="true: the brain also perceives the senses and its own command of the last tick",
    )
    interoception: bool = Field(
        False,
        description="true: the brain also perceives the organism's energy, as a share of the store at"
        " birth",
    )

    @abstractmethod
    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return name and shape of each block of weights, in the order of the flat genome.

        Args:
            senses: S, the count of numbers that an organism perceives.
            outputs: A, the count of numbers that the motor takes.
        """

    def memory(self, senses: int, outputs: int) -> int:
        """Return M, the count of numbers in an organism's memory; founders begin with zeros."""
        return 0

    def innate(self) -> "Brain | None":
        """Return the brain without learning within a life, for genomes of this one; None if the same."""
        return None

    def pictured(self, memory: Array, senses: int, outputs: int) -> dict[str, Array]:
        """Return what pictures show of memories (N, M), by name: (N, rows, columns) each, from -1 to 1.

        `senses` and `outputs` are as in `blocks`. A row for each output stands beside that output.
        """
        return {}

    def spent(self, before: Array, after: Array, senses: int, outputs: int) -> Array | None:
        """Return the energy that a tick of thinking costs, float32 (N,); None: thinking is free.

        `before` and `after` are memories (N, M); `senses` and `outputs` are as in `blocks`.
        """
        return None

    def passed_on(self, memory: Array, senses: int, outputs: int) -> Array | None:
        """Return the memories with which children begin, float32 (N, M); None: with zeros.

        `memory` holds the memories of their parents at the end of the tick of birth, (N, M); `senses`
        and `outputs` are as in `blocks`. Founders begin with zeros, and so does every player of a game.
        """
        return None

    @abstractmethod
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; all arrays are float32.

        Args:
            genome: block of weights -> (N, *shape).
            memory: (N, M).
            senses: (N, S).

        Returns:
            memory (N, M), output (N, A).
        """

    def layout(self, senses: int, outputs: int) -> Layout:
        """Return the layout of the brain's genomes.

        Raises:
            InputError: a block has a name or a shape that cannot be used.
        """
        return Layout(tuple(self.blocks(senses, outputs).items()))


def find(name: object) -> type[Brain]:
    """Return the brain class called `name`; raise LookupError, with the reason, if there is none."""
    return parts.find("brain", name, KNOWN, Brain)
