"""Bodies that are inherited: traits, which multiply physical parameters of a body.

The table `[habitat.traits]` of a task names them, for any habitat with physical parameters. Each trait
has a gene in the block BODY of the genome, after the blocks of the brain. So genes mutate, recombine and
are recorded as weights are. A gene is a number of octaves: a body whose gene is 1 has twice the founder's
value, and one whose gene is -1 has half of it.

The genes reach a body as the first words of its birth, which are random words otherwise. So everything
that makes bodies (worlds, lives that are lived again, games) makes the same bodies from a genome.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import log2
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field, ValidationError, model_validator

from primordia.errors import InputError
from primordia.habitats.around import AroundHost, AroundJax
from primordia.habitats.checks import check_parameters
from primordia.habitats.contract import AnyHabitat, Bodies, JaxHabitat, Outcome
from primordia.settings.base import Settings
from primordia.settings.fields import first_fault

if TYPE_CHECKING:
    from PIL.Image import Image

KEY = "traits"
"""The setting of a habitat's table that names the traits."""
POWER = [np.float32(np.log(2) ** k / np.prod(range(1, k + 1), dtype=float)) for k in range(8)]
"""Coefficients of the series of 2^x, whose error is below 1e-8 for x from -1/2 to 1/2."""


class Trait(Settings):
    """One trait of a body. Its numbers are factors of the habitat's own parameters."""

    of: tuple[str, ...] = Field(
        (),
        strict=False,
        description="physical parameters that it multiplies (default: the one with the trait's name)",
    )
    least: float = Field(gt=0, le=1e6, description="smallest factor")
    most: float = Field(gt=0, le=1e6, description="largest factor")
    founder: float = Field(1.0, gt=0, le=1e6, description="factor of a body whose gene is 0")

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if not self.least <= self.founder <= self.most or self.least == self.most:
            raise ValueError("least, founder and most must be in this order, and least below most")
        return self


@dataclass(frozen=True)
class Traits:
    """The traits of all bodies of a run, T of them."""

    each: tuple[tuple[str, Trait], ...]
    """name and settings of each trait, in the order of their genes"""

    @classmethod
    def of(cls, tables: Any) -> "Traits":
        """Return the traits that a table describes.

        Raises:
            InputError: a setting is wrong.
        """
        if not isinstance(tables, Mapping) or not tables:
            raise InputError(
                "habitat.traits: write a table for each trait, such as"
                " pole-length = { least = 0.2, most = 5.0 }"
            )
        found = []
        for name, table in tables.items():
            try:
                found.append((name, Trait.model_validate(table)))
            except ValidationError as error:
                raise InputError(first_fault(error, Trait, f"habitat.traits.{name}")) from None
        return cls(tuple(found))

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the traits, T of them."""
        return tuple(name for name, _ in self.each)

    def parameters(self, name: str) -> tuple[str, ...]:
        """Return the names of the parameters that a trait multiplies."""
        return dict(self.each)[name].of or (name,)

    def check(self, habitat: AnyHabitat) -> None:
        """Raise InputError if the habitat does not offer a parameter that a trait multiplies."""
        for name in self.names:
            check_parameters(habitat, f"habitat.traits.{name}", self.parameters(name))

    def factors(self, genes: Any) -> Any:
        """Return the factors of N bodies, float32 (N, T), from their genes, float32 (N, T).

        A factor is `founder` times 2^gene. At the ends of its range it is reflected, so that genes
        which drift do not gather there. NumPy and JAX give the same bits if a function is `rounded`.
        """
        library = np if isinstance(genes, np.ndarray) else jnp
        low, width, founder, least, most = self._ranges
        turn = width + width
        along = genes - low
        turned = along - turn * library.floor(along / turn)
        inside = (along >= 0) & (along <= width)
        octaves = library.where(inside, genes, low + (width - abs(turned - width)))
        return library.clip(founder * _power(library, octaves), least, most)

    @cached_property
    def _ranges(self) -> tuple[np.ndarray, ...]:
        """Lowest gene, range in octaves, founder, least and most of each trait, float32 (T,) each."""
        rows = [
            (log2(t.least / t.founder), log2(t.most / t.least), t.founder, t.least, t.most)
            for _, t in self.each
        ]
        return tuple(np.array(rows, np.float32).T)

    def by_parameter(self, factors: Any, parameters: tuple[str, ...]) -> Any:
        """Return the factors of P parameters, float32 (N, P), from those of traits, (N, T)."""
        library = np if isinstance(factors, np.ndarray) else jnp
        columns = [library.ones(len(factors), np.float32) for _ in parameters]
        for number, name in enumerate(self.names):
            for own in self.parameters(name):
                place = parameters.index(own)
                columns[place] = columns[place] * factors[:, number]
        return library.stack(columns, axis=1)


def _power(library: Any, octaves: Any) -> Any:
    """Return 2^octaves, float32, by products and sums alone, which all machines round alike."""
    whole = library.round(octaves)
    part = octaves - whole
    power = POWER[-1] + library.zeros_like(part)
    for coefficient in POWER[-2::-1]:
        power = power * part + coefficient
    exponent = (whole.astype(np.int32) + np.int32(127)) << np.int32(23)
    return power * exponent.view(np.float32)


class Shaped(NamedTuple):
    """Bodies of a habitat, and their traits."""

    inner: Bodies
    traits: Any
    """factors, float32 (N, T)"""


class _WithTraits:
    """What habitats with traits have in common in JAX and on the host."""

    inner: Any

    def __init__(self, inner: AnyHabitat, traits: Traits) -> None:
        super().__init__(inner, traits)  # type: ignore[call-arg]
        self.traits, self.words = traits, len(traits.names) + inner.words

    def original(self) -> AnyHabitat | None:
        """Return the inner habitat as the standard benchmark scores it, with these bodies."""
        original = self.inner.original()
        return None if original is None else with_traits(original, self.traits)

    def _columns(self, traits: Any) -> Any:
        return self.traits.by_parameter(traits, self.inner.parameters)

    def picture(self, body: Shaped, action: np.ndarray) -> "Image":
        """Return a picture of the body with its traits."""
        return self.picture_scaled(body, action, np.ones(1, np.float32))

    def picture_scaled(self, body: Shaped, action: np.ndarray, factors: np.ndarray) -> "Image":
        """Return a picture of the body with its traits, times further factors, float32 (P,)."""
        own = self._columns(np.asarray(body.traits)[None])[0]
        return self.inner.picture_scaled(body.inner, action, own * factors)

    def caption(self, body: Shaped, action: np.ndarray) -> str:
        """Return the inner habitat's caption and the traits."""
        named = zip(self.traits.names, body.traits, strict=True)
        traits = [f"{name} x {factor:.2f}" for name, factor in named]
        return ", ".join(each for each in (self.inner.caption(body.inner, action), *traits) if each)


