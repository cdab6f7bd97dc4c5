"""Games in a habitat on the host, played tick by tick."""

from collections.abc import Iterator
from contextlib import closing

import jax.numpy as jnp
import numpy as np

from primordia.compiled import shared
from primordia.habitats.contract import HostHabitat
from primordia.law.law import Law
from primordia.law.life import judge
from primordia.organism.mind import perceiver, think
from primordia.organism.playing.seats import Manner, Seats, Stretch, Thinking, begun, mark
from primordia.random.wide import wide


def stretches(
    law: Law,
    habitat: HostHabitat,
    seated: Seats,
    manner: Manner,
) -> Iterator[Stretch]:
    """Play games, a tick at a time; see `games.play`."""
    mind, memory, vitals, words = shared(begun, law, habitat.words)(seated)
    rates, count, frozen = seated.rates, len(words), manner.frozen
    think_tick, judge_tick, perceive = shared(think, law), shared(judge, law), perceiver(law)
    alive, faulty, spent = np.ones(count, bool), jnp.zeros(count, bool), None
    habitat.open(count)
    with closing(habitat):
        senses = np.array(habitat.reset(np.arange(count), np.asarray(words)))
        first = perceive(senses, vitals.energy)
        for tick in range(1, manner.ticks + 1):
            perceived = perceive(senses, vitals.energy)
            met = (
                Thinking(np.array(perceived)[None], np.asarray(memory)[None])
                if manner.watched
                else None
            )
            if manner.script is None:
                seen = perceived if frozen is None else np.where(frozen.senses, first, perceived)
                kept = memory if frozen is None else np.where(frozen.memory, 0, memory)
                thought = think_tick(mind, kept, seen, wide([tick]))
                memory, chosen, faulty, spent, _ = thought
                action = np.asarray(chosen)
            else:
                action = manner.script(tick)
            playing, marked = alive, mark(np.ascontiguousarray(senses, np.float32))
            senses, outcome = habitat.step(action, playing)
            vitals, cause = judge_tick(vitals, faulty, senses, outcome, rates, spent)
            alive = playing & (np.asarray(cause) < 0)
            food = None if outcome.food is None else np.array(outcome.food)[None]
            yield Stretch(playing[None], action[None].copy(), food, marked[None], alive, met)
