"""The arithmetic limit: brains and bodies of a task in one compiled scan, with no law at all.

No organism is born, dies, is counted or recorded. No implementation of a law around the same brain and
habitat can be faster, so `bench.py` quotes organism-ticks per second as a fraction of this.
"""

from functools import partial

import jax
from jax import Array, lax

from primordia.brains.contract import Genome
from primordia.brains.recurrent import Recurrent
from primordia.habitats.cartpole.habitat import CartPole
from primordia.law.motor import argmax


@partial(jax.jit, static_argnames=("ticks",), donate_argnums=(1, 2))
def limit(genome: Genome, memory: Array, bodies: tuple, ticks: int) -> tuple:
    """Advance CartPole brains and bodies by `ticks` ticks and return their memory and bodies."""
    habitat, brain = CartPole(), Recurrent()

    def tick(carry: tuple, _: None) -> tuple:
        memory, bodies = carry
        memory, output = brain(genome, memory, habitat.sense(bodies))
        bodies, _ = habitat.step(bodies, argmax(output))
        return (memory, bodies), None

    return lax.scan(tick, (memory, bodies), None, length=ticks)[0]
