"""A JAX habitat on the host: who is stepped, faults of bodies, pictures, and what is saved.

`tests/testing/test_habitat.py` compares its lives with those in JAX.
"""

from typing import Any

import jax
import numpy as np

from primordia.compiled import jit
from primordia.habitats.bodies import not_finite
from primordia.habitats.cartpole.habitat import CartPole
from primordia.habitats.contract import Ability, Outcome
from primordia.habitats.on_host import OnHost
from tests.toys import Echo, Meadow

WORDS = np.random.default_rng(0).integers(0, 2**32, (8, 4), np.uint32)
ALL = np.arange(8)


def opened(inner: Any = None, cells: int = 8) -> OnHost:
    habitat = OnHost(inner or CartPole())
    habitat.open(cells)
    return habitat


def test_only_the_living_are_stepped() -> None:
    habitat = opened()
    habitat.reset(ALL, WORDS)
    before, alive = np.array(habitat.seen()), ALL % 2 == 0
    senses, _ = habitat.step(np.ones(8, np.int32), alive)
    assert (habitat.seen()[alive] != before[alive]).any(axis=1).all()
    np.testing.assert_array_equal(habitat.seen()[~alive], before[~alive])
    np.testing.assert_array_equal(senses, habitat.seen())


class Reporting(Meadow):
    """A meadow that reports a fault itself in its first tick."""

    def step(self, bodies: Any, action: Any) -> tuple[Any, Outcome]:
        after, outcome = super().step(bodies, action)
        return after, outcome._replace(fault=bodies[:, 0] == 0)


def test_a_body_has_failed_if_it_is_not_finite_or_if_its_habitat_says_so() -> None:
    habitat = opened(Reporting(broken_at=3))
    habitat.reset(ALL, WORDS[:, :1])
    for failed in (True, False, True):
        _, outcome = habitat.step(np.zeros(8, np.int32), np.ones(8, bool))
        assert np.asarray(outcome.fault).tolist() == [failed] * 8


def test_bodies_without_floating_point_numbers_never_fail() -> None:
    habitat = opened(Echo())
    habitat.reset(ALL, WORDS[:, :1])
    _, outcome = habitat.step(np.zeros((8, 2), np.float32), np.ones(8, bool))
    assert outcome.fault is not None
    assert not np.asarray(outcome.fault).any()
    assert outcome.fault.shape == (8,)


def test_it_is_drawn_as_the_jax_habitat_is() -> None:
    habitat = opened()
    habitat.reset(ALL, WORDS)
    body, action = habitat.seen()[3], np.int32(1)
    assert habitat.picture(body, action).tobytes() == CartPole().picture(body, action).tobytes()
    assert (habitat.rate, habitat.caption(body, action)) == (50.0, "action 1")


def test_more_than_ten_arrays_of_a_body_are_restored_in_their_order() -> None:
    one, other = OnHost(Meadow()), OnHost(Meadow())
    one._bodies = [np.full(3, number) for number in range(12)]
    other._bodies = [np.zeros(3)] * 12
    other.load(one.save())
    jax.tree.map(np.testing.assert_array_equal, other.seen(), one.seen())


def test_it_can_be_drawn_only_if_the_jax_habitat_can() -> None:
    for inner, drawn in ((CartPole(), True), (Meadow(), False)):
        assert OnHost(inner).can(Ability.PICTURE) == drawn
        assert OnHost(inner).can(Ability.SAVE)


def test_one_number_of_one_array_makes_a_body_not_finite() -> None:
    bodies = {"a": np.zeros((5, 2, 2), np.float32), "b": np.zeros(5, np.float32),
              "c": np.zeros((5, 3), np.int32), "d": np.zeros((5, 1), np.float32)}  # fmt: skip
    bodies["a"][1, 1, 0], bodies["b"][2], bodies["d"][4] = np.nan, np.inf, -np.inf
    assert np.asarray(jit(not_finite)(bodies)).tolist() == [False, True, True, False, True]
