"""The state of an environment as plain data: every kind of value is restored."""

from collections import Counter, OrderedDict, deque
from enum import Enum
from random import Random
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from primordia.habitats.gymnasium import state


class Colour(Enum):
    RED = 1


class Part:
    """An object within an environment."""

    def __init__(self, number: int) -> None:
        self.number = number


class Thing:
    """An environment with a value of each kind."""

    def __init__(self, seed: int) -> None:
        self.plain = [True, seed, 0.1 * seed, f"é{seed}", None]
        self.tuple, self.set = (seed, (seed + 1,)), {seed, seed + 5}
        self.deque = deque(range(seed), maxlen=4)
        self.dict: dict[Any, Any] = {seed: "a", "b": [seed], (1, 2): seed}
        self.ordered = OrderedDict([("z", seed), ("a", -seed)])
        self.number, self.small = np.float32(seed / 3), np.uint8(seed)
        self.array = np.arange(6.0).reshape(2, 3) * seed
        self.whole = np.full((0, 2), seed, np.int16)
        self.generator = np.random.default_rng(seed)
        self.part = Part(seed)
        self.parts = [self.part, Part(-seed), self.part]
        self.arrays = [np.arange(2.0) + place for place in range(seed)]
        self.itself = self
        self.colour, self.kind = Colour.RED, Part

    def values(self) -> dict[str, Any]:
        """Return the values that can be compared."""
        names = ("plain", "tuple", "set", "deque", "dict", "number", "small", "colour", "kind")
        return {
            **{name: (type(getattr(self, name)), getattr(self, name)) for name in names},
            "longest": self.deque.maxlen,
            "order": list(self.ordered.items()),
            "keys": list(self.dict),
            "array": (self.array.dtype, self.array.shape, self.array.tolist()),
            "whole": (self.whole.dtype, self.whole.shape),
            "parts": [part.number for part in self.parts],
            "arrays": [each.tolist() for each in self.arrays],
        }


@pytest.mark.parametrize(("saved", "present"), [(3, 7), (7, 2)])
def test_every_kind_of_value_is_restored(saved: int, present: int) -> None:
    """Two names of one object still name one object. An attribute that was added later is removed.

    Saved lists are longer or shorter than the present ones.
    """
    one, other = Thing(saved), Thing(present)
    other.later = 9  # type: ignore[attr-defined]
    del other.tuple, other.small  # these are then the last attributes of the restored environment
    own = other.part, other.generator
    one.generator.random(5)
    state.decode(other, state.encode(one))
    assert state.encode(other) == state.encode(one)
    assert other.values() == one.values()
    assert other.generator.random(3).tolist() == one.generator.random(3).tolist()
    assert (other.part, other.generator) == own
    assert other.parts[0] is other.parts[2] is other.part
    assert other.parts[1] is not other.part
    assert other.itself is other
    assert not hasattr(other, "later")
    other.array[0] = 5  # the array can be written, and is no part of the other environment
    assert one.array[0].tolist() == [0, saved, 2 * saved]


def test_what_cannot_be_saved_is_named_by_its_place() -> None:
    thing = Thing(3)
    thing.plain.append(iter([1]))
    with pytest.raises(
        state.UnknownStateError, match=r"^env\.plain\[5\] is a list_iterator, which"
    ):
        state.encode(thing)


class Reduced(Part):
    def __reduce__(self) -> Any:
        return Reduced, (self.number,)


class ReducedByProtocol(Part):
    def __reduce_ex__(self, protocol: Any) -> Any:
        return ReducedByProtocol, (self.number,)


@pytest.mark.parametrize(
    "part", [Random(1), np.random.RandomState(1), Counter("aab"), Reduced(1), ReducedByProtocol(1)]
)
def test_an_object_with_a_state_beside_its_attributes_is_not_saved(part: Any) -> None:
    """Such an object defines how it is pickled. The numbers of Python's generator are no attributes."""
    thing = Thing(3)
    thing.parts[1] = part
    says = rf"^env\.parts\[1\] is a {type(part).__name__}, which cannot be saved$"
    with pytest.raises(state.UnknownStateError, match=says):
        state.encode(thing)


@pytest.mark.parametrize("depth", [1, 90, 110, 5000])
def test_a_state_is_saved_only_if_it_can_be_restored(depth: int) -> None:
    """A linked list, or a tree of nodes, may be nested too deeply."""
    one, other = Thing(3), Thing(3)
    one.plain = [7]
    for _ in range(depth):
        one.plain = [one.plain]
    if depth > state.DEEPEST:
        with pytest.raises(state.UnknownStateError, match="nested too deeply"):
            state.encode(one)
        return
    state.decode(other, state.encode(one))
    assert state.encode(other) == state.encode(one)
