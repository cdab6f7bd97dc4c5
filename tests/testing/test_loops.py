"""The check of a JAX habitat in a compiled loop compares each reported value of each tick."""

from typing import ClassVar

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.habitats import Continuous, JaxHabitat, Outcome
from primordia.settings.base import Settings
from primordia.testing import ContractError
from primordia.testing import habitat as checks
from primordia.testing.lives import TICKS, Lives, Past
from primordia.testing.report import ALL


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


HABITAT = Reporting()
BODY, TICK = 5, TICKS - 1
Looped = tuple[np.ndarray, np.ndarray, Outcome]


@pytest.fixture(scope="module")
def looped() -> Looped:
    """Return senses at birth, later senses and outcomes of lives in a loop."""
    lives = Lives(HABITAT)
    return jax.tree.map(np.asarray, checks._looped(HABITAT, lives.words, lives.actions))


@pytest.fixture(scope="module")
def stepped() -> list[Past]:
    """Return the same lives, stepped tick by tick."""
    return Lives(HABITAT).whole()


def changed(looped: Looped, name: str) -> Looped:
    """Return the lives with another value in the last tick of a body: a number is 0, or False is True."""
    born, senses, outcome = looped
    values = {**outcome._asdict(), "senses": senses}
    values[name] = values[name].copy()
    values[name][TICK, BODY] = values[name][TICK, BODY] == 0
    senses = values.pop("senses")
    return born, senses, Outcome(**values)


STEPPED = "in a compiled loop than when it is stepped"


@pytest.mark.parametrize(
    ("name", "first", "says"),
    [
        *((name, "changed", STEPPED) for name in ("senses", "fatal", "food", "effort", "expired")),
        ("expired", "same", "when it is traced again"),
    ],
)
def test_each_value_that_differs_in_a_loop_is_found(
    name: str,
    first: str,
    says: str,
    looped: Looped,
    stepped: list[Past],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The lives are traced twice. The value differs in both traces, or only in the second one."""
    other = changed(looped, name)
    traces = iter([other if first == "changed" else looped, other])
    monkeypatch.setattr(checks, "_looped", lambda *_: next(traces))
    with pytest.raises(
        ContractError, match=f"body {BODY} has a different life at age {TICKS} {says}"
    ):
        checks._in_a_loop(HABITAT, Lives(HABITAT), stepped)


def test_equal_lives_in_a_loop_pass(stepped: list[Past]) -> None:
    checks._in_a_loop(HABITAT, Lives(HABITAT), stepped)
    assert [len(past) for past in stepped] == [TICKS + 1] * ALL
