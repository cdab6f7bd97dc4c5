"""The check of a mutation: each value at a bound passes, and each wrong one is refused by name."""

from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.brains.layout import Layout
from primordia.errors import InputError
from primordia.mutations.checks import check_mutation
from primordia.mutations.contract import PURPOSES, Change, Draws, Family, Moments, Mutation
from primordia.random.keys import bits, streams
from primordia.random.wide import wide

LAYOUT = Layout((("input", (2, 3)), ("output", (4,))))


class Plain(Mutation):
    """Children are copies and founders zeros. A test replaces attributes."""

    replaced: ClassVar[dict[str, Any]] = {}

    def inherit(self, layout: Layout, family: Family) -> Any:
        pair = family.parents, jnp.zeros(len(family.parents), bool)
        return self.replaced.get("inherit", lambda pair: pair)(pair)

    def founders(self, layout: Layout, draws: Draws) -> Array:
        return jnp.zeros((len(draws.cell), layout.length), self.replaced.get("type", jnp.float32))

    def rates(self, layout: Layout) -> Any:
        return self.replaced.get("rates", {"a": 1.0, "b": -2.5})

    def founders_notes(self, count: int) -> Any:
        return self.replaced.get("founders_notes", super().founders_notes(count))


def plain(**replaced: Any) -> Mutation:
    """Return a mutation with other attributes and results."""
    own: dict[str, Any] = {
        name: property(lambda self, name=name: self.replaced[name])  # type: ignore[misc]
        for name in ("moments", "notes_from")
        if name in replaced
    }
    own |= {name: replaced[name] for name in ("notes",) if name in replaced}
    return type("Plain", (Plain,), {**own, "replaced": replaced, "__annotations__": {}})()


@pytest.mark.parametrize(
    "replaced",
    [
        {},
        {"rates": {}},
        {"moments": Moments(1, 1)},
        {"moments": Moments(2**16, 1)},
        {"moments": Moments(1, 2**16)},
        {"moments": Moments(256, 256)},
        {"notes_from": "cell"},
        {"notes": ("one", "two")},
    ],
)
def test_a_mutation_within_the_bounds_passes(replaced: dict[str, Any]) -> None:
    check_mutation(plain(**replaced), LAYOUT)


@pytest.mark.parametrize(
    ("replaced", "says"),
    [
        (
            {"rates": [1.0]},
            r"gives rates as \[1.0\]; return a dictionary of names and finite floats",
        ),
        ({"rates": {"a": 1.0, "b": 2}}, "gives rates as"),
        ({"rates": {"a": float("nan"), "b": 1.0}}, "gives rates as"),
        ({"rates": {"a": 1.0, "b": float("inf")}}, "gives rates as"),
        ({"moments": Moments(0, 5)}, "has moments = .*kept=0"),
        ({"moments": Moments(5, 0)}, "has moments = .*every=0"),
        ({"moments": Moments(2**16 + 1, 1)}, "has moments = .* 2.16 ticks or less"),
        ({"moments": Moments(257, 256)}, "has moments = "),
        ({"moments": (4, 4)}, "has moments = "),
        ({"notes": ["one"]}, r"has notes = \['one'\]; it must be a tuple of names"),
        ({"notes": ("one", 2)}, "has notes = "),
        ({"notes_from": "world"}, "has notes_from = 'world'; it must be 'parent' or 'cell'"),
        (
            {"founders_notes": jnp.zeros((32, 1), jnp.int32)},
            r"gives founders' notes as int32 \(32, 1\); the contract says int32 \(32, 0\)",
        ),
        ({"inherit": lambda pair: pair[0]}, "does not return a pair from inherit"),
        ({"inherit": lambda pair: [*pair]}, "does not return a pair from inherit"),
        ({"inherit": lambda pair: (*pair, 1)}, "does not return a pair from inherit"),
        (
            {"inherit": lambda pair: (pair[0][:, 1:], pair[1])},
            r"gives genomes of children as float32 \(32, 9\); the contract says float32 \(32, 10\)",
        ),
        (
            {"inherit": lambda pair: (pair[0], pair[1].astype(jnp.int32))},
            r"gives which children are mutants as int32 \(32,\); the contract says bool \(32,\)",
        ),
        ({"type": jnp.float16}, r"gives genomes of founders as float16 \(32, 10\)"),
    ],
)
def test_a_fault_of_a_mutation_is_named(replaced: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=f"^mutation: Plain {says}"):
        check_mutation(plain(**replaced), LAYOUT)


def test_only_a_mutation_with_moments_gets_the_change_of_behaviour() -> None:
    given: list[Change | None] = []

    class Noting(Plain):
        def note(self, layout: Layout, family: Family, change: Change | None) -> Array:
            given.append(change)
            return family.notes

    class Remembering(Noting):
        @property
        def moments(self) -> Moments:
            return Moments(3, 2)

    check_mutation(Noting(), LAYOUT)
    check_mutation(Remembering(), LAYOUT)
    assert [change is None for change in given] == [True, False]


def family(count: int, size: int) -> Family:
    draws = Draws(streams(wide(np.arange(count)), wide(np.arange(count) * 7), *PURPOSES),
                  np.arange(count) + 20)  # fmt: skip
    notes = np.arange(count * size, dtype=np.int32).reshape(count, size)
    rates = {name: np.arange(count) * scale for name, scale in (("a", 0.5), ("b", -3.0))}
    return Family(np.arange(count * 10.0).reshape(count, 10), notes, rates, draws)


def test_a_mutation_has_defaults_for_notes_moments_and_rates() -> None:
    mutation, of = plain(notes=("one", "two")), family(5, 2)
    assert mutation.note(LAYOUT, of, None).tolist() == of.notes.tolist()
    none = mutation.founders_notes(3)
    assert (none.tolist(), none.dtype) == ([[0, 0]] * 3, jnp.int32)
    assert (mutation.moments, mutation.notes_from) == (None, "parent")
    assert [mutation.governed(each, LAYOUT) for each in ("b", "c")] == [["b"], []]


def test_families_are_taken_by_row_in_the_given_order() -> None:
    of, rows = family(6, 1), np.array([4, 1, 1, 0, 5, 2])
    some = of.take(rows)
    assert some.parents[:, 0].tolist() == [40, 10, 10, 0, 50, 20]
    assert some.notes.tolist() == [[4], [1], [1], [0], [5], [2]]
    assert some.rates.keys() == {"a", "b"}
    assert some.rates["a"].tolist() == [2.0, 0.5, 0.5, 0.0, 2.5, 1.0]
    assert some.rates["b"].tolist() == [-12.0, -3.0, -3.0, 0.0, -15.0, -6.0]
    assert some.draws.cell.tolist() == [24, 21, 21, 20, 25, 22]
    for purpose in PURPOSES:
        whole, taken = of.draws.bits(purpose, 3), some.draws.bits(purpose, 3)
        direct = bits(of.draws.streams[purpose], of.draws.cell, 3)
        assert taken.hi.tolist() == np.asarray(whole.hi)[rows].tolist()
        assert taken.lo.tolist() == np.asarray(direct.lo)[rows].tolist()
