"""The arithmetic limit: brains and bodies of a task in one compiled scan, with no law at all.

Nobody is born, dies, is counted or recorded. No implementation of a law around the same brain and
habitat can be faster, so `bench.py` quotes organism-ticks per second as a fraction of this.
"""

from functools import partial

import jax
import jax.numpy as jnp
from jax import Array, lax

from primordia.brain import BrainSettings, Genome
from primordia.habitats.cartpole import CartPole
from primordia.motor import argmax


@partial(jax.jit, static_argnames=("ticks",), donate_argnums=(1, 2))
def limit(genome: Genome, memory: Array, bodies: tuple, ticks: int) -> tuple:
    """Advance CartPole brains and bodies `ticks` ticks; -> (memory, bodies)."""
    habitat = CartPole()
    brain = BrainSettings().build(habitat.senses_size, habitat.action.size)

    def tick(carry: tuple, _: None) -> tuple:
        memory, bodies = carry
        memory, output = brain(genome, memory, habitat.sense(bodies))
        bodies, _ = habitat.step(bodies, argmax(output))
        return (memory, bodies), None

    return lax.scan(tick, (memory, bodies), None, length=ticks)[0]


def start(cells: int) -> tuple:
    """Random genomes (scale 0.1), empty memories and fresh bodies for `cells` organisms."""
    habitat = CartPole()
    brain = BrainSettings().build(habitat.senses_size, habitat.action.size)
    keys = jax.random.split(jax.random.key(0), len(brain.blocks) + 1)
    genome = {
        name: 0.1 * jax.random.normal(key, (cells, *shape), jnp.float32)
        for key, (name, shape) in zip(keys[1:], brain.blocks.items(), strict=True)
    }
    words = jax.random.bits(keys[0], (cells, habitat.words), jnp.uint32)
    return genome, jnp.zeros((cells, brain.memory), jnp.float32), habitat.reset(words)
