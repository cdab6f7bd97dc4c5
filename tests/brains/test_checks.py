"""The check of a brain: the bounds of its memory, and what its methods return."""

from typing import Any, ClassVar

import jax.numpy as jnp
import pytest
from jax import Array

from primordia.brains.checks import LARGEST, check_brain
from primordia.brains.contract import Brain, Genome
from primordia.errors import InputError

SENSES, OUTPUTS = 3, 2


class Plain(Brain):
    """A brain of zeros, whose methods return the replacements of a test."""

    replaced: ClassVar[dict[str, Any]] = {}

    def blocks(self, senses: int, outputs: int) -> Any:
        return self.replaced.get("blocks", {"w": (outputs, senses)})

    def memory(self, senses: int, outputs: int) -> Any:
        return self.replaced.get("memory", super().memory(senses, outputs))

    def pictured(self, memory: Array, senses: int, outputs: int) -> Any:
        return self.replaced.get("pictured", {})

    def passed_on(self, memory: Array, senses: int, outputs: int) -> Any:
        return self.replaced.get("passed_on", lambda memory: None)(memory)

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> Any:
        pair = memory, jnp.zeros((len(senses), OUTPUTS))
        return self.replaced.get("thought", lambda pair: pair)(pair)


def plain(**replaced: Any) -> Brain:
    """Return a brain whose methods return these values instead."""
    return type("Plain", (Plain,), {"replaced": replaced, "__annotations__": {}})()


@pytest.mark.parametrize("replaced", [{}, {"memory": 0}, {"memory": 1}, {"memory": LARGEST}])
def test_a_memory_of_any_length_up_to_the_largest_passes(replaced: dict[str, Any]) -> None:
    check_brain(plain(**replaced), SENSES, OUTPUTS)
    assert LARGEST == 2**24


@pytest.mark.parametrize(
    ("replaced", "says"),
    [
        ({"memory": LARGEST + 1}, "has a memory of length 16777217; return a whole number"),
        ({"memory": -1}, "has a memory of length -1; return a whole number, 0 for none"),
        ({"memory": True}, "has a memory of length True"),
        ({"memory": None}, "has a memory of length None"),
        (
            {"blocks": [("w", (2, 3))]},
            "gives blocks as .*; return a dictionary of names and shapes",
        ),
        ({"thought": lambda pair: [*pair]}, "does not return a pair; return memory and output"),
        ({"thought": lambda pair: (*pair, 0)}, "does not return a pair; return memory and output"),
        (
            {"thought": lambda pair: pair[::-1]},
            r"gives its memory as float32 \(32, 2\); the contract says float32 \(32, 0\)",
        ),
        (
            {"thought": lambda pair: (pair[0], pair[1][:, :1])},
            r"gives its output as float32 \(32, 1\); the contract says float32 \(32, 2\)",
        ),
        (
            {"thought": lambda pair: (pair[0].astype(jnp.int32), pair[1])},
            r"gives its memory as int32 \(32, 0\)",
        ),
        ({"pictured": jnp.zeros((32, 2, 3))}, "does not give what pictures show as arrays of"),
        ({"pictured": {"w": jnp.zeros((32, 3))}}, "does not give what pictures show as arrays of"),
        ({"pictured": {"w": jnp.zeros((2, 32, 3))}}, "does not give what pictures show"),
        (
            {"memory": 3, "thought": lambda pair: pair, "passed_on": lambda memory: memory[:, :2]},
            r"gives what children inherit as float32 \(32, 2\); the contract says float32 \(32, 3\)",
        ),
    ],
)
def test_a_fault_of_a_brain_is_named(replaced: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=f"^brain: Plain {says}"):
        check_brain(plain(**replaced), SENSES, OUTPUTS)


def test_a_brain_is_checked_with_the_counts_of_senses_and_outputs_of_its_task() -> None:
    """The shapes of blocks, memory and output may depend on both counts, each in its own way."""
    asked: list[tuple[int, ...]] = []

    class Asking(Brain):
        def blocks(self, senses: int, outputs: int) -> Any:
            asked.append((senses, outputs))
            return {"w": (outputs, senses), "v": (2 * senses,)}

        def memory(self, senses: int, outputs: int) -> int:
            asked.append((senses, outputs))
            return senses + 2 * outputs

        def __call__(self, genome: Genome, memory: Array, senses: Array) -> Any:
            asked.append((*genome["w"].shape[1:], *genome["v"].shape[1:], *memory.shape[1:]))
            return jnp.concatenate([senses, memory[:, SENSES:]], axis=1), genome["w"].sum(axis=2)

    check_brain(Asking(), SENSES, OUTPUTS)
    assert set(asked) == {(SENSES, OUTPUTS), (OUTPUTS, SENSES, 2 * SENSES, SENSES + 2 * OUTPUTS)}
