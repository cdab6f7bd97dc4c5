"""Chunks with a habitat that runs on the host: one compiled call a tick, the habitat between them.

The call judges a tick and at once thinks the next one. A quiet tick needs no more; one with an event, or
in which something falls due, is settled by a second call, and the newborn take a third for their first
thought. What ticks change is kept beside the state until it is settled, so a chunk may end anywhere.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.compiled import shared
from primordia.engine.held import Form, Held
from primordia.engine.state import Limits, State, named_leaves, running, ticks_left
from primordia.engine.tallies import Tallies
from primordia.habitats.contract import HostHabitat, Outcome
from primordia.law import events as log
from primordia.law.events import Events
from primordia.law.genesis import birth_words
from primordia.law.law import Law
from primordia.law.life import Fates, judge, keys_of, no_fates, think
from primordia.law.population import rest, settle
from primordia.law.sample import width
from primordia.law.world import World


class Thought(NamedTuple):
    """What `think` gives."""

    memory: Array
    faulty: Array
    action: Array


class Decision(NamedTuple):
    """What the host needs of a tick that is settled."""

    alive: Array
    """bool (C,)"""
    active: Array
    """bool (C,): who is to be stepped next"""
    died: Array
    """bool (C,): whose life has ended"""
    born: Array
    """bool (C,): who needs a body"""
    words: Array
    """uint32 (C, words) to make it from"""
    go_on: Array
    """bool (): some world runs, and the lists have room"""
    due: Array
    """int32 (): ticks after which the world is to be settled at the latest"""


class Calls:
    """What is compiled: of the law, for bodies that take so many random words."""

    def __init__(self, law: Law, words: int, form: Form) -> None:
        self.hold, self.release = shared(Form.hold, form), shared(Form.release, form)
        self.think = shared(_think, law, form)
        self.live = shared(_live, law, form)
        self.look = shared(_look, law, form, words)
        self.settle = shared(_settle, law, form, words, donate=(0, 1))


class Hosted:
    """Law compiled, habitat on the host. The bodies live in the habitat; the state holds senses."""

    def __init__(self, law: Law, habitat: HostHabitat) -> None:
        self.exact = getattr(habitat, "exact", True)
        self._law, self._habitat = law, habitat
        self._tallies = Tallies(habitat, law.worlds)
        self._lists = log.empty(law.worlds * law.cells, law.worlds, width(law.blocks))
        self.events = self._lists
        """of the latest chunk"""
        habitat.open(law.worlds * law.cells)

    def begin(self, world: World) -> State:
        """The state of a run before genesis."""
        self._no_fates = no_fates(self._law)
        self._calls = Calls(self._law, self._habitat.words, Form.of(world))
        cells = len(world.organisms.alive)
        return State(world, np.zeros((cells, self._habitat.senses_size), np.float32))

    def advance(self, state: State, limits: Limits, ticks: int) -> tuple[State, int]:
        """At most so many ticks, fewer if every world stops or the lists are full -> ticks done."""
        self._tallies.begin()
        genome, held = state.world.organisms.genome, self._calls.hold(state.world)
        events, senses, done = log.emptied(self._lists), np.array(state.bodies), 0
        decision = self._calls.look(genome, held, events, limits)
        thought = self._calls.think(genome, held, senses)
        while done < ticks and decision.go_on:
            most = min(int(decision.due), ticks - done)
            thought, senses, now, fates, passed = self._quiet(
                genome, held, thought, senses, decision.active, most
            )
            done += passed
            genome, events, held, decision = self._calls.settle(
                genome, events, held, now, fates, np.int32(passed), limits
            )
            self._tallies.note_deaths(np.asarray(decision.died))
            if np.asarray(decision.born).any():
                senses = self._embody(senses, decision)
                thought = self._calls.think(genome, held, senses)
            self._tallies.note_samples(decision.alive, events.samples)
        self._lists, self.events = events, self._tallies.beside(events)
        return State(self._released(genome, held), senses), done

    def _released(self, genome: Genome, held: Held) -> World:
        """The world again; its genomes do not pass through a call, which would copy them."""
        world = self._calls.release(held, {})
        return world._replace(organisms=world.organisms._replace(genome=genome))

    def _quiet(
        self,
        genome: Genome,
        held: Held,
        thought: Thought,
        senses: np.ndarray,
        active: Array,
        most: int,
    ) -> tuple[Thought, np.ndarray, Held, Fates, int]:
        """Ticks up to and with the first eventful one, at most so many; none before genesis.

        Returns:
            what is thought next, senses, the world not settled yet, fates of the last tick, how many
            ticks.
        """
        now, fates, passed, alive = held, self._no_fates, 0, np.asarray(active)
        # Three times as fast as asking JAX's array itself.
        while passed < most and not np.asarray(fates.eventful):
            senses, outcome = self._habitat.step(np.asarray(thought.action), alive)
            passed += 1
            now, thought, fates = self._calls.live(
                genome, now, thought, senses, outcome, active, np.int32(passed)
            )
        return thought, senses, now, fates, passed

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


def _think(law: Law, form: Form, genome: Genome, held: Held, senses: Array) -> Thought:
    world = form.release(held, genome)
    after, action = think(law, world, senses, keys_of(world.worlds, jnp.int32(1)))
    return Thought(after.organisms.memory, after.organisms.faulty, action)


def _live(
    law: Law,
    form: Form,
    genome: Genome,
    now: Held,
    thought: Thought,
    senses: Array,
    outcome: Outcome,
    active: Array,
    passed: Array,
) -> tuple[Held, Thought, Fates]:
    """The tick so many after the last settled one is judged, and the next one thought."""
    world = form.release(now, genome)
    organisms = world.organisms._replace(memory=thought.memory, faulty=thought.faulty)
    lost = ~jnp.isfinite(senses).all(axis=1)
    fault = lost if outcome.fault is None else lost | outcome.fault
    keys = keys_of(world.worlds, passed)
    outcome = outcome._replace(fault=fault)
    world, fates = judge(law, world._replace(organisms=organisms), outcome, keys, active)
    after, action = think(law, world, senses, keys_of(world.worlds, passed + 1))
    thought = Thought(after.organisms.memory, after.organisms.faulty, action)
    return form.hold(world), thought, fates


def _look(
    law: Law, form: Form, words: int, genome: Genome, held: Held, events: Events, limits: Limits
) -> Decision:
    """How things stand where nobody has died and nobody is born."""
    world = form.release(held, genome)
    nobody = jnp.zeros_like(world.organisms.alive)
    return _decide(law, words, world, events, nobody, nobody, limits)


def _settle(
    law: Law,
    form: Form,
    words: int,
    genome: Genome,
    events: Events,
    held: Held,
    now: Held,
    fates: Fates,
    passed: Array,
    limits: Limits,
) -> tuple[Genome, Events, Held, Decision]:
    """Bring a world, as it was held after the last settled tick, up to date by what was lived since."""
    before, after = form.release(held, genome), form.release(now, genome)
    live_worlds = running(before.worlds, limits)
    active = before.organisms.alive & law.per_cell(live_worlds)
    world = World(rest(before.organisms, after.organisms, active), after.worlds)
    world, events, born = settle(law, world, events, fates, passed, live_worlds)
    died = before.organisms.alive & (~world.organisms.alive | born)
    decision = _decide(law, words, world, events, died, born, limits)
    return world.organisms.genome, events, form.hold(world), decision


def _decide(
    law: Law, words: int, world: World, events: Events, died: Array, born: Array, limits: Limits
) -> Decision:
    live_worlds = running(world.worlds, limits)
    room = log.have_room(events, law.worlds * law.cells, law.worlds)
    alive = world.organisms.alive
    return Decision(
        alive=alive,
        active=alive & law.per_cell(live_worlds),
        died=died,
        born=born,
        words=birth_words(law, world.worlds, born.any(), words),
        go_on=live_worlds.any() & room,
        due=ticks_left(law, world, limits, live_worlds),
    )
