"""What is wrong with an environment in JAX is found, and said."""

from typing import Any

import jax
import numpy as np
import pytest
from jax import lax

from primordia.habitats.gymnax.check import measure
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.habitats.gymnax.rounded import rounded
from primordia.testing import check_habitat


@pytest.mark.parametrize(
    ("name", "faults"),
    [
        ("Choice", []),
        ("Walk", ["an observation is outside the declared space"]),
        ("Overwriting", ["an observation is outside the declared space",
                         "step changes the state that it is given"]),
        ("Undefined", ["an observation is not finite", "an observation is outside the declared space",
                       "a reward is not finite"]),
    ],
)  # fmt: skip
def test_what_is_wrong_is_found(name: str, faults: list[str]) -> None:
    assert measure(Gymnax(env=f"tests.walks:{name}")).faults == faults


def test_functions_that_keep_something_between_calls_are_found() -> None:
    (fault,) = measure(Gymnax(env="tests.walks:Counting")).faults
    assert fault.startswith("functions of the environment differ when traced again")


def test_lives_are_measured() -> None:
    found = measure(Gymnax(env="tests.walks:Choice"))
    assert (found.lifespan, found.ended) == (9.0, 32)
    endless = measure(Gymnax(env="tests.walks:Choice", params={"energy": 100_000}))
    assert (endless.lifespan, endless.ended) == (500.0, 0)


def test_sums_and_matrix_products_do_not_depend_on_the_number_of_bodies(optimised: None) -> None:
    check_habitat(Gymnax(env="tests.walks:Turning"))


def test_sums_and_matrix_products_are_those_of_numpy() -> None:
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(3, 5, 7, 2)), rng.normal(size=(7, 4, 3))
    whole = rng.integers(9, size=(5, 3))

    def sums(a: Any, b: Any, whole: Any) -> Any:
        product = lax.dot_general(a, b, (((2,), (0,)), ((0,), (2,))))
        integers = whole.sum(0), whole @ whole.T
        return product, a.sum(), a.sum(axis=(1, 3)), a[:, :, :0].sum(axis=2), *integers

    found = jax.jit(lambda zero, *each: rounded(sums, zero)(*each))(
        np.uint32(0), a.astype(np.float32), b.astype(np.float32), whole
    )
    expected = (
        np.einsum("nikj,kln->nijl", a, b), a.sum(), a.sum(axis=(1, 3)), np.zeros((3, 5, 2)),
        whole.sum(0), whole @ whole.T,
    )  # fmt: skip
    for one, other in zip(found, expected, strict=True):
        assert one.shape == np.shape(other)
        np.testing.assert_allclose(one, other, rtol=1e-4, atol=1e-5)
