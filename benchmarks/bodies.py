"""What inherited bodies cost: worlds with traits beside worlds whose bodies are all alike, in pairs.

The traits mutate, so bodies differ. Organisms die by accident only, so both worlds have as many births. A
row for robots has the time of a newborn's model, and one for each game of MinAtar the speed of its bare
simulator.
"""

import statistics
import time
from functools import partial
from typing import Any

import jax
import numpy as np

from islands import compared
from primordia import compiled
from primordia.config import load
from primordia.habitats.mujoco.adjustable import Adjustable

PAIRS, BODIES = 7, 256
LIMBS = {
    "hind-thigh": ["geom.bthigh.size[1]", "geom.bthigh.pos", "body.bshin.pos"],
    "fore-thigh": ["geom.fthigh.size[1]", "geom.fthigh.pos", "body.fshin.pos"],
}
ALIVE: dict[str, Any] = {"genesis": "fill", "replication": 0.2, "hazard": 0.002}
WORLDS: dict[str, tuple[str, dict[str, Any], dict[str, Any], int]] = {
    "CartPole, 1,024 cells": (
        "CartPole-survival",
        {"cells": 1024, **ALIVE, "habitat": {"angle_limit": 180.0, "track_limit": 1e9}},
        {"habitat": {"traits": {"pole-length": {"least": 0.5, "most": 2.0}}}},
        20_000,
    ),
    "HalfCheetah, 256 cells": (
        "HalfCheetah-forager",
        {"cells": BODIES, **ALIVE, "metabolism": "none"},
        {
            "habitat": {
                "adjustable": LIMBS,
                "traits": {name: {"least": 0.7, "most": 1.4} for name in LIMBS},
            }
        },
        300,
    ),
}
GAMES = "Asterix", "Breakout", "Freeway", "SpaceInvaders", "Seaquest"


def against_equal_bodies() -> list[dict]:
    """Return the seconds of worlds with traits as multiples of those of worlds without."""
    rows = []
    for name, (task, settings, traits, ticks) in WORLDS.items():
        plain = load(task, settings)
        habitat = {**settings.get("habitat", {}), **traits["habitat"]}
        own = load(task, {**settings, "habitat": habitat})
        rows.append({"world": name, **compared("with_traits", [own], [plain], ticks)})
    return rows


def models() -> dict:
    """Return the milliseconds in which the model of a half-cheetah is compiled."""
    made = Adjustable("gymnasium:half_cheetah.xml", None, {k: tuple(v) for k, v in LIMBS.items()})
    factors = np.random.default_rng(0).uniform(0.7, 1.4, (BODIES, 6)).tolist()
    began = time.perf_counter()
    for each in factors:
        made.model(tuple(each))
    return {"a model, ms": 1000 * (time.perf_counter() - began) / BODIES}


def bare_games() -> list[dict]:
    """Return the steps a second of the bodies of each game of MinAtar, without brains and deaths."""
    rows = []
    for game in GAMES:
        habitat = load(f"gymnax:{game}-MinAtar").build_habitat()
        words = np.random.default_rng(1).integers(0, 2**32, (BODIES, habitat.words), np.uint32)
        advance = compiled.jit(partial(_steps, habitat, 200))
        bodies, rates = habitat.reset(words), []
        jax.block_until_ready(advance(bodies))
        for _ in range(PAIRS):
            began = time.perf_counter()
            jax.block_until_ready(advance(bodies))
            rates.append(200 * BODIES / (time.perf_counter() - began))
        rows.append({"game": game, "steps a second": round(statistics.median(rates))})
    return rows


def _steps(habitat: Any, ticks: int, bodies: Any) -> Any:
    buttons = np.arange(BODIES, dtype=np.int32) % habitat.action.size
    return jax.lax.fori_loop(0, ticks, lambda _, now: habitat.step(now, buttons)[0], bodies)


if __name__ == "__main__":
    for row in (*against_equal_bodies(), models(), *bare_games()):
        print(row, flush=True)
