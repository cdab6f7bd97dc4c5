"""Habitats that change within a life: a wrapper around any habitat; see `change`."""

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.habitats.around import AroundHost, AroundJax, inside
from primordia.habitats.bodies import select_bodies
from primordia.habitats.change import Kind, Parameter, word_of
from primordia.habitats.contract import Action, AnyHabitat, Bodies, JaxHabitat, Outcome
from primordia.random.wide import Wide

if TYPE_CHECKING:
    from PIL.Image import Image

WORDS = 2
"""Random words of a birth from which the changes of a body follow: the last ones."""
COURSE = "course"
"""Beginning of the names of a course's arrays in a checkpoint."""


class Course(NamedTuple):
    """The changes of N bodies so far; C changes in the order of the settings."""

    key: Wide
    """key of a body's own draws, (N,)"""
    age: Array
    """ticks since birth, int32 (N,)"""
    period: Array
    """int32 (N, C), 0 for a change without a period"""
    times: Array
    """how often each change has come, int32 (N, C)"""
    state: tuple[Array, ...]
    """state of each change, (N, ...); see `Change.first`"""


class Changed(NamedTuple):
    """Bodies of a habitat in JAX that changes within a life."""

    inner: Bodies
    course: Course


def begin(changes: tuple[Kind, ...], kind: Action, words: Array) -> Course:
    """Return the courses of newborn bodies, from the words of their births, uint32 (N, words)."""
    key, age = Wide(words[:, -2], words[:, -1]), jnp.zeros(len(words), jnp.int32)
    periods = [change.period(word_of(key, age, 2 * i)) for i, change in enumerate(changes)]
    counts = jnp.zeros((len(words), len(changes)), jnp.int32)
    states = tuple(change.first(kind, len(words)) for change in changes)
    return Course(key, age, jnp.stack(periods, axis=1), counts, states)


def advance(changes: tuple[Kind, ...], course: Course) -> Course:
    """Return the courses one tick later."""
    key, age = course.key, course.age + 1
    counts, states = [], []
    for i, (change, state) in enumerate(zip(changes, course.state, strict=True)):
        comes = _comes(change, i, key, age, course.period)
        after = lax.cond(  # random draws are made in ticks with a change only
            comes.any(), lambda s, n=2 * i + 1, c=change: c.next(s, key, age, n), lambda s: s, state
        )
        counts.append(course.times[:, i] + comes)
        states.append(select_bodies(comes, after, state))
    return course._replace(age=age, times=jnp.stack(counts, axis=1), state=tuple(states))


def _comes(change: Kind, number: int, key: Wide, age: Array, period: Array) -> Array:
    """Return for which bodies a change comes at an age, bool (N,); `period` is (N, C)."""
    return change.comes(age, period[:, number], word_of(key, age, 2 * number))


def act(changes: tuple[Kind, ...], kind: Action, course: Course, action: Array) -> Array:
    """Return what bodies do if their organisms choose these actions."""
    for change, state in zip(changes, course.state, strict=True):
        action = change.act(kind, state, action)
    return action


def sense(changes: tuple[Kind, ...], course: Course, senses: Array) -> Array:
    """Return what organisms perceive of these senses, float32 (N, S)."""
    for change, state in zip(changes, course.state, strict=True):
        senses = change.sense(state, senses)
    return senses


def factors_of(changes: tuple[Kind, ...], names: tuple[str, ...], course: Course) -> Array:
    """Return the factors of the habitat's parameters with these names, float32 (N, P)."""
    factors = jnp.ones((len(course.age), len(names)), jnp.float32)
    for change, state in zip(changes, course.state, strict=True):
        factors = change.scale(names, state, factors)
    return factors


class _Changing:
    """What changing habitats in JAX and on the host have in common."""

    inner: Any
    action: Action
    parameters: ClassVar = ()  # they change already

    def __init__(self, inner: Any, changes: tuple[Kind, ...]) -> None:
        super().__init__(inner, changes)  # type: ignore[call-arg]
        self.changes, self.words = changes, inner.words + WORDS
        scales = any(isinstance(change, Parameter) for change in changes)
        self.scaled = inner.parameters if scales else ()

    def picture(self, body: Changed, action: np.ndarray) -> "Image":
        """Return the wrapped habitat's picture of the body and of what it did, changes included.

        In the tick of a change, the picture shows what the same choice does from then on.
        """
        course, chosen = jax.tree.map(lambda leaf: leaf[None], (body.course, np.asarray(action)))
        done = np.asarray(act(self.changes, self.action, course, chosen))[0]
        if not self.scaled:
            return self.inner.picture(body.inner, done)
        return self.inner.picture_scaled(body.inner, done, self._factors_now(body))

    def _factors_now(self, body: Changed) -> np.ndarray:
        """Return the factors of the parameters of one body, float32 (P,)."""
        course = jax.tree.map(lambda leaf: leaf[None], body.course)
        return np.asarray(factors_of(self.changes, self.scaled, course))[0]

    def caption(self, body: Changed, action: np.ndarray) -> str:
        """Return the wrapped habitat's caption, how often the world changed, and the factors now."""
        count = int(np.sum(body.course.times))
        parts = [
            self.inner.caption(body.inner, action),
            f"{count} change{'' if count == 1 else 's'}",
        ]
        named = zip(self.scaled, self._factors_now(body), strict=True)
        parts += [f"{name} x {factor:.2f}" for name, factor in named if factor != 1]
        return ", ".join(parts)


