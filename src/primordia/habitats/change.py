"""Changes of the world within a life: what changes for a body, and when.

The setting `change` of a task's `[habitat]` table is a list of changes, for any habitat. All draws come
from random words of the body's birth, so the same life meets the same changes.
"""

from typing import Annotated, Any, Literal, Self, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError, model_validator

from primordia.errors import InputError
from primordia.habitats.checks import check_parameters
from primordia.habitats.contract import Action, AnyHabitat, Compound, Continuous
from primordia.random.keys import below, bits, chance
from primordia.random.wide import Wide
from primordia.settings.base import Settings
from primordia.settings.fields import first_fault


def _listed(value: Any) -> Any:
    return (value,) if isinstance(value, str) else value


Ticks = Annotated[int, Field(ge=1, lt=2**31)]
Factor = Annotated[float, Field(gt=0)]
Numbers = Annotated[
    tuple[Annotated[int, Field(ge=0)], ...],
    Field((), strict=False, description="numbers of those that change, from 0; []: all"),
]


class Change(Settings):
    """One thing that changes within a life. The subclasses say what; these settings say when."""

    at: tuple[Ticks, ...] = Field(
        (), strict=False, description="ages at which it changes, in ticks"
    )
    every: tuple[Ticks, Ticks] | None = Field(
        None,
        strict=False,
        description="shortest and longest period in ticks; each body draws its own at birth",
    )
    chance: float = Field(0.0, ge=0, le=1, description="probability that it changes in a tick")

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        if (bool(self.at) + (self.every is not None) + (self.chance > 0)) != 1:
            raise ValueError("say when it changes, by one of at, every and chance")
        if self.every is not None and self.every[0] > self.every[1]:
            raise ValueError("every: the shortest period is longer than the longest")
        return self

    def period(self, word: Array) -> Array:
        """Return the period in ticks, drawn with words (N,): int32 (N,); 0 without a period."""
        if self.every is None:
            return jnp.zeros(word.shape, jnp.int32)
        first, last = self.every
        return first + below(word, last - first + 1)

    def comes(self, age: Array, period: Array, word: Array) -> Array:
        """Return for which bodies it changes at an age in ticks, int32 (N,): bool (N,)."""
        if self.every is not None:
            return age % period == 0
        if self.at:
            return (age[:, None] == jnp.array(self.at, jnp.int32)).any(axis=1)
        return chance(word, jnp.float32(self.chance))

    def check(self, habitat: AnyHabitat) -> None:
        """Raise ValueError if the habitat has nothing that could change in this way."""

    def first(self, kind: Action, count: int) -> Array:
        """Return the state at birth of N bodies, for actions of this kind: (N, ...)."""
        return jnp.zeros(count, bool)

    def next(self, state: Array, key: Wide, age: Array, draw: int) -> Array:
        """Return the state after a change; `key` (N,), `age` and `draw` identify the bodies' draws."""
        return ~state

    def act(self, kind: Action, state: Array, action: Array) -> Array:
        """Return what the bodies do if the organisms choose these actions."""
        return action

    def sense(self, state: Array, senses: Array) -> Array:
        """Return what the organisms perceive of these senses, float32 (N, S)."""
        return senses

    def scale(self, names: tuple[str, ...], state: Array, factors: Array) -> Array:
        """Return the factors, float32 (N, P), of the habitat's parameters with these names."""
        return factors


class ReverseActions(Change):
    """Choices are counted from the last one, or amounts have the other sign; then as at birth again."""

    kind: Literal["reverse-actions"] = Field(
        description="choices in reverse order, amounts negated"
    )

    def check(self, habitat: AnyHabitat) -> None:
        """Raise ValueError if the actions have several parts."""
        _need_one_part(habitat)

    def act(self, kind: Action, state: Array, action: Array) -> Array:
        """Return the reversed actions where `state`, bool (N,), is true."""
        if isinstance(kind, Continuous):
            return jnp.where(state[:, None], -action, action)
        return jnp.where(state, kind.size - 1 - action, action)


class PermuteActions(Change):
    """Choices, or amounts, are in a new random order."""

    kind: Literal["permute-actions"] = Field(description="choices or amounts in a new random order")

    def check(self, habitat: AnyHabitat) -> None:
        """Raise ValueError if the actions have several parts."""
        _need_one_part(habitat)

    def first(self, kind: Action, count: int) -> Array:
        """Return the order at birth, int32 (N, A)."""
        return jnp.tile(jnp.arange(kind.size, dtype=jnp.int32), (count, 1))

    def next(self, state: Array, key: Wide, age: Array, draw: int) -> Array:
        """Return a new order."""
        choices = jnp.arange(state.shape[1], dtype=jnp.uint32)
        words = word_of(key, age, draw, choices[None])
        return jnp.argsort(words, axis=1).astype(jnp.int32)

    def act(self, kind: Action, state: Array, action: Array) -> Array:
        """Return the actions in the order of `state`."""
        if isinstance(kind, Continuous):
            return jnp.take_along_axis(action, state, axis=1)
        return jnp.take_along_axis(state, action[:, None], axis=1)[:, 0]


