"""Chunks with a habitat in JAX: law and habitat fused into one compiled loop."""

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.engine.state import Limits, State, named_leaves, running, ticks_left
from primordia.habitats.contract import Bodies, Habitat
from primordia.law import events as log
from primordia.law.events import Events
from primordia.law.genesis import birth_words
from primordia.law.law import Law
from primordia.law.life import Fates, judge, keys_of, no_fates, think
from primordia.law.population import rest, settle
from primordia.law.sample import width
from primordia.law.world import World


class Fused:
    """Law and habitat in one compiled loop. A state given to it is used up."""

    exact = True
    """Whether a run goes on exactly from a checkpoint."""

    def __init__(self, law: Law, habitat: Habitat) -> None:
        self._law, self._habitat = law, habitat
        self._advance = shared(_advance, law, habitat, donate=(0, 1))
        self.events = log.empty(law.worlds * law.cells, law.worlds, width(law.layout.names))
        """of the latest chunk"""

    def begin(self, world: World) -> State:
        """The state of a run before genesis."""
        words = np.zeros((len(world.organisms.alive), self._habitat.words), np.uint32)
        return State(world, shared(fresh, self._habitat)(words))

    def advance(self, state: State, limits: Limits, ticks: int) -> tuple[State, int]:
        """At most so many ticks, fewer if every world stops or the lists are full -> ticks done."""
        state, self.events, done = self._advance(state, self.events, limits, jnp.int32(ticks))
        return state, int(done)

    def save(self, state: State) -> dict[str, np.ndarray]:
        """All that is needed to go on exactly, by name."""
        return {name: np.asarray(leaf) for name, leaf in named_leaves(state)}

    def load(self, template: State, arrays: dict[str, np.ndarray]) -> State:
        """Take back what `save` gave; `template` is any state of the same run."""
        leaves = [jnp.asarray(arrays[name]) for name, _ in named_leaves(template)]
        return jax.tree.unflatten(jax.tree.structure(template), leaves)


def fresh(habitat: Habitat, words: Array) -> Bodies:
    """Bodies from random words uint32 (N, words); to be compiled, as in the loop.

    Operation by operation, a product and a sum are each rounded; compiled, they may be rounded once.
    """
    return habitat.reset(words)


def _advance(
    law: Law, habitat: Habitat, state: State, events: Events, limits: Limits, ticks: Array
) -> tuple[State, Events, Array]:
    cells = law.worlds * law.cells

    def go_on(carry: tuple) -> Array:
        _, events, live_worlds, done = carry
        return (done < ticks) & live_worlds.any() & log.have_room(events, cells, law.worlds)

    def until_something_happens(carry: tuple) -> tuple:
        state, events, live_worlds, done = carry
        at_most = jnp.minimum(ticks - done, ticks_left(law, state.world, limits, live_worlds))
        state, fates, passed = _quiet(law, habitat, state, live_worlds, at_most)
        world, events, born = settle(law, state.world, events, fates, passed, live_worlds)
        state = State(world, _embody(law, habitat, world, state.bodies, born))
        return state, events, running(world.worlds, limits), done + passed

    carry = (state, log.emptied(events), running(state.world.worlds, limits), jnp.int32(0))
    state, events, _, done = lax.while_loop(go_on, until_something_happens, carry)
    return state, events, done


def _quiet(
    law: Law, habitat: Habitat, state: State, live_worlds: Array, at_most: Array
) -> tuple[State, Fates, Array]:
    """Ticks up to and with the first eventful one, at most so many -> state, fates, ticks."""
    first = state.world
    active = first.organisms.alive & law.per_cell(live_worlds)

    def go_on(carry: tuple) -> Array:
        _, _, fates, _, passed = carry
        return (passed < at_most) & ~fates.eventful

    def tick(carry: tuple) -> tuple:
        world, bodies, _, keys, passed = carry
        world, action = think(law, world, habitat.sense(bodies), keys)
        bodies, outcome = habitat.step(bodies, action)
        fault = broken(bodies) if outcome.fault is None else broken(bodies) | outcome.fault
        world, fates = judge(law, world, outcome._replace(fault=fault), keys, active)
        return world, bodies, fates, keys_of(first.worlds, passed + 2), passed + 1

    keys = keys_of(first.worlds, jnp.int32(1))
    carry = (first, state.bodies, no_fates(law), keys, jnp.int32(0))
    world, bodies, fates, _, passed = lax.while_loop(go_on, tick, carry)
    organisms = rest(first.organisms, world.organisms, active)
    bodies = choose(active, bodies, state.bodies)
    return State(World(organisms, world.worlds), bodies), fates, passed


def _embody(law: Law, habitat: Habitat, world: World, bodies: Bodies, born: Array) -> Bodies:
    """Fresh bodies for the newborn."""
    words = birth_words(law, world.worlds, born.any(), habitat.words)

    def embodied(bodies: Bodies, words: Array) -> Bodies:
        return choose(born, fresh(habitat, words), bodies)

    return lax.cond(born.any(), embodied, lambda bodies, _: bodies, bodies, words)


def choose(cells: Array, yes: Bodies, no: Bodies) -> Bodies:
    """Bodies `yes` in the given cells (C,), `no` elsewhere."""

    def leaf(a: Array, b: Array) -> Array:
        return jnp.where(cells.reshape(-1, *[1] * (a.ndim - 1)), a, b)

    return jax.tree.map(leaf, yes, no)


def broken(bodies: Bodies) -> Array:
    """Which bodies (C,) have a coordinate that is no finite number."""
    leaves = [leaf for leaf in jax.tree.leaves(bodies) if jnp.issubdtype(leaf.dtype, jnp.floating)]
    flat = [(~jnp.isfinite(leaf.reshape(len(leaf), -1))).any(axis=1) for leaf in leaves]
    return jnp.stack(flat).any(axis=0) if flat else jnp.zeros((), bool)
