"""The simplest brain: weighted sums of the senses."""

from jax import Array

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import Biases, layer, linear
from primordia.brains.layout import Shape


class Linear(Brain):
    """A single layer, without memory: `y = W x`, with biases `y = W x + c`."""

    biases: Biases = False

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return `output` (W), and its bias."""
        return layer("output", senses, outputs, self.biases)

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; see `Brain`."""
        return memory, linear(genome, "output", senses)