class Weaken(Change):
    """Amounts are multiplied by a new random factor, as in a leg that weakens."""

    kind: Literal["weaken"] = Field(description="amounts times a random factor")
    of: Numbers = ()
    range: tuple[float, float] = Field(
        (0.0, 1.0), strict=False, description="least and largest factor"
    )

    def check(self, habitat: AnyHabitat) -> None:
        """Raise ValueError if the actions are not amounts, or there are fewer."""
        if not isinstance(habitat.action, Continuous):
            raise ValueError("the actions of this habitat are not amounts")
        _need_order(self.range)
        _need(self.of, habitat.action.size)

    def first(self, kind: Action, count: int) -> Array:
        """Return the factors at birth, float32 (N, A)."""
        return jnp.ones((count, kind.size), jnp.float32)

    def next(self, state: Array, key: Wide, age: Array, draw: int) -> Array:
        """Return new factors; one factor for all amounts that weaken."""
        factor = _uniform(word_of(key, age, draw), *self.range)
        return jnp.where(_chosen(self.of, state.shape[1]), factor[:, None], np.float32(1))

    def act(self, kind: Action, state: Array, action: Array) -> Array:
        """Return the weakened amounts."""
        return state * action


class InvertSenses(Change):
    """Senses have the other sign; then as at birth again."""

    kind: Literal["invert-senses"] = Field(description="senses with the other sign")
    of: Numbers = ()

    def check(self, habitat: AnyHabitat) -> None:
        """Raise ValueError if there are fewer senses."""
        _need(self.of, habitat.senses_size)

    def sense(self, state: Array, senses: Array) -> Array:
        """Return the senses, inverted where `state`, bool (N,), is true."""
        inverted = state[:, None] & _chosen(self.of, senses.shape[1])
        return jnp.where(inverted, -senses, senses)


class Parameter(Change):
    """Physical parameters of the habitat are those at birth times a new random factor."""

    kind: Literal["parameter"] = Field(description="physical parameters times a random factor")
    of: Annotated[tuple[str, ...], BeforeValidator(_listed)] = Field(
        min_length=1,
        strict=False,
        description="name of the one that changes, or a list of those that change by the same factor",
    )
    range: tuple[Factor, Factor] = Field(strict=False, description="least and largest factor")

    def check(self, habitat: AnyHabitat) -> None:
        """Raise InputError if the habitat does not offer these parameters, and ValueError if the
        least factor is above the largest."""
        check_parameters(habitat, "of", self.of)
        _need_order(self.range)

    def first(self, kind: Action, count: int) -> Array:
        """Return the factors at birth, float32 (N,)."""
        return jnp.ones(count, jnp.float32)

    def next(self, state: Array, key: Wide, age: Array, draw: int) -> Array:
        """Return new factors."""
        return _uniform(word_of(key, age, draw), *self.range)

    def scale(self, names: tuple[str, ...], state: Array, factors: Array) -> Array:
        """Return the factors, times those of `state`, (N,), for the parameters that change."""
        return jnp.where(np.isin(names, self.of), factors * state[:, None], factors)


Kind: TypeAlias = Annotated[
    ReverseActions | PermuteActions | Weaken | InvertSenses | Parameter, Field(discriminator="kind")
]


def word_of(key: Wide, age: Array, draw: int, index: Array | None = None) -> Array:
    """Return a word for each body, or for each index (1, K) of each body: uint32 (N,) or (N, K).

    Args:
        key: keys of the bodies, (N,).
        age: int32 (N,).
        draw: number of the draw in this tick.
        index: uint32 (1, K).
    """
    own = bits(key, age, draw)
    return own.hi if index is None else bits(own.take(np.s_[:, None]), index).hi


def _uniform(word: Array, least: float, most: float) -> Array:
    share = (word >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)
    return np.float32(least) + np.float32(most - least) * share


def _chosen(of: tuple[int, ...], size: int) -> np.ndarray:
    """Return which of `size` numbers change, bool (size,)."""
    return np.isin(np.arange(size), of) if of else np.ones(size, bool)


def _need(of: tuple[int, ...], size: int) -> None:
    if max(of, default=0) >= size:
        raise ValueError(f"of: there is no number {max(of)}; the last is {size - 1}")


def _need_order(range: tuple[float, float]) -> None:
    if range[0] > range[1]:
        raise ValueError("range: the least factor is above the largest")


def _need_one_part(habitat: AnyHabitat) -> None:
    if isinstance(habitat.action, Compound):
        raise ValueError("the actions of this habitat have several parts")


_LIST: TypeAdapter[tuple[Kind, ...]] = TypeAdapter(tuple[Kind, ...])


def changes_of(tables: Any, habitat: AnyHabitat) -> tuple[Kind, ...]:
    """Return the changes that the setting `habitat.change` describes.

    Raises:
        InputError: a setting is wrong, or the habitat has nothing that could change in this way.
    """
    if not isinstance(tables, list | tuple) or not tables:
        raise InputError(
            "habitat.change: write a list of changes, such as [[habitat.change]] in TOML"
        )
    try:
        changes = _LIST.validate_python(tuple(tables))
    except ValidationError as error:
        raise InputError(first_fault(error, Change, "habitat.change")) from None
    check_parameters(habitat)
    for number, change in enumerate(changes):
        try:
            change.check(habitat)
        except (ValueError, InputError) as error:
            raise InputError(f"habitat.change.{number}: {error}") from None
    return changes
