"""The check of a JAX habitat in a compiled loop: every reported number of every tick is compared."""

from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.habitats import Continuous, JaxHabitat, Outcome
from primordia.settings.base import Settings
from primordia.testing import ContractError
from primordia.testing import habitat as checks
from primordia.testing.lives import TICKS, Lives, Past
from primordia.testing.trial import ALL


class Reporting(JaxHabitat, Settings):
    """Bodies that report all that a habitat in JAX can report."""

    senses_size: ClassVar = 1
    action: ClassVar = Continuous(1)
    words: ClassVar = 1

    def reset(self, words: Array) -> Array:
        return (words % 7).astype(jnp.float32)

    def sense(self, bodies: Array) -> Array:
        return bodies

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        number, never = bodies[:, 0], jnp.zeros(len(bodies), bool)
        return bodies + 1, Outcome(never, food=number, effort=number, expired=never)


BODY, TICK = 5, TICKS - 1


def lived(**changed: Any) -> tuple[Any, ...]:
    """Return what `_looped` returns of the lives, with a value changed in the last tick of a body."""
    born = np.arange(ALL, dtype=np.float32)[:, None]
    numbers = born[None] + np.arange(TICKS, dtype=np.float32)[:, None, None]
    never = np.zeros((TICKS, ALL), bool)
    outcome = {"fatal": never, "food": numbers[..., 0], "effort": numbers[..., 0], "expired": never}
    values = {name: each.copy() for name, each in (outcome | {"senses": numbers + 1}).items()}
    for name, value in changed.items():
        values[name][TICK, BODY] = value
    senses = values.pop("senses")
    return born, senses, Outcome(**values)


def pasts() -> list[Past]:
    return checks._pasts(lived())


@pytest.mark.parametrize("name", ["senses", "fatal", "food", "effort", "expired"])
@pytest.mark.parametrize(
    ("traces", "says"),
    [((1, 1), "in a compiled loop than when it is stepped"), ((0, 1), "when it is traced again")],
)
def test_a_number_that_differs_in_a_loop_is_found(
    name: str, traces: tuple[int, int], says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The test gives the lives of both traces. One value of the last tick of a body is changed."""
    results = iter([lived(**{name: True}) if changed else lived() for changed in traces])
    monkeypatch.setattr(checks, "_looped", lambda *_: next(results))
    habitat = Reporting()
    with pytest.raises(
        ContractError, match=f"body {BODY} has a different life at age {TICKS} {says}"
    ):
        checks._in_a_loop(habitat, Lives(habitat), pasts())


def test_equal_lives_in_a_loop_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checks, "_looped", lambda *_: lived())
    habitat = Reporting()
    checks._in_a_loop(habitat, Lives(habitat), pasts())
    assert [len(past) for past in pasts()] == [TICKS + 1] * ALL