class TraitsInJax(_WithTraits, AroundJax):
    """A habitat in JAX whose bodies are inherited."""

    def reset(self, words: Array) -> Shaped:
        """Return fresh bodies; the first words are genes. See `JaxHabitat.reset`."""
        count = len(self.traits.names)
        genes = words[:, :count].view(jnp.float32)
        return Shaped(self.inner.reset(words[:, count:]), self.traits.factors(genes))

    def sense(self, bodies: Shaped) -> Array:
        """Return the senses; see `JaxHabitat.sense`."""
        return self.inner.sense(bodies.inner)

    def step(self, bodies: Shaped, action: Array) -> tuple[Shaped, Outcome]:
        """Step all bodies by one tick; see `JaxHabitat.step`."""
        factors = self._columns(bodies.traits)
        inner, outcome = self.inner.step_scaled(bodies.inner, action, factors)
        return bodies._replace(inner=inner), outcome

    def step_scaled(self, bodies: Shaped, action: Array, factors: Array) -> tuple[Shaped, Outcome]:
        """Step bodies whose parameters change by further factors, float32 (N, P)."""
        factors = self._columns(bodies.traits) * factors
        inner, outcome = self.inner.step_scaled(bodies.inner, action, factors)
        return bodies._replace(inner=inner), outcome


class TraitsOnHost(_WithTraits, AroundHost):
    """A habitat on the host whose bodies are inherited."""

    def open(self, cells: int, watched: bool = False) -> None:
        """Allocate a body for each of N cells; see `HostHabitat.open`."""
        self.inner.open(cells, watched)
        self._traits = self.traits.factors(np.zeros((cells, len(self.traits.names)), np.float32))
        self._further = np.ones((cells, len(self.inner.parameters)), np.float32)

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells (K,); the first words are genes. See `HostHabitat.reset`."""
        count = len(self.traits.names)
        genes = np.ascontiguousarray(words[:, :count]).view(np.float32)
        self._traits[cells] = self.traits.factors(genes)
        self._scale(cells)
        return self.inner.reset(cells, words[:, count:])

    def set_factors(self, cells: np.ndarray, factors: np.ndarray) -> None:
        """Multiply parameters of bodies by further factors; see `HostHabitat.set_factors`."""
        self._further[cells] = factors
        self._scale(cells)

    def _scale(self, cells: np.ndarray) -> None:
        factors = self._columns(self._traits[cells]) * self._further[cells]
        self.inner.set_factors(cells, factors)

    def seen(self) -> Shaped:
        """Return the bodies of the inner habitat, and their traits."""
        return Shaped(self.inner.seen(), self._traits)

    def save(self) -> dict[str, np.ndarray]:
        """Return the arrays of the inner habitat, and the traits."""
        return {**self.inner.save(), KEY: self._traits.copy()}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore what `save` returned."""
        self._traits = np.array(arrays[KEY])
        self._scale(np.arange(len(self._traits)))
        self.inner.load({name: each for name, each in arrays.items() if name != KEY})


def with_traits(habitat: AnyHabitat, traits: Traits) -> AnyHabitat:
    """Return the habitat with bodies that are inherited; raise InputError if a parameter is unknown."""
    traits.check(habitat)
    if isinstance(habitat, JaxHabitat):
        return TraitsInJax(habitat, traits)
    return TraitsOnHost(habitat, traits)
