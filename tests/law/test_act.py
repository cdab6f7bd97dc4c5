"""Replication as an act: who tries, and what it costs."""

import jax
import numpy as np
import pytest

from primordia.errors import InputError
from primordia.law.act import Act
from primordia.law.metabolism import ONE
from tests.worlds import MEADOW, config

TRIES = jax.jit(Act.tries, static_argnums=0)


def tries(act: Act, copying: list[list[float]], energy: list[int], price: float) -> list[list[int]]:
    """Return (tried, price, endowment) of each organism; energy and results in steps."""
    given = np.array(copying, np.float32), np.array(energy, np.int32), np.float32(price)
    return np.stack([np.asarray(each) for each in TRIES(act, *given)], axis=1).astype(int).tolist()


def test_an_organism_tries_if_its_output_is_above_zero_and_it_can_pay() -> None:
    """With 3 + 5 units to pay, one step more than 8 units is enough, and with `fatal` 8 units are."""
    act, paid = Act(kind="act", endowment=5.0), [1, 3 * ONE, 5 * ONE]
    outputs = [[1.0], [1e-30], [0.0], [-1.0], [np.nan], [1.0]]
    energy = [*[8 * ONE + 1] * 5, 8 * ONE]
    none = [0, 0, 0]
    assert tries(act, outputs, energy, 3.0) == [paid, paid, none, none, none, none]
    fatal = act.model_copy(update={"fatal": True})
    assert tries(fatal, outputs, energy, 3.0) == [paid, paid, none, none, none, paid]
    assert tries(fatal, [[1.0]], [8 * ONE - 1], 3.0) == [none]


def test_a_chosen_endowment_is_a_share_of_the_energy_that_leaves_one_step() -> None:
    """The share is 1/2 at 0, and cut where the parent could not pay the price any more."""
    act = Act(kind="act")
    outputs = [[1.0, 0.0], [1.0, 2 * np.arctanh(0.5)], [1.0, 100.0], [1.0, -100.0], [1.0, 100.0]]
    energy = [64 * ONE, 64 * ONE, 64 * ONE, 64 * ONE, 4 * ONE + 1]
    price = 4 * ONE
    half, most, (none, just) = (
        [1, price, 32 * ONE],
        [1, price, 60 * ONE - 1],
        ([0, 0, 0], [0, 0, 0]),
    )
    found = tries(act, outputs, energy, 4.0)
    assert [found[0], found[2], found[3], found[4]] == [half, most, none, just]
    assert found[1][2] == pytest.approx(48 * ONE, abs=1)
    fatal = tries(act.model_copy(update={"fatal": True}), outputs, energy, 4.0)
    assert fatal[2] == [1, price, 60 * ONE]
    assert fatal[4] == [1, price, 1]


def test_an_act_needs_a_metabolism() -> None:
    with pytest.raises(InputError, match=r"replication\.kind: .* needs a metabolism"):
        config(MEADOW, replication={"kind": "act"})
