"""Chunks with a habitat that runs on the host: one compiled call a tick, the habitat between them.

The call settles a tick and at once thinks the next one for those who live on; that thought is not yet
part of the state, so a chunk may end anywhere. Only ticks with births take a second call, for
the newborn's first thought.
"""

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia import events as log
from primordia.chunk import Limits, State, named_leaves, running
from primordia.events import Events
from primordia.genesis import birth_words
from primordia.habitats import HostHabitat, Outcome
from primordia.law import Law, judge, keys_of, lifeless, no_fates, rest, settle, think
from primordia.world import World


class Thought(NamedTuple):
    """What `think` changes, kept beside the state until the tick is lived."""

    memory: Array
    faulty: Array
    action: Array


class Decision(NamedTuple):
    """What the host needs of a tick."""

    active: Array
    """bool (C,): who is to be stepped next"""
    born: Array
    """bool (C,): who needs a body"""
    words: Array
    """uint32 (C, words) to make it from"""
    go_on: Array
    """bool (): some world runs, and the lists have room"""


class Hosted:
    """Law compiled, habitat on the host. The bodies live in the habitat; the state holds senses."""

    def __init__(self, law: Law, habitat: HostHabitat) -> None:
        self.exact = getattr(habitat, "exact", True)
        self._law, self._habitat = law, habitat
        self._tick = jax.jit(partial(_tick, law, habitat.words), donate_argnums=(0, 1))
        self._think = jax.jit(partial(_think, law))
        self._genesis = jax.jit(partial(_genesis, law, habitat.words), donate_argnums=(0, 1))
        habitat.open(law.worlds * law.cells)

    def begin(self, world: World) -> State:
        """The state of a run before genesis."""
        cells = len(world.organisms.alive)
        return State(world, np.zeros((cells, self._habitat.senses_size), np.float32))

    def advance(
        self, state: State, events: Events, limits: Limits, ticks: int
    ) -> tuple[State, Events, int]:
        """At most so many ticks, fewer if every world stops or the lists are full.

        Returns:
            state, what happened, ticks done.
        """
        events = Events(*(rows._replace(filled=jnp.int32(0)) for rows in events))
        world, events, decision = self._genesis(state.world, events, limits)
        senses = self._embody(np.array(state.bodies), decision)
        thought, done = self._think(world, senses), 0
        while done < ticks and decision.go_on:
            action = np.asarray(thought.action)
            senses, outcome = self._habitat.step(action, np.asarray(decision.active))
            world, events, thought, decision = self._tick(
                world, events, thought, senses, outcome, limits
            )
            if np.asarray(decision.born).any():
                senses = self._embody(senses, decision)
                thought = self._think(world, senses)
            done += 1
        return State(world, senses), events, done

    def _embody(self, senses: np.ndarray, decision: Decision) -> np.ndarray:
        born = np.flatnonzero(decision.born)
        if len(born):
            senses[born] = self._habitat.reset(born, np.asarray(decision.words)[born])
        return senses

    def save(self, state: State) -> dict[str, np.ndarray]:
        """All that is needed to go on exactly, by name."""
        bodies = {f"bodies.{name}": array for name, array in self._habitat.save().items()}
        bodies["bodies.senses"] = np.asarray(state.bodies)
        return {
            f"world.{name}": np.asarray(leaf) for name, leaf in named_leaves(state.world)
        } | bodies

    def load(self, template: State, arrays: dict[str, np.ndarray]) -> State:
        """Take back what `save` gave; `template` is any state of the same run."""
        leaves = [jnp.array(arrays[f"world.{name}"]) for name, _ in named_leaves(template.world)]
        prefix, senses = "bodies.", arrays["bodies.senses"]
        bodies = {n.removeprefix(prefix): a for n, a in arrays.items() if n.startswith(prefix)}
        bodies.pop("senses")
        self._habitat.load(bodies)
        return State(jax.tree.unflatten(jax.tree.structure(template.world), leaves), senses)


def _think(law: Law, world: World, senses: Array) -> Thought:
    after, action = think(law, world, senses, keys_of(world.worlds, jnp.int32(1)))
    return Thought(after.organisms.memory, after.organisms.faulty, action)


def _genesis(
    law: Law, words: int, world: World, events: Events, limits: Limits
) -> tuple[World, Events, Decision]:
    """Founders where a running world is empty, before the first tick; else nothing."""
    nobody = jnp.zeros_like(world.organisms.alive)
    live_worlds = running(world.worlds, limits)
    world, events, born = lax.cond(
        lifeless(law, world, live_worlds).any(),
        lambda world, events: settle(law, world, events, no_fates(law), jnp.int32(0), live_worlds),
        lambda world, events: (world, events, nobody),
        world,
        events,
    )
    return world, events, _decide(law, words, world, events, born, limits)


def _tick(
    law: Law,
    words: int,
    world: World,
    events: Events,
    thought: Thought,
    senses: Array,
    outcome: Outcome,
    limits: Limits,
) -> tuple[World, Events, Thought, Decision]:
    live_worlds = running(world.worlds, limits)
    active = world.organisms.alive & law.per_cell(live_worlds)
    organisms = world.organisms._replace(memory=thought.memory, faulty=thought.faulty)
    lost = ~jnp.isfinite(senses).all(axis=1)
    fault = lost if outcome.fault is None else lost | outcome.fault
    keys = keys_of(world.worlds, jnp.int32(1))
    after = World(organisms, world.worlds)
    after, fates = judge(law, after, outcome._replace(fault=fault), keys, active)
    world = World(rest(world.organisms, after.organisms, active), after.worlds)
    world, events, born = settle(law, world, events, fates, jnp.int32(1), live_worlds)
    decision = _decide(law, words, world, events, born, limits)
    return world, events, _think(law, world, senses), decision


def _decide(
    law: Law, words: int, world: World, events: Events, born: Array, limits: Limits
) -> Decision:
    live_worlds = running(world.worlds, limits)
    room = log.have_room(events, law.worlds * law.cells, law.worlds)
    return Decision(
        active=world.organisms.alive & law.per_cell(live_worlds),
        born=born,
        words=birth_words(law, world.worlds, born.any(), words),
        go_on=live_worlds.any() & room,
    )
