"""Chunks with a habitat that runs on the host: one compiled call a tick, the habitat between them.

The call judges a tick and at once thinks the next one. A quiet tick needs no more; one with an event, or
in which something falls due, is settled by a second call, and the newborn take a third for their first
thought. What ticks change is kept beside the state until it is settled, so a chunk may end anywhere.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.engine.calls import Calls, Decision, Since
from primordia.engine.held import Form, Held
from primordia.engine.state import Limits, State, named_leaves
from primordia.engine.tallies import Tallies
from primordia.habitats.contract import Ability, HostHabitat
from primordia.law import events as log
from primordia.law.genesis import body_words
from primordia.law.law import Law
from primordia.law.life import Thought
from primordia.law.tick import no_fates
from primordia.law.world import World
from primordia.random.keys import Purpose, stream


class Hosted:
    """Law compiled, habitat on the host. The bodies live in the habitat; the state holds senses."""

    def __init__(self, law: Law, habitat: HostHabitat) -> None:
        self.exact = habitat.exact
        self._law, self._habitat = law, habitat
        self._tallies = Tallies(habitat, law.worlds)
        self._lists = log.empty(law)
        self.events = self._lists
        """of the latest chunk"""
        habitat.open(law.worlds * law.cells)

    def begin(self, world: World) -> State:
        """The state of a run before genesis."""
        self._no_fates = no_fates(self._law)
        self._calls = Calls(self._law, Form.of(world), self._habitat.words)
        cells = len(world.organisms.alive)
        return State(world, np.zeros((cells, self._habitat.senses_size), np.float32))

    def advance(self, state: State, limits: Limits, ticks: int) -> tuple[State, int]:
        """At most so many ticks, fewer if every world stops or the lists are full -> ticks done."""
        self._tallies.begin()
        genome, held = state.world.organisms.genome, self._calls.hold(state.world)
        events, senses, done = log.emptied(self._lists), np.array(state.bodies), 0
        decision = self._calls.survey(genome, held, events, limits)
        thought = self._calls.think(genome, held, senses)
        while done < ticks and decision.go_on:
            most = min(int(decision.due), ticks - done)
            since, thought, senses = self._quiet(
                genome, held, thought, senses, decision.active, most
            )
            done += int(since.ticks)
            genome, events, held, decision = self._calls.settle(genome, events, held, since, limits)
            self._tallies.note_deaths(np.asarray(decision.died))
            if np.asarray(decision.newborn).any():
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
    ) -> tuple[Since, Thought, np.ndarray]:
        """Live ticks up to and with the first eventful one, at most `most`; none before genesis.

        Returns:
            what was lived; what is thought next; senses, float32 (C, S).
        """
        now, fates, passed, alive = held, self._no_fates, 0, np.asarray(active)
        # np.asarray is three times as fast as asking JAX's array itself.
        while passed < most and not np.asarray(fates.eventful):
            senses, outcome = self._habitat.step(np.asarray(thought.action), alive)
            passed += 1
            now, thought, fates = self._calls.live(
                genome, now, thought, senses, outcome, active, np.int32(passed)
            )
        return Since(now, fates, np.int32(passed)), thought, senses

    def _embody(self, senses: np.ndarray, decision: Decision) -> np.ndarray:
        newborn = np.flatnonzero(decision.newborn)
        senses[newborn] = self._habitat.reset(newborn, np.asarray(decision.words)[newborn])
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
        world = jax.tree.unflatten(jax.tree.structure(template.world), leaves)
        if not self._habitat.can(Ability.SAVE):
            return State(world, self._as_at_birth(world, senses))
        self._habitat.load(bodies)
        return State(world, senses)

    def _as_at_birth(self, world: World, senses: np.ndarray) -> np.ndarray:
        """Give the living the bodies that they were born with, where theirs cannot be stored."""
        alive, senses, seed = (
            np.flatnonzero(world.organisms.alive),
            senses.copy(),
            world.worlds.seed,
        )
        key = stream(seed.map(self._law.per_cell), Purpose.BODY, world.organisms.born)
        words = np.asarray(body_words(key, self._law.cell_numbers, self._habitat.words))
        if len(alive):
            senses[alive] = self._habitat.reset(alive, words[alive])
        return senses
