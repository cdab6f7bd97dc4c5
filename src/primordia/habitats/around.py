"""Habitats made of others, and habitats around another one.

Those around another habitat pass everything on, except what a subclass changes.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from primordia.habitats.contract import Action, AnyHabitat, Habitat, HostHabitat, JaxHabitat

Method = TypeVar("Method", bound=Callable)


def _passed_on(method: Method) -> Method:
    """Return a method that calls the inner habitat's method of the same name."""

    @wraps(method, updated=())  # without the mark of an abstract method
    def call(self: "Around", *given: Any, **named: Any) -> Any:
        return getattr(self.inner, method.__name__)(*given, **named)

    return call  # type: ignore[return-value]


class Composed(Habitat):
    """A habitat made of others: its properties are attributes. Equal ones share compiled code."""

    senses_size: int
    action: Action
    words: int
    versions: dict[str, str]
    rate: float | None
    episode: int | None
    tallies: tuple[str, ...]
    exact: bool
    buttons: tuple[str, ...] | None
    _key: tuple

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Composed) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)


class Around(Composed):
    """The properties and pictures of the inner habitat."""

    def __init__(self, inner: AnyHabitat, *own: Any) -> None:
        """Wrap a habitat; `own` are all settings of the wrapper, which can be compared and hashed."""
        self.inner: Any = inner
        self._key = (type(self), inner, own)
        self.senses_size, self.action, self.words = inner.senses_size, inner.action, inner.words
        self.versions, self.rate, self.episode = inner.versions, inner.rate, inner.episode
        self.tallies, self.exact, self.buttons = inner.tallies, inner.exact, inner.buttons

    @property
    def parameters(self) -> tuple[str, ...]:
        """Return the names of the inner habitat's physical parameters."""
        return self.inner.parameters

    lacks = _passed_on(Habitat.lacks)
    picture = _passed_on(Habitat.picture)
    picture_scaled = _passed_on(Habitat.picture_scaled)
    caption = _passed_on(Habitat.caption)

    def original(self) -> AnyHabitat | None:
        """Return the inner habitat as the standard benchmark scores it, without this wrapper."""
        return self.inner.original()


class AroundJax(Around, JaxHabitat):
    """A habitat in JAX around another."""

    inner: JaxHabitat

    reset = _passed_on(JaxHabitat.reset)
    sense = _passed_on(JaxHabitat.sense)
    step = _passed_on(JaxHabitat.step)
    step_scaled = _passed_on(JaxHabitat.step_scaled)


class AroundHost(Around, HostHabitat):
    """A habitat on the host around another."""

    inner: HostHabitat

    open = _passed_on(HostHabitat.open)
    reset = _passed_on(HostHabitat.reset)
    step = _passed_on(HostHabitat.step)
    close = _passed_on(HostHabitat.close)
    seen = _passed_on(HostHabitat.seen)
    set_factors = _passed_on(HostHabitat.set_factors)
    tally = _passed_on(HostHabitat.tally)
    message = _passed_on(HostHabitat.message)
    save = _passed_on(HostHabitat.save)
    load = _passed_on(HostHabitat.load)


def inside(habitat: AnyHabitat, kind: type) -> Any:
    """Return the habitat itself, or the one inside it, that is of a kind; None if there is none."""
    while isinstance(habitat, Around):
        if isinstance(habitat, kind):
            return habitat
        habitat = habitat.inner
    return habitat if isinstance(habitat, kind) else None


def innermost(habitat: AnyHabitat) -> AnyHabitat:
    """Return the habitat without all that is around it."""
    while isinstance(habitat, Around):
        habitat = habitat.inner
    return habitat
