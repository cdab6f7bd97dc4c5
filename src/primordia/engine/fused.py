"""Chunks with a habitat in JAX: law and habitat fused into one compiled loop."""

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.brains.layout import BODY
from primordia.compiled import shared
from primordia.engine.state import Limits, State, filled, named_leaves, running, ticks_left
from primordia.habitats.archipelago import ArchipelagoInJax, Parts, split
from primordia.habitats.bodies import insert_bodies, placeholder_bodies, select_bodies
from primordia.habitats.contract import Bodies, JaxHabitat
from primordia.law import events as log
from primordia.law.events import Events
from primordia.law.genesis import begin, words_of
from primordia.law.law import Law
from primordia.law.moments import remember
from primordia.law.population import settle
from primordia.law.tick import Fates, judge, keys_of, no_fates, rest, think
from primordia.law.world import World
from primordia.random.keys import Purpose, stream


class FusedChunks:
    """Law and habitat in one compiled loop, which overwrites the state that it is given."""

    exact = True
    """True if a run goes on exactly from a checkpoint."""

    def __init__(self, law: Law, habitat: JaxHabitat) -> None:
        self._law, self._habitat = law, habitat
        self._advance = shared(advance, law.compiled, habitat, donate=(0, 1))
        self.events = log.empty(law)
        """events of the latest chunk"""

    def begin(self, seeds: np.ndarray) -> State:
        """Return the state of a run before genesis, from the worlds' seeds, uint64 (W,)."""
        world = begin(self._law, seeds)
        return State(world, placeholder_bodies(self._habitat, len(world.organisms.alive)))

    def advance(self, state: State, limits: Limits, ticks: int) -> tuple[State, int]:
        """Advance by this number of ticks, or fewer if every world stops or the lists are full.

        Returns:
            state; the number of ticks advanced.
        """
        state, self.events, done = self._advance(state, self.events, limits, jnp.int32(ticks))
        return state, int(done)

    def save(self, state: State) -> dict[str, np.ndarray]:
        """Return the arrays of the whole state, by name."""
        return {name: np.asarray(leaf) for name, leaf in named_leaves(state)}

    def load(self, template: State, arrays: dict[str, np.ndarray]) -> State:
        """Return the state that `save` stored; `template` is any state of the same run."""
        return filled(template, arrays)


def advance(
    law: Law, habitat: JaxHabitat, state: State, events: Events, limits: Limits, ticks: Array
) -> tuple[State, Events, Array]:
    """Advance worlds by at most this number of ticks. Return state, events, and ticks done, int32 ()."""

    def go_on(carry: tuple) -> Array:
        _, events, live_worlds, done = carry
        return (done < ticks) & live_worlds.any() & log.have_room(law, events)

    def advance_to_next_event(carry: tuple) -> tuple:
        state, events, live_worlds, done = carry
        at_most = jnp.minimum(ticks - done, ticks_left(law, state.world, limits, live_worlds))
        state, fates, passed = _quiet(law, habitat, state, live_worlds, at_most)
        world, events, newborn = settle(law, state.world, events, fates, passed, live_worlds)
        bodies = _embody(law, habitat, world, state.bodies, newborn)
        state = State(remember(law, world, habitat.sense(bodies), live_worlds), bodies)
        return state, events, running(world.worlds, limits), done + passed

    carry = (state, log.emptied(events), running(state.world.worlds, limits), jnp.int32(0))
    state, events, _, done = lax.while_loop(go_on, advance_to_next_event, carry)
    return state, events, done


def _quiet(
    law: Law, habitat: JaxHabitat, state: State, live_worlds: Array, at_most: Array
) -> tuple[State, Fates, Array]:
    """Live ticks up to and including the first eventful tick, but at most `at_most` ticks.

    Returns:
        state; fates of the last tick; number of ticks, int32 ().
    """
    first = state.world
    active = first.organisms.alive & law.per_cell(live_worlds)

    def go_on(carry: tuple) -> Array:
        _, _, fates, _, passed = carry
        return (passed < at_most) & ~fates.eventful

    def tick(carry: tuple) -> tuple:
        world, bodies, _, keys, passed = carry
        thought = think(law, world, habitat.sense(bodies), keys)
        bodies, outcome = habitat.step(bodies, thought.action)
        world, fates = judge(law, world, thought, bodies, outcome, keys, active)
        return world, bodies, fates, keys_of(first.worlds, passed + 2), passed + 1

    keys = keys_of(first.worlds, jnp.int32(1))
    carry = (first, state.bodies, no_fates(law), keys, jnp.int32(0))
    world, bodies, fates, _, passed = lax.while_loop(go_on, tick, carry)
    organisms = rest(first.organisms, world.organisms, active)
    bodies = select_bodies(active, bodies, state.bodies)
    return State(World(organisms, world.worlds), bodies), fates, passed


def _embody(law: Law, habitat: JaxHabitat, world: World, bodies: Bodies, newborn: Array) -> Bodies:
    """Insert fresh bodies for the newborn, bool (C,), on each island."""
    if not isinstance(habitat, ArchipelagoInJax):
        return _embody_in(law, habitat, world, range(law.cells), bodies, newborn)
    islands = zip(
        habitat.habitats,
        law.islands.cells,
        bodies.island,
        split(newborn, bodies.sizes),
        strict=True,
    )
    parts = (_embody_in(law, own, world, cells, of, here) for own, cells, of, here in islands)
    return Parts(tuple(parts), bodies.sizes)


def _embody_in(
    law: Law, habitat: JaxHabitat, world: World, cells: range, bodies: Bodies, newborn: Array
) -> Bodies:
    """Insert fresh bodies into `cells` of each world, in batches, since bodies may be expensive.

    `bodies` and `newborn`, bool (W x len(cells),), are those of these cells.
    """
    key = stream(world.worlds.seed, Purpose.BODY, world.worlds.tick)
    genome = world.organisms.genome

    def one_batch(rows: Array, valid: Array, carry: tuple[Bodies]) -> tuple[Bodies]:
        of, cell = rows // len(cells), rows % len(cells) + cells.start
        own = {name: genome[name][of * law.cells + cell] for name in genome if name == BODY}
        words = words_of(law, own, key.take(of), cell, habitat.words)
        where = jnp.where(valid, rows, len(newborn))
        return (insert_bodies(carry[0], where, habitat.reset(words)),)

    return log.for_each(newborn, (bodies,), one_batch)[0]
