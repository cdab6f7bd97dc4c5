"""Chunks with a habitat on the host, which is stepped between compiled calls.

Each tick has one compiled call, which judges this tick and then thinks for the next tick. A tick
without events needs no other call. A tick with an event, or with a change that is due, is settled
by a second call. Two further calls draw the words of newborn bodies, and compute the first
thought of the newborn. The changes of unsettled ticks are kept beside the state, so a chunk may
end at any tick.
"""

import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.engine.calls import Calls, Unsettled
from primordia.engine.held import NO_BULK, Bulk, Form, Held
from primordia.engine.messages import Messages
from primordia.engine.state import Limits, State, filled, named_leaves
from primordia.engine.tallies import Tallies
from primordia.errors import InputError, Trouble
from primordia.habitats.checks import check_outcome
from primordia.habitats.contract import Ability, HostHabitat
from primordia.law import events as log
from primordia.law.genesis import begin
from primordia.law.law import Law
from primordia.law.life import Thought
from primordia.law.tick import no_fates
from primordia.law.world import World
from primordia.settings.tracing import Tracing


class HostedChunks:
    """A compiled law, and a habitat on the host that owns the bodies; `State.bodies` holds senses."""

    _unseen: frozenset[str] = frozenset()
    """functions of the habitat whose first results will be checked, since it may be the user's"""

    def __init__(self, law: Law, habitat: HostHabitat) -> None:
        self.exact = habitat.exact
        self._law, self._habitat = law, habitat
        self._tallies, self._messages = Tallies(habitat, law.worlds), Messages(habitat, law.cells)
        self._unseen = frozenset(("reset", "step"))
        self._lists = log.empty(law)
        self.events = self._lists
        """events of the latest chunk"""
        habitat.open(law.worlds * law.cells)

    def begin(self, seeds: np.ndarray) -> State:
        """Return the state of a run before genesis, from the worlds' seeds, uint64 (W,)."""
        world = begin(self._law, seeds)
        self._no_fates = no_fates(self._law)
        self._calls = Calls(self._law.compiled, Form.of(world), self._habitat.words)
        cells = len(world.organisms.alive)
        return State(world, np.zeros((cells, self._habitat.senses_size), np.float32))

    def advance(self, state: State, limits: Limits, ticks: int) -> tuple[State, int]:
        """Advance by at most `ticks`, fewer if every world stops or the lists are full.

        Returns:
            state; the number of ticks advanced.
        """
        self._tallies.begin()
        self._messages.begin()
        bulk, held = Bulk.of(state.world), self._calls.hold(state.world)
        events, senses, done = log.emptied(self._lists), np.array(state.bodies), 0
        decision = self._calls.survey(bulk.genome, held, events, limits)
        thought = self._calls.think(bulk.genome, held, senses)
        while done < ticks and decision.go_on:
            most = min(int(decision.due), ticks - done)
            rests = np.flatnonzero(np.asarray(decision.alive) & ~np.asarray(decision.active))
            before = senses[rests]  # a copy: the habitat may return the same array each time
            unsettled, thought, senses = self._quiet(
                bulk.genome, held, thought, senses, decision.active, most
            )
            senses[rests] = before
            done += int(unsettled.ticks)
            bulk, events, held, decision = self._calls.settle(bulk, events, held, unsettled, limits)
            self._tallies.note_deaths(np.asarray(decision.died))
            self._messages.note_deaths(np.asarray(decision.died))
            if np.asarray(decision.newborn).any():
                words = self._calls.words(bulk.genome, held)
                senses = self._born(senses, np.flatnonzero(decision.newborn), words)
                thought = self._calls.think(bulk.genome, held, senses)
            if np.asarray(decision.remembered):
                bulk = self._calls.remember(bulk, held, senses, decision.ran)
            self._tallies.note_samples(decision.alive, events.samples)
        self._lists, self.events = events, self._tallies.added_to(events)
        return State(self._release(bulk, held), senses), done

    @property
    def faults(self) -> list[str]:
        """A line for each organism whose body failed in the latest chunk, if the habitat says why."""
        return self._messages.of(self.events.deaths)

    def _release(self, bulk: Bulk, held: Held) -> World:
        """Return the world. Its bulk passes through no compiled call, which would copy it."""
        world = self._calls.release(held, NO_BULK)
        return world._replace(organisms=world.organisms._replace(**bulk._asdict()))

    def _quiet(
        self,
        genome: Genome,
        held: Held,
        thought: Thought,
        senses: np.ndarray,
        active: Array,
        most: int,
    ) -> tuple[Unsettled, Thought, np.ndarray]:
        """Live up to and including the first eventful tick, but at most `most` ticks.

        `most` is 0 before genesis.

        Returns:
            the ticks lived; the thought of the next tick; senses, float32 (C, S).
        """
        now, fates, passed, alive = held, self._no_fates, 0, np.asarray(active)
        # np.asarray is three times as fast as bool() of JAX's array.
        while passed < most and not np.asarray(fates.eventful):
            senses, outcome = self._habitat.step(np.asarray(thought.action), alive)
            if "step" in self._unseen:
                self._check("step", senses, len(alive))
                check_outcome(Tracing("habitat", self._habitat), outcome, len(alive))
            passed += 1
            now, thought, fates = self._calls.live(
                genome, now, thought, senses, outcome, active, np.int32(passed)
            )
        return Unsettled(now, fates, np.int32(passed)), thought, senses

    def _born(self, senses: np.ndarray, cells: np.ndarray, words: Array) -> np.ndarray:
        """Give the organisms of some cells new bodies, made of their rows of `words`; return senses."""
        if len(cells):
            given = self._habitat.reset(cells, np.asarray(words)[cells])
            if "reset" in self._unseen:
                self._check("reset", given, len(cells))
            senses[cells] = given
        return senses

    def _check(self, function: str, senses: np.ndarray, count: int) -> None:
        """Check the senses that `reset` or `step` returns; see `_unseen`."""
        shape = (count, self._habitat.senses_size)
        Tracing("habitat", self._habitat).typed(
            f"senses from {function}", senses, shape, np.float32
        )
        self._unseen -= {function}

    def save(self, state: State) -> dict[str, np.ndarray]:
        """Return the arrays of the whole state, with the habitat's bodies, by name."""
        bodies = {f"bodies.{name}": array for name, array in self._habitat.save().items()}
        bodies["bodies.senses"] = np.asarray(state.bodies)
        for name, array in bodies.items():
            Tracing("habitat", self._habitat).need(
                not np.asarray(array).dtype.hasobject,
                f"saves {name.removeprefix('bodies.')} as Python objects; save numbers or bytes",
            )
            rows = self._law.worlds * len(self._law.islands.with_rows(name))
            if np.shape(array)[:1] != (rows,):
                raise InputError(
                    f"habitat: save gives {name.removeprefix('bodies.')} of shape {np.shape(array)};"
                    f" the first axis must be the {rows} cells"
                )
        return {
            f"world.{name}": np.asarray(leaf) for name, leaf in named_leaves(state.world)
        } | bodies

    def load(self, template: State, arrays: dict[str, np.ndarray]) -> State:
        """Return the state that `save` stored; `template` is any state of the same run."""
        prefix, world = "bodies.", filled(template.world, arrays, "world.")
        senses = np.array(filled(template.bodies, arrays, "bodies.senses"))
        bodies = {n.removeprefix(prefix): a for n, a in arrays.items() if n.startswith(prefix)}
        bodies.pop("senses")
        if not self._habitat.can(Ability.SAVE):
            return State(world, self._reset_to_birth(world, senses))
        try:
            self._habitat.load(bodies)
        except (IndexError, KeyError, ValueError) as error:
            raise Trouble(
                f"the checkpoint does not fit this run: its bodies cannot be loaded: {error}"
            ) from None
        return State(world, senses)

    def _reset_to_birth(self, world: World, senses: np.ndarray) -> np.ndarray:
        """Reset the bodies of the living to birth, for a habitat that cannot save them; return senses."""
        words = self._calls.words(world.organisms.genome, self._calls.hold(world))
        return self._born(senses.copy(), np.flatnonzero(world.organisms.alive), words)
