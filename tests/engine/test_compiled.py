"""Compiled code is shared by equal computations and by no others."""

from functools import lru_cache
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest

from primordia import compiled
from primordia.brains.recurrent import Recurrent
from primordia.compiled import shared
from primordia.law.heredity import Heredity
from primordia.mutations.gaussian import Gaussian
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.settings.base import Settings
from tests.toys import Meadow
from tests.worlds import HERD, MILL, config

MIRROR = {**MILL, "habitat": {"name": "tests.toys:Mirror", "inner": "mill"}}


def compilations(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return the compilations of the engine's functions; single operations on arrays do not matter."""
    begin = "Finished XLA compilation of jit("
    messages = (record.message for record in caplog.records)
    ours = tuple(begin + name for name in ("_", "advance"))
    return [message for message in messages if message.startswith(ours)]


@pytest.mark.parametrize(
    "base",
    [
        pytest.param(HERD, id="in JAX"),
        pytest.param(MIRROR, id="on the host", marks=pytest.mark.slow),
    ],
)
def test_a_run_with_another_seed_and_end_compiles_nothing(
    base: dict[str, Any], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Nor does one with other rates, which seasons may change. Another test may have compiled the first
    run, so a function of this file shows that the log is heard."""

    def live(name: str, **settings: Any) -> None:
        loop.start(config({**base, **settings}), tmp_path / name)

    with jax.log_compiles():
        compiled.jit(_heard)(1.0)
        assert compilations(caplog)
        live("first", seed=1, stop={"ticks": 40})
        caplog.clear()
        live("second", seed=2, stop={"ticks": 55})
        loop.resume(tmp_path / "first", {"ticks": 60})
        assert compilations(caplog) == []
        rates = {"replication": 0.1, "hazard": 0.03, "metabolism": {"store": 90.0, "drain": 2.0}}
        live("third", **rates, stop={"ticks": 40})
    assert compilations(caplog) == []
    one, other = (Archive(tmp_path / name).lives.lifespan for name in ("second", "third"))
    assert one.tolist() != other.tolist()


def test_a_class_with_the_same_name_and_settings_shares_no_code() -> None:
    """A class may be defined again under its name, as in a notebook."""

    def written(factor: int) -> Any:
        class Meadow(Settings):
            size: int = 2

            def grow(self, x: jax.Array) -> jax.Array:
                return x * factor * self.size

        return Meadow()

    first, again = written(2), written(3)
    assert [float(shared(_grown, each)(1.0)) for each in (first, again, first)] == [4, 6, 4]


def test_arguments_that_cannot_be_hashed_share_no_code() -> None:
    double, triple = shared(_scaled, {"by": 2}), shared(_scaled, {"by": 3})
    assert [float(double(2.0)), float(triple(2.0))] == [4, 6]


def test_equal_arguments_share_code() -> None:
    assert shared(_grown, Meadow()) is shared(_grown, Meadow())
    assert shared(_grown, Meadow()) is not shared(_grown, Meadow(lifespan=2))
    assert shared(_grown, Meadow()) is not shared(_scaled, Meadow())


def test_equal_ancestors_share_code_and_others_do_not() -> None:
    layout = Recurrent(hidden=1).layout(2, 2)
    genomes = np.ones((2, layout.length), np.float32)

    def code(ancestors: np.ndarray | None) -> Any:
        return shared(_grown, Heredity(layout, Gaussian(), None, "parent", ancestors, 1))

    assert code(genomes) is code(genomes.copy())
    others = [code(each) for each in (2 * genomes, genomes[:1], None)]
    assert len({code(genomes), *others}) == 4


def test_only_the_code_used_least_recently_is_dropped(
    kept_by_users: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With one computation more than are kept, the one that was used least recently is dropped."""
    most = kept_by_users
    assert most == compiled.KEPT
    monkeypatch.setattr(compiled, "_kept", lru_cache(most)(compiled._jitted))
    things = [Meadow(lifespan=number) for number in range(1, most + 2)]
    codes = [shared(_grown, each) for each in things[:-1]]
    assert shared(_grown, things[0]) is codes[0]
    shared(_grown, things[-1])
    assert shared(_grown, things[0]) is codes[0]
    assert shared(_grown, things[2]) is codes[2]
    assert shared(_grown, things[1]) is not codes[1]


@pytest.mark.parametrize("fixed", [(2,), ({"by": 2},)], ids=["shared", "alone"])
def test_only_the_memory_of_named_arguments_is_reused(fixed: tuple[Any, ...]) -> None:
    """Arguments are counted from the first one after the fixed ones."""
    code: Any = shared(_added, *fixed, donate=(1,))
    plain: Any = shared(_added, *fixed)
    x, y = np.zeros(3, np.float32), np.ones(3, np.float32)
    donated = [each.donated for each in code.func.lower(*code.args, x, y).args_info[0]]
    assert donated == [False, False, True]
    assert not any(each.donated for each in plain.func.lower(*plain.args, x, y).args_info[0])


def _heard(x: jax.Array) -> jax.Array:
    return x


def _added(_: Any, x: jax.Array, y: jax.Array) -> jax.Array:
    return x + y


def _grown(thing: Any, x: jax.Array) -> jax.Array:
    return thing.grow(x)


def _scaled(how: dict[str, int], x: jax.Array) -> jax.Array:
    return x * np.float32(how["by"])
