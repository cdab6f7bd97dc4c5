"""What is compiled is shared where it is the same, and nowhere else."""

from functools import cache
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest

from primordia import compiled
from primordia.compiled import shared
from primordia.runs import loop
from primordia.settings.base import Settings
from tests.toys import Meadow
from tests.worlds import CLOCKWORK, MILL, Lived, config

MIRROR = {**MILL, "habitat": {"name": "tests.toys:Mirror", "inner": "mill"}}


def compilations(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Of the engine's functions; single operations on arrays are of no weight."""
    said = [each.message for each in caplog.records]
    return [each for each in said if each.startswith("Finished XLA compilation of jit(_")]


@pytest.mark.parametrize("base", [MILL, MIRROR], ids=["in JAX", "on the host"])
def test_a_run_with_another_seed_and_end_compiles_nothing(
    base: dict[str, Any],
    tmp_path: Path,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def live(name: str, **settings: Any) -> None:
        loop.start(config({**base, **settings}), tmp_path / name)

    monkeypatch.setattr(compiled, "_kept", cache(compiled._jitted))
    with jax.log_compiles():
        live("first", seed=1, stop={"ticks": 40})
        assert compilations(caplog)
        caplog.clear()
        live("second", seed=2, stop={"ticks": 55})
        loop.resume(tmp_path / "first", {"ticks": 60})
    assert compilations(caplog) == []


def test_another_habitat_is_another_world() -> None:
    """Though all else is the same."""
    one, other = Lived(config(CLOCKWORK), 60), Lived(config(CLOCKWORK, habitat={"lifespan": 9}), 60)
    assert one.digests() != other.digests()


def test_what_has_the_same_name_and_settings_may_be_something_else() -> None:
    """A class that was written anew, as in a notebook."""

    def written(factor: int) -> Any:
        class Meadow(Settings):
            size: int = 2

            def grow(self, x: jax.Array) -> jax.Array:
                return x * factor * self.size

        return Meadow()

    first, again = written(2), written(3)
    assert [float(shared(_grown, each)(1.0)) for each in (first, again, first)] == [4, 6, 4]


def test_what_cannot_be_hashed_shares_with_nothing() -> None:
    double, triple = shared(_scaled, {"by": 2}), shared(_scaled, {"by": 3})
    assert [float(double(2.0)), float(triple(2.0))] == [4, 6]


def test_what_is_equal_is_the_same_code() -> None:
    assert shared(_grown, Meadow()) is shared(_grown, Meadow())
    assert shared(_grown, Meadow()) is not shared(_grown, Meadow(lifespan=2))
    assert shared(_grown, Meadow()) is not shared(_scaled, Meadow())


def _grown(thing: Any, x: jax.Array) -> jax.Array:
    return thing.grow(x)


def _scaled(how: dict[str, int], x: jax.Array) -> jax.Array:
    return x * np.float32(how["by"])
