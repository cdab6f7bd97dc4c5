"""The check of environments in JAX: faults that are found, and measured lifespans."""

from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats.contract import Discrete
from primordia.habitats.gymnax import check
from primordia.habitats.gymnax.check import Measured, measure
from primordia.habitats.gymnax.habitat import Gymnax
from tests.walks import Overwriting, Undefined


class Ruined(Undefined, Overwriting):
    """A walk with the faults of both."""


@pytest.mark.slow
def test_what_is_wrong_is_found() -> None:
    assert measure(Gymnax(env=f"{__name__}:Ruined")).faults == [
        "an observation is not finite",
        "an observation is outside the declared space",
        "a reward is not finite",
        "step changes the state that it is given",
    ]


def test_lives_are_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    """The test keeps JAX's caches, to save time."""
    monkeypatch.setattr(jax, "clear_caches", lambda: None)
    found = measure(Gymnax(env="tests.walks:Choice"))
    assert (found.lifespan, found.ended, found.faults) == (9.0, 32, [])


class Walked:
    """A habitat without faults; the test gives its lives."""

    words, action = 2, Discrete(3)
    simulator = SimpleNamespace(changes_state=lambda: False, repeats=lambda: True)

    def reset(self, words: Any) -> Any:
        return words


def test_the_lifespan_is_the_mean_of_all_lives_also_of_those_that_go_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three lives have 1, 2 and 9 ticks; the second goes on. The largest numbers are of all ticks."""
    spans, ended = np.array([1, 2, 9]), np.array([True, False, True])
    ticks = np.arange(1, 10)[:, None]
    largest = np.float32([[k, 9 - k] for k in range(9)])
    sound = np.ones(9, bool)
    seen = check._Seen(ticks <= spans, (ticks >= spans) & ended, largest, sound, sound, sound)
    habitat: Any = Walked()

    def measured(given: check._Seen) -> Measured:
        monkeypatch.setattr(check, "_lived", lambda *_: jax.tree.map(jnp.asarray, given))
        return check.measure(habitat)

    found = measured(seen)
    assert (found.lifespan, found.ended, found.faults) == (4.0, 2, [])
    assert found.largest.tolist() == [8, 9]
    for name, says in (
        ("finite", "an observation is not finite"),
        ("inside", "an observation is outside the declared space"),
        ("rewarded", "a reward is not finite"),
    ):
        once: Any = {name: np.arange(9) != 4}
        assert measured(seen._replace(**once)).faults == [says]
    odd = SimpleNamespace(changes_state=lambda: True, repeats=lambda: False)
    monkeypatch.setattr(Walked, "simulator", odd)
    changes, differs = measured(seen).faults
    assert changes == "step changes the state that it is given"
    assert differs.startswith("functions of the environment differ when traced again")


def test_values_of_a_body_that_has_ended_are_no_fault() -> None:
    nan = np.nan
    senses = SimpleNamespace(declared=lambda obs: (jnp.abs(obs) <= 9).all(axis=1))
    habitat: Any = SimpleNamespace(senses=senses)
    values = {"done": np.array([False, True, True]), "reward": np.float32([1, 2, nan]),
              "obs": np.float32([[3, -4], [5, 0], [nan, 70]])}  # fmt: skip
    found = jax.jit(lambda alive: check._seen(habitat, values, alive))
    seen = found(np.array([True, True, False]))
    assert [bool(each) for each in (seen.inside, seen.finite, seen.rewarded)] == [True] * 3
    assert seen.largest.tolist() == [5, 4]
    seen = found(np.array([False, True, True]))
    assert [bool(each) for each in (seen.inside, seen.finite, seen.rewarded)] == [False] * 3
