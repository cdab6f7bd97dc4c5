"""Speed of environments with gymnax's interface: against our own CartPole, and against a bare loop.

The loop maps `step_env` over all bodies in one compiled scan, with actions drawn at random: it has no
brains, no law, and no body is ever born. Ways take turns.
"""

import time
from collections.abc import Callable
from functools import partial
from typing import Any

import jax
from jax import Array, lax

from primordia.config import load
from primordia.engine.engine import Engine
from primordia.habitats.gymnax import libraries
from primordia.random.wide import to_host
from worlds import advanced, median, rate

CARTPOLES = {"ours": {"name": "cartpole"}, "gymnax": {"name": "gymnax", "env": "CartPole-v1"}}
SHAPES = {"1 x 32": (32, 1), "16 x 32": (32, 16)}
CRAFTAX = "Craftax-Classic-Symbolic-v1"
UNDYING = 'state["player_health"] < -1000'
SIZES = 32, 128
ROUNDS = 5
SECONDS = 2.0
SETTLED = 20_000
TICKS = 50
"""Ticks in one call of the loop."""


def against_our_cartpole() -> list[dict]:
    """Measure worlds of CartPole of gymnax and of ours, evolved for SETTLED ticks, in turn."""
    rows = []
    for name, (cells, worlds) in SHAPES.items():
        settings = {"cells": cells, "seeds": worlds, "genesis": "fill"}
        made = {
            way: advanced(
                Engine(load("CartPole-survival", {**settings, "habitat": habitat})), SETTLED
            )
            for way, habitat in CARTPOLES.items()
        }
        rates = {way: [] for way in made}
        for _ in range(ROUNDS):
            for way, engine in made.items():
                rates[way].append(rate(engine, SECONDS))
        rows.append({"worlds x cells": name, **_compared(rates, "ours")})
    return rows


def against_the_bare_loop() -> list[dict]:
    """Measure the bare loop of Craftax-Classic, and our worlds without deaths and as shipped, in turn."""
    rows = []
    for cells in SIZES:
        settings = {"cells": cells, "genesis": "fill"}
        habitat = {"name": "gymnax", "env": CRAFTAX}
        shipped = Engine(load("Craftax-Classic-survival", settings))
        undying = {**settings, "habitat": {**habitat, "fatal": UNDYING}}
        ways: dict[str, Callable[[], float]] = {
            "bare": bare(CRAFTAX, cells),
            "ours": partial(stepped, Engine(load("Craftax-Classic-survival", undying))),
            "as shipped": partial(stepped, shipped),
        }
        rates: dict[str, list[float]] = {way: [] for way in ways}
        for _ in range(ROUNDS):
            for way, measured in ways.items():
                rates[way].append(measured())
        rows.append({"cells": cells, **_compared(rates, "bare")})
    return rows


def stepped(made: Engine) -> float:
    """Return cells times ticks per second: the simulators of empty cells are stepped too."""

    def ticks() -> int:
        return int(to_host(made.state.world.worlds.tick).sum())

    limits = made.limits({})
    made.advance(limits)
    began, before = time.perf_counter(), ticks()
    while time.perf_counter() - began < SECONDS:
        made.advance(limits)
    jax.block_until_ready(made.state)
    return made.config.cells * (ticks() - before) / (time.perf_counter() - began)


def bare(name: str, cells: int) -> Callable[[], float]:
    """Return a measurement of body-ticks per second of the loop of an environment."""
    env = libraries.make(name, time_limit=False)
    params = env.default_params
    space = env.action_space(params)

    def drawn(key: Array) -> Array:
        if hasattr(space, "n"):
            return jax.random.randint(key, (cells,), 0, space.n)
        return jax.random.uniform(key, (cells, *space.shape), minval=space.low, maxval=space.high)

    def tick(carry: tuple[Array, Any], _: None) -> tuple[Any, Array]:
        key, states = carry
        key, acting, stepping = jax.random.split(key, 3)
        step = jax.vmap(lambda *given: env.step_env(*given, params))
        seen, states, *_ = step(jax.random.split(stepping, cells), states, drawn(acting))
        return (key, states), seen[:, :1].sum()

    @jax.jit
    def play(key: Array, states: Any) -> Any:
        return lax.scan(tick, (key, states), None, length=TICKS)

    keys = jax.random.split(jax.random.key(0), cells)
    states = jax.jit(jax.vmap(lambda key: env.reset_env(key, params)))(keys)[1]

    def measured() -> float:
        nonlocal states
        done, began = 0, time.perf_counter()
        while time.perf_counter() - began < SECONDS:
            (_, states), _ = jax.block_until_ready(play(jax.random.key(done), states))
            done += TICKS
        return cells * done / (time.perf_counter() - began)

    for number in range(3):  # compiles twice if the types of the first state are weak
        (_, states), _ = jax.block_until_ready(play(jax.random.key(number), states))
    return measured


def _compared(rates: dict[str, list[float]], to: str) -> dict[str, Any]:
    """Return the medians of rates, and of their ratios to those of one way, round by round."""
    ratios = {
        way: median([a / b for a, b in zip(values, rates[to], strict=True)])
        for way, values in rates.items()
        if way != to
    }
    return {"rates": {way: median(values) for way, values in rates.items()}, f"of {to}": ratios}
