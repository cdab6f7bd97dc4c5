"""States and limits: which worlds run, and which arrays make a state again."""

from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.engine.engine import CHUNK_SECONDS, Engine
from primordia.engine.state import Limits, filled, named_leaves, running
from primordia.errors import Trouble
from primordia.random.wide import to_host, wide

NEVER = 2**64 - 1


def of_seeds(seeds: int) -> Any:
    return SimpleNamespace(config=SimpleNamespace(seeds=seeds))


def test_a_world_stops_exactly_at_any_of_its_limits() -> None:
    worlds: Any = SimpleNamespace(
        tick=wide([9, 10, 11, 2**32 + 9, 5, 5, 5, 5]),
        births=wide([0, 0, 0, 0, 6, 7, 8, 0]),
        saturated=wide([NEVER] * 7 + [3]),
    )
    limits = Limits(wide([10, 10, 10, 2**32 + 10] + [99] * 4), wide([7] * 8), jnp.bool_(False))
    until_limits = [True, False, False, True, True, False, False, True]
    runs = jax.jit(lambda limits: running(worlds, limits))
    assert runs(limits).tolist() == until_limits
    saturation = limits._replace(saturation=jnp.bool_(True))
    assert runs(saturation).tolist() == [*until_limits[:7], False]


@pytest.mark.parametrize(
    ("stop", "ticks", "births", "saturation"),
    [
        ({}, NEVER, NEVER, False),
        ({"ticks": None, "births": None, "until": "none"}, NEVER, NEVER, False),
        ({"ticks": 70, "until": "saturation"}, 70, NEVER, True),
        ({"births": 2**40}, NEVER, 2**40, False),
        ({"ticks": 3, "births": 4}, 3, 4, False),
    ],
)
def test_a_limit_that_is_not_given_is_never_reached(
    stop: dict[str, Any], ticks: int, births: int, saturation: bool
) -> None:
    limits = Engine.limits(of_seeds(3), stop)
    assert to_host(limits.ticks).tolist() == [ticks] * 3
    assert to_host(limits.births).tolist() == [births] * 3
    assert bool(limits.saturation) == saturation


def test_ticks_of_each_world_replace_only_the_ticks_of_the_stop() -> None:
    own = np.array([5, 2**33, 7], np.uint64)
    limits = Engine.limits(of_seeds(3), {"ticks": 70, "births": 9, "until": "saturation"}, own)
    assert to_host(limits.ticks).tolist() == own.tolist()
    assert to_host(limits.births).tolist() == [9] * 3
    assert bool(limits.saturation)


TREE: Any = {"a": jnp.arange(3, dtype=jnp.int32), "b": (jnp.ones((2, 2)), jnp.zeros(1, bool))}


def stored(prefix: str = "") -> dict[str, np.ndarray]:
    return {
        f"{prefix}a": np.array([7, 8, 9], np.int32),
        f"{prefix}b.0": np.full((2, 2), 5, np.float32),
        f"{prefix}b.1": np.ones(1, bool),
        "more": np.zeros(2),
    }


def test_a_state_is_filled_with_the_arrays_of_its_names() -> None:
    assert [name for name, _ in named_leaves(TREE)] == ["a", "b.0", "b.1"]
    full = filled(TREE, {**stored("x."), "a": np.zeros(3, np.int32)}, "x.")
    assert full["a"].tolist() == [7, 8, 9]
    assert full["b"][0].tolist() == [[5, 5], [5, 5]]
    assert full["b"][1].tolist() == [True]
    assert TREE["a"].tolist() == [0, 1, 2]


def test_a_state_is_a_copy_of_what_was_stored() -> None:
    """JAX uses NumPy's memory where it lies at a multiple of 64 bytes."""
    raw = np.zeros(64 + 16, np.float32)
    first = -raw.ctypes.data // 4 % 16
    arrays = {"a": raw[first : first + 64]}
    full = filled({"a": jnp.ones(64)}, arrays)
    full["a"].block_until_ready()
    arrays["a"][:] = 7
    assert not full["a"].any()


@pytest.mark.parametrize("wrong", [None, np.zeros((4, 1), np.float32), np.zeros((2, 2), np.int32)])
def test_an_array_that_is_missing_or_different_is_trouble_that_names_it(wrong: Any) -> None:
    arrays = stored("x.") | {"x.b.0": wrong}
    if wrong is None:
        del arrays["x.b.0"]
    with pytest.raises(Trouble, match=r"does not fit this run: x\.b\.0 is missing or different"):
        filled(TREE, arrays, "x.")


class Chunks:
    """Chunks with a given time for each tick, and with a largest number of ticks."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.cost, self.most, self.asked, self.now = 2.0**-10, 10**9, [0], 0.0
        self.events = "events"
        monkeypatch.setattr("primordia.engine.engine.time.perf_counter", lambda: self.now)

    def advance(self, state: int, limits: Any, ticks: int) -> tuple[int, int]:
        self.asked.append(ticks)
        done = min(ticks, self.most)
        self.now += self.cost * max(done, 1)
        return state + done, done


def test_chunks_grow_fourfold_to_their_time_and_shrink_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    engine, chunks, limits = object.__new__(Engine), Chunks(monkeypatch), of_seeds(1)
    fields = {"chunks": chunks, "state": 0, "_ticks": 1, "longest": None}
    engine.__dict__.update(fields)

    def asked(count: int) -> list[int]:
        for _ in range(count):
            assert engine.advance(limits) == "events"
        return chunks.asked[-count:]

    fitting = int(CHUNK_SECONDS * 2**10)
    assert asked(6) == [1, 4, 16, 64, fitting, fitting]
    assert engine.state == sum(chunks.asked)
    chunks.cost = 2.0**-6
    assert asked(2) == [fitting, int(CHUNK_SECONDS * 2**6)]
    chunks.cost = 4.0
    assert asked(3)[1:] == [1, 1]
    chunks.cost, chunks.most = 2.0**-10, 0
    assert asked(2) == [1, 1], "after a chunk without ticks, the time of a tick is unknown"
    chunks.most = 10**9
    assert asked(3) == [1, 4, 16]
    engine.longest = 5
    assert asked(2) == [5, 5]
    engine.longest = None
    assert asked(1) == [fitting]
