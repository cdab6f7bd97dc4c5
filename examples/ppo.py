"""Proximal policy optimisation (Schulman et al. 2017) in one of our worlds, beside evolution.

    python examples/ppo.py [SECONDS]

Reward is 1 for each tick that is lived. The same lives are then lived by the network that was trained and
by the champion of a run, which nobody rewarded. Needs optax (pip install optax).
"""

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import optax
from gymnasium.vector import AutoresetMode

import primordia
from primordia.envs import LifeEnv, LifeVectorEnv

TASK = "CartPole-survival"
ENVS, STEPS, EPOCHS, PARTS = 16, 128, 4, 4
DISCOUNT, TRACE, CLIP, OF_VALUE, OF_ENTROPY = 0.99, 0.95, 0.2, 0.5, 0.01
LONGEST, LIVES = 1000, 10
"""ticks after which a life is cut, and the number of lives that are compared"""


class Batch(NamedTuple):
    """What happened in some steps, first axis N."""

    senses: Any
    action: Any
    log_chance: Any
    advantage: Any
    target: Any


def network(senses: int, actions: int, hidden: int = 64) -> dict[str, Any]:
    """Return the weights of a policy and of a value function, each with two hidden layers."""
    draw = np.random.default_rng(0)

    def layers(out: int, last: float) -> list[tuple[np.ndarray, np.ndarray]]:
        sizes = [(senses, hidden, 1.4), (hidden, hidden, 1.4), (hidden, out, last)]
        return [
            (
                gain * draw.standard_normal((a, b)).astype(np.float32) / a**0.5,
                np.zeros(b, np.float32),
            )
            for a, b, gain in sizes
        ]

    return {"policy": layers(actions, 0.01), "value": layers(1, 1.0)}


def through(layers: Any, x: Any) -> Any:
    """Return the output of layers with tanh between them."""
    for weights, bias in layers[:-1]:
        x = jnp.tanh(x @ weights + bias)
    return x @ layers[-1][0] + layers[-1][1]


@jax.jit
def act(net: Any, senses: Any, key: Any) -> tuple[Any, Any, Any]:
    """Return actions, the logarithms of their chances, and values."""
    chances = jax.nn.log_softmax(through(net["policy"], senses))
    action = jax.random.categorical(key, chances)
    own = jnp.take_along_axis(chances, action[:, None], axis=1)[:, 0]
    return action, own, through(net["value"], senses)[:, 0]


def loss(net: Any, batch: Batch) -> Any:
    """Return the clipped objective, with the value's error and the entropy."""
    chances = jax.nn.log_softmax(through(net["policy"], batch.senses))
    own = jnp.take_along_axis(chances, batch.action[:, None], axis=1)[:, 0]
    ratio = jnp.exp(own - batch.log_chance)
    advantage = (batch.advantage - batch.advantage.mean()) / (batch.advantage.std() + 1e-8)
    kept = jnp.minimum(ratio * advantage, jnp.clip(ratio, 1 - CLIP, 1 + CLIP) * advantage)
    error = (through(net["value"], batch.senses)[:, 0] - batch.target) ** 2
    entropy = -(jnp.exp(chances) * chances).sum(axis=1)
    return (OF_VALUE * error - kept - OF_ENTROPY * entropy).mean()


def train(seconds: float) -> dict[str, Any]:
    """Return the network after some seconds of training."""
    envs = LifeVectorEnv(TASK, ENVS, reward=1.0, autoreset_mode=AutoresetMode.DISABLED)
    spaces: Any = envs.single_observation_space, envs.single_action_space
    net = network(spaces[0].shape[0], int(spaces[1].n))
    adam = optax.chain(optax.clip_by_global_norm(0.5), optax.adam(2.5e-4))
    state, key = adam.init(net), jax.random.key(0)

    @jax.jit
    def improve(net: Any, state: Any, batch: Batch) -> tuple[Any, Any]:
        change, state = adam.update(jax.grad(loss)(net, batch), state)
        return optax.apply_updates(net, change), state

    senses, order = envs.reset(seed=0)[0], np.random.default_rng(0)
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        key, own = jax.random.split(key)
        batch, senses = rollout(envs, net, senses, own)
        for _ in range(EPOCHS):
            for rows in np.split(order.permutation(ENVS * STEPS), PARTS):
                net, state = improve(net, state, Batch(*(each[rows] for each in batch)))
    envs.close()
    return net


def rollout(envs: LifeVectorEnv, net: Any, senses: Any, key: Any) -> tuple[Batch, Any]:
    """Live STEPS ticks in all environments -> what is learned from, and the present senses."""
    told = []
    for step in range(STEPS):
        action, chance, value = map(np.asarray, act(net, senses, jax.random.fold_in(key, step)))
        after, reward, died, _, _ = envs.step(action)
        told.append((senses, action, chance, value, reward, died))
        senses = envs.reset(options={"reset_mask": died})[0] if died.any() else after
    seen, action, chance, value, reward, died = map(np.array, zip(*told, strict=True))
    following, gain = np.asarray(act(net, senses, key)[2]), np.zeros(ENVS)
    advantage = np.zeros_like(value)
    for step in reversed(range(STEPS)):
        error = reward[step] + DISCOUNT * following * ~died[step] - value[step]
        gain = error + DISCOUNT * TRACE * ~died[step] * gain
        advantage[step], following = gain, value[step]
    parts = seen, action, chance, advantage, advantage + value
    return Batch(*(each.reshape(ENVS * STEPS, *each.shape[2:]) for each in parts)), senses


def lifespans(policy: Callable[[np.ndarray], Any]) -> list[int]:
    """Return the lengths of LIVES lives, cut at LONGEST ticks; memory is cleared before each."""
    env, lived = LifeEnv(TASK), []
    for life in range(LIVES):
        getattr(policy, "reset", lambda: None)()
        senses, _ = env.reset(seed=1_000_000 + life)
        ticks, died = 0, False
        while not died and ticks < LONGEST:
            senses, _, died, _, _ = env.step(policy(senses))
            ticks += 1
        lived.append(ticks)
    return lived


def main(seconds: float) -> None:
    """Train and evolve for as long, and print how long both live."""
    net = train(seconds)
    trained = lifespans(lambda senses: int(through(net["policy"], senses).argmax()))
    with tempfile.TemporaryDirectory() as folder:
        run = primordia.run(TASK, Path(folder) / "run", stop={"ticks": 30_000})
        champion = lifespans(run.oldest().policy())
    for name, lived in (("trained", trained), ("evolved", champion)):
        print(
            f"{name}: median {np.median(lived):,.0f} ticks of at most {LONGEST:,}: {sorted(lived)}"
        )


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0)
