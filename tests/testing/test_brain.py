"""Checks of brains: each fault is caught and named. `tests.brains.test_contract` checks the others."""

import warnings

import pytest
from jax import Array
from pydantic import Field

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import matvec
from primordia.brains.layout import Shape
from primordia.testing import ContractError, check_brain
from primordia.testing import brain as checks
from primordia.testing.report import advise
from tests.testing.impure import counted


class Plain(Brain):
    """One matrix."""

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        return {"w": (outputs, senses)}

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, matvec(genome["w"], senses)


class Tent(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, (genome["w"] * senses[:, None]).sum(-1)


class Fused(Plain):
    def memory(self, senses: int, outputs: int) -> int:
        return outputs

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        memory = 0.9 * memory + 0.3 * matvec(genome["w"], senses)
        return memory, memory


class Crowd(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        output = matvec(genome["w"], senses)
        return memory, output - output.mean(axis=0)


class Counting(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, matvec(genome["w"], senses) + counted()


class Greedy(Plain):
    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, matvec(genome.pop("w"), senses)


class Remembering(Plain):
    """Its memory depends on other organisms; its output does not."""

    def memory(self, senses: int, outputs: int) -> int:
        return outputs

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        output = matvec(genome["w"], senses)
        return memory + output[:1], output


class Two(Plain):
    """A brain with two matrices of one shape."""

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        return {"v": (outputs, senses), "w": (outputs, senses)}


class Partly(Two):
    """A brain that replaces its second matrix."""

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        genome["w"] = genome["w"] + 1
        return memory, matvec(genome["v"], senses)


class Herd(Two):
    """A brain that adds a number of the first organism's second matrix."""

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        return memory, matvec(genome["v"], senses) + genome["w"][0, 0, 0]


class Sharing(Fused):
    """A brain whose children inherit the memories of all parents."""

    def passed_on(self, memory: Array, senses: int, outputs: int) -> Array:
        return memory + memory.sum(axis=0)


class Growing(Plain):
    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        return {"w": (outputs, senses), "more": (counted(),)}


class Listed(Fused):
    widths: list[int] = Field([3])


@pytest.mark.parametrize(
    ("brain", "says"),
    [
        (Tent(), "Tent gives different bits for organism .* when 1 instead of 32 think together; sum with"
         " brains.layers.matvec"),
        (Crowd(), "Crowd .* when organism 0 has another genome; sum nothing over the first axis"),
        (Counting(), "Counting .* when it is traced again, .* keep no counters"),
        (Greedy(), "changes its genome argument"),
        (Partly(), "changes its genome argument"),
        (Herd(), "Herd gives different bits for organism 1 when organism 0 has another genome"),
        (Remembering(), "Remembering gives different bits for organism 1 when organism 0 has another"),
        (Sharing(), "Sharing gives different bits .* when 1 instead of 32 pass on their memories"),
        (Growing(), "has different blocks of weights at each call"),
    ],
    ids=lambda each: type(each).__name__ if isinstance(each, Brain) else "",
)  # fmt: skip
def test_a_brain_with_a_fault(brain: Brain, says: str) -> None:
    with pytest.raises(ContractError, match=says):
        check_brain(brain)


def test_products_that_are_added_are_no_fault_and_nothing_is_said_of_what_is_well(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The check ends with the advice, which only what is compiled for each run needs."""
    advised = list[Brain]()
    monkeypatch.setattr(checks, "advise", advised.append)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_brain(fused := Fused())
        assert advised == [fused]
        advise(fused)
    with pytest.warns(UserWarning, match="Listed is not hashed by its values, .* define __hash__"):
        advise(Listed())
