"""The compiled calls for a habitat on the host: think, judge, settle, and draw the words of bodies."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax.numpy as jnp
from jax import Array

from primordia.brains.contract import Genome
from primordia.compiled import shared
from primordia.engine.held import Bulk, Form, Held
from primordia.engine.state import Limits, running, ticks_left
from primordia.habitats.contract import Outcome
from primordia.law import events as log
from primordia.law.events import Events
from primordia.law.genesis import birth_words
from primordia.law.law import Law
from primordia.law.life import Thought
from primordia.law.moments import moment_due, remember
from primordia.law.population import settle
from primordia.law.tick import Fates, judge, keys_of, rest, think
from primordia.law.world import World


class Decision(NamedTuple):
    """The results of a settled tick that the host needs for the next ticks."""

    alive: Array
    """bool (C,): cells with an organism"""
    active: Array
    """bool (C,): cells to step next"""
    died: Array
    """bool (C,): cells whose organism died in the tick"""
    newborn: Array
    """bool (C,): cells whose organism was born in the tick, and needs a body"""
    ran: Array
    """bool (W,): worlds that ran in the tick"""
    remembered: Array
    """bool (): organisms remember a moment at the end of the tick"""
    go_on: Array
    """bool (): a world is running, and the lists have room"""
    due: Array
    """int32 (): the world must be settled within this number of ticks"""


class Calls:
    """Compiled functions of a law."""

    def __init__(self, law: Law, form: Form, words: int) -> None:
        """Compile for worlds of a packed form, and for bodies made from `words` random words."""
        steps = _Steps(law, form)
        self.hold, self.release = shared(Form.hold, form), shared(Form.release, form)
        self.think = shared(_Steps.think, steps)
        self.live = shared(_Steps.live, steps)
        self.survey = shared(_Steps.survey, steps)
        self.settle = shared(_Steps.settle, steps, donate=(0, 1))
        self.remember = shared(_Steps.remember, steps, donate=(0,))
        self.words = shared(_Steps.words, steps, words)


class Unsettled(NamedTuple):
    """The ticks lived since the last settled tick."""

    held: Held
    """the world after these ticks, not settled yet"""
    fates: Fates
    """fates of the latest tick"""
    ticks: Any
    """int32 (): number of these ticks"""


@dataclass(frozen=True)
class _Steps:
    law: Law
    form: Form

    def think(self, genome: Genome, held: Held, senses: Array) -> Thought:
        """Think for the first tick after a settled tick."""
        world = self.form.release(held, Bulk(genome, None))
        return think(self.law, world, senses, keys_of(world.worlds, jnp.int32(1)))

    def live(
        self,
        genome: Genome,
        now: Held,
        thought: Thought,
        senses: Array,
        outcome: Outcome,
        active: Array,
        passed: Array,
    ) -> tuple[Held, Thought, Fates]:
        """Judge a tick, think for the next; `passed` counts the ticks since the last settled one."""
        world = self.form.release(now, Bulk(genome, None))
        keys = keys_of(world.worlds, passed)
        world, fates = judge(self.law, world, thought, senses, outcome, keys, active)
        thought = think(self.law, world, senses, keys_of(world.worlds, passed + 1))
        return self.form.hold(world), thought, fates

    def survey(self, genome: Genome, held: Held, events: Events, limits: Limits) -> Decision:
        """Return the decision for a world in its present state, without deaths or births."""
        world = self.form.release(held, Bulk(genome, None))
        none = jnp.zeros_like(world.organisms.alive)
        return self._decide(world, events, none, none, jnp.zeros(self.law.worlds, bool), limits)

    def settle(
        self, bulk: Bulk, events: Events, held: Held, unsettled: Unsettled, limits: Limits
    ) -> tuple[Bulk, Events, Held, Decision]:
        """Settle the ticks since `held`, which is the world after the last settled tick."""
        law, before = self.law, self.form.release(held, bulk)
        after = self.form.release(unsettled.held, bulk)
        live_worlds = running(before.worlds, limits)
        active = before.organisms.alive & law.per_cell(live_worlds)
        world = World(rest(before.organisms, after.organisms, active), after.worlds)
        world, events, newborn = settle(
            law, world, events, unsettled.fates, unsettled.ticks, live_worlds
        )
        died = before.organisms.alive & (~world.organisms.alive | newborn)
        decision = self._decide(world, events, died, newborn, live_worlds, limits)
        return Bulk.of(world), events, self.form.hold(world), decision

    def remember(self, bulk: Bulk, held: Held, senses: Array, ran: Array) -> Bulk:
        """Store each organism's senses and memory of a settled tick, once the newborn have senses."""
        return Bulk.of(remember(self.law, self.form.release(held, bulk), senses, ran))

    def words(self, count: int, genome: Genome, held: Held) -> Array:
        """Return `count` words of each organism's body at birth, uint32 (C, count)."""
        return birth_words(self.law, self.form.release(held, Bulk(genome, None)), count)

    def _decide(
        self,
        world: World,
        events: Events,
        died: Array,
        newborn: Array,
        ran: Array,
        limits: Limits,
    ) -> Decision:
        law, alive = self.law, world.organisms.alive
        live_worlds = running(world.worlds, limits)
        room = log.have_room(law, events)
        return Decision(
            alive=alive,
            active=alive & law.per_cell(live_worlds),
            died=died,
            newborn=newborn,
            ran=ran,
            remembered=moment_due(law, world.worlds, ran).any(),
            go_on=live_worlds.any() & room,
            due=ticks_left(law, world, limits, live_worlds),
        )
