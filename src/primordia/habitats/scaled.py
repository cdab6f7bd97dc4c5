"""Habitats with other physical parameters: `[habitat] factors`, for any habitat that has parameters."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.errors import InputError
from primordia.habitats.around import AroundHost, AroundJax
from primordia.habitats.checks import check_parameters
from primordia.habitats.contract import AnyHabitat, Bodies, JaxHabitat, Outcome

if TYPE_CHECKING:
    from PIL.Image import Image

LARGEST = 1e6
"""Largest factor."""


class _Scaled:
    """What scaled habitats have in common in JAX and on the host."""

    inner: Any

    def __init__(self, inner: AnyHabitat, factors: tuple[float, ...]) -> None:
        super().__init__(inner, factors)  # type: ignore[call-arg]
        self._factors = np.array(factors, np.float32)

    def picture(self, body: Bodies, action: np.ndarray) -> "Image":
        """Return a picture of a body with these parameters."""
        return self.picture_scaled(body, action, np.ones(1, np.float32))

    def picture_scaled(self, body: Bodies, action: np.ndarray, factors: np.ndarray) -> "Image":
        """Return a picture of a body whose parameters change by further factors, float32 (P,)."""
        return self.inner.picture_scaled(body, action, self._factors * factors)


class ScaledInJax(_Scaled, AroundJax):
    """A habitat in JAX whose parameters are those of the inner habitat times factors."""

    def step(self, bodies: Bodies, action: Array) -> tuple[Bodies, Outcome]:
        """Step all bodies by one tick; see `JaxHabitat.step`."""
        factors = jnp.broadcast_to(self._factors, (len(action), len(self._factors)))
        return self.inner.step_scaled(bodies, action, factors)

    def step_scaled(self, bodies: Bodies, action: Array, factors: Array) -> tuple[Bodies, Outcome]:
        """Step bodies whose parameters change by further factors, float32 (N, P)."""
        return self.inner.step_scaled(bodies, action, jnp.asarray(self._factors) * factors)


class ScaledOnHost(_Scaled, AroundHost):
    """A habitat on the host whose parameters are those of the inner habitat times factors."""

    def open(self, cells: int, watched: bool = False) -> None:
        """Allocate a body for each of N cells; see `HostHabitat.open`."""
        self.inner.open(cells, watched)
        self.inner.set_factors(np.arange(cells), np.tile(self._factors, (cells, 1)))

    def set_factors(self, cells: np.ndarray, factors: np.ndarray) -> None:
        """Multiply the parameters of bodies by further factors; see `HostHabitat.set_factors`."""
        self.inner.set_factors(cells, self._factors * factors)


def scaled(habitat: AnyHabitat, factors: Any) -> AnyHabitat:
    """Return a habitat whose physical parameters are multiplied by factors.

    Args:
        habitat: a habitat with `parameters`.
        factors: name of a parameter -> factor above 0; other parameters keep their values.

    Raises:
        InputError: the habitat has no such parameter, or a factor is wrong.
    """
    if not isinstance(factors, Mapping):
        raise InputError("habitat.factors: write a table, such as factors = {gravity = 2.0}")
    check_parameters(habitat, "habitat.factors", factors)
    for name, factor in factors.items():
        if isinstance(factor, bool) or not isinstance(factor, int | float):
            raise InputError(f"habitat.factors.{name}: {factor!r} is not a number")
        if not 0 < factor <= LARGEST:
            raise InputError(
                f"habitat.factors.{name}: {factor:g} is not above 0 and at most {LARGEST:g}"
            )
    values = tuple(float(factors.get(name, 1.0)) for name in habitat.parameters)
    if isinstance(habitat, JaxHabitat):
        return ScaledInJax(habitat, values)
    return ScaledOnHost(habitat, values)