class ChangingInJax(_Changing, AroundJax):
    """A habitat in JAX whose world changes within a life."""

    def reset(self, words: Array) -> Changed:
        """Return fresh bodies; see `JaxHabitat.reset`."""
        course = begin(self.changes, self.action, words)
        return Changed(self.inner.reset(words[:, :-WORDS]), course)

    def sense(self, bodies: Changed) -> Array:
        """Return the senses; see `JaxHabitat.sense`."""
        return sense(self.changes, bodies.course, self.inner.sense(bodies.inner))

    def step(self, bodies: Changed, action: Array) -> tuple[Changed, Outcome]:
        """Step all bodies by one tick; see `JaxHabitat.step`."""
        done = act(self.changes, self.action, bodies.course, action)
        if self.scaled:
            factors = factors_of(self.changes, self.scaled, bodies.course)
            inner, outcome = self.inner.step_scaled(bodies.inner, done, factors)
        else:
            inner, outcome = self.inner.step(bodies.inner, done)
        return Changed(inner, advance(self.changes, bodies.course)), outcome


class ChangingOnHost(_Changing, AroundHost):
    """A habitat on the host whose world changes within a life."""

    def open(self, cells: int, watched: bool = False) -> None:
        """Allocate a body for each of N cells; see `HostHabitat.open`."""
        self.inner.open(cells, watched)
        made = (begin, _begin_again, act)
        self._begin, self._again, self._act = (
            shared(each, self.changes, self.action) for each in made
        )
        self._sense, self._after = (shared(each, self.changes) for each in (sense, _after))
        self._factors_of = shared(factors_of, self.changes, self.scaled)
        self._course = self._begin(np.zeros((cells, WORDS), np.uint32))
        self._factors = np.ones((cells, len(self.scaled)), np.float32)

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells (K,); see `HostHabitat.reset`."""
        everywhere = np.zeros((len(self._course.age), WORDS), np.uint32)
        everywhere[cells] = words[:, -WORDS:]  # one shape is compiled once
        newborn = np.zeros(len(everywhere), bool)
        newborn[cells] = True
        self._course = self._again(self._course, newborn, everywhere)
        self._scale()  # the last body of a cell may have left other factors
        return self.inner.reset(cells, words[:, :-WORDS])  # nothing has changed yet

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies of living cells; see `HostHabitat.step`."""
        done = np.asarray(self._act(self._course, action))
        senses, outcome = self.inner.step(done, alive)
        self._course, senses = self._after(self._course, alive, senses)
        self._scale()
        return np.array(senses), outcome

    def _scale(self) -> None:
        """Tell the wrapped habitat the factors of the bodies for which they are new."""
        if not self.scaled:
            return
        factors = np.asarray(self._factors_of(self._course))
        cells = np.flatnonzero((factors != self._factors).any(axis=1))
        if len(cells):
            self.inner.set_factors(cells, factors[cells])
        self._factors = factors

    def seen(self) -> Changed:
        """Return the bodies of the wrapped habitat, and their courses."""
        return Changed(self.inner.seen(), jax.tree.map(np.asarray, self._course))

    def save(self) -> dict[str, np.ndarray]:
        """Return the arrays of the wrapped habitat, and those of the courses."""
        leaves = enumerate(jax.tree.leaves(self._course))
        return self.inner.save() | {f"{COURSE}{i}": np.asarray(leaf) for i, leaf in leaves}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore what `save` returned."""
        own = jax.tree.leaves(self._course)
        leaves = [jax.device_put(np.array(arrays[f"{COURSE}{i}"])) for i in range(len(own))]
        self._course = jax.tree.unflatten(jax.tree.structure(self._course), leaves)
        self._scale()
        self.inner.load(
            {name: each for name, each in arrays.items() if not name.startswith(COURSE)}
        )


def _begin_again(
    changes: tuple[Kind, ...], kind: Action, course: Course, newborn: Array, words: Array
) -> Course:
    """Return the courses with fresh ones for the newborn, bool (N,)."""
    return select_bodies(newborn, begin(changes, kind, words), course)


def _after(
    changes: tuple[Kind, ...], course: Course, alive: Array, senses: Array
) -> tuple[Course, Array]:
    """Return the courses of living bodies one tick later, and what organisms perceive of the senses."""
    course = select_bodies(alive, advance(changes, course), course)
    return course, sense(changes, course, senses)


def changing(habitat: AnyHabitat, changes: tuple[Kind, ...]) -> AnyHabitat:
    """Return the habitat with changes within each life."""
    if isinstance(habitat, JaxHabitat):
        return ChangingInJax(habitat, changes)
    return ChangingOnHost(habitat, changes)


def changes_at(habitat: AnyHabitat, body: Bodies, ages: np.ndarray) -> np.ndarray:
    """Return at which ages the world of a body changes, in the past or the future: bool (n,).

    Args:
        habitat: the habitat.
        body: one body, no first axis, as a picture takes it.
        ages: int (n,), ticks.
    """
    found = inside(habitat, _Changing)
    if found is None:
        return np.zeros(len(ages), bool)
    own = body.course.key, body.course.period
    return np.asarray(shared(_come_at, found.changes)(*own, np.asarray(ages, np.int32)))


def _come_at(changes: tuple[Kind, ...], key: Wide, period: Array, age: Array) -> Array:
    """Return at which ages int32 (n,) any change comes, from a body's key () and periods (C,)."""
    keys = key.map(lambda word: jnp.broadcast_to(word, age.shape))
    periods = jnp.broadcast_to(period, (len(age), len(changes)))
    comes = [_comes(change, i, keys, age, periods) for i, change in enumerate(changes)]
    return jnp.stack(comes).any(axis=0) & (age > 0)


def is_changing(habitat: AnyHabitat) -> bool:
    """Return whether the habitat's world changes within a life."""
    return inside(habitat, _Changing) is not None
