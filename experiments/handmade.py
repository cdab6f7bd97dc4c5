"""Measure hand-written players in the games of MinAtar's tasks.

    python experiments/handmade.py

Nothing has to be run before. Each player plays GAMES games of at most TICKS ticks: in Breakout one stays
under the ball, with and without sticky actions, and another goes where the ball will be in the next tick;
in Space Invaders one shoots, and dodges bullets that it sees; in Freeway one always goes up; in Seaquest
one shoots, takes divers that it meets, and brings them up when little oxygen is left.
The table goes to `experiments/skill/results/minatar-handmade`.
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from games import write_rows

from primordia import config, device
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table

GAMES = 200
TICKS = {"Breakout": 1_000, "Freeway": 2_500, "Seaquest": 5_000, "SpaceInvaders": 1_000}
"""Length of a game, which is the environment's own; Seaquest has none."""
TASKS = dict.fromkeys(TICKS, "MinAtar-{}-survival") | {"Seaquest": "examples/seaquest.toml"}
PADDLE, BALL, TRAIL = range(3)
EDGE, BULLET = 0, 5
NOOP, LEFT, RIGHT, SHOOT = range(4)
UP = 1
BEYOND, BACK, THREATS, DIVER = 0, 1, slice(4, 7), 7
GO_LEFT, GO_UP, GO_RIGHT, GO_DOWN, FIRE = range(1, 6)
LOW, SAVED = 2, 10
"""Cells of Seaquest's gauges: empty below 60 ticks of oxygen; full if a diver is on board."""
RESULTS = Path(__file__).parent / "skill" / "results" / "minatar-handmade"


def played(
    task: str, habitat_settings: dict[str, Any], ticks: int, act: Callable
) -> tuple[np.ndarray, np.ndarray]:
    """Return the ticks and the score of each game, (GAMES,); `act` gives buttons for senses (N, S)."""
    habitat = config.load(task, {"habitat": habitat_settings}).build_habitat()
    words = np.random.default_rng(1000).integers(0, 2**32, (GAMES, 2), dtype=np.uint32)
    bodies, tick = habitat.reset(words), jax.jit(habitat.tick)
    alive, lived, score = np.ones(GAMES, bool), np.zeros(GAMES, int), np.zeros(GAMES)
    for _ in range(ticks):
        bodies, values = tick(bodies, act(habitat.sense(bodies)))
        score += alive * np.asarray(values["reward"])
        alive &= ~np.asarray(values["done"])
        lived += alive
    return lived, score


def follow(senses: jax.Array, ahead: bool = False) -> jax.Array:
    """Return the button that brings the paddle under the ball, int32 (N,)."""
    grid = senses.reshape(-1, 10, 10, 4)
    paddle, ball, before = (grid[..., part].sum(1).argmax(1) for part in (PADDLE, BALL, TRAIL))
    aim = jnp.clip(2 * ball - before, 0, 9) if ahead else ball
    return jnp.where(aim < paddle, LEFT, jnp.where(aim > paddle, RIGHT, NOOP)).astype(jnp.int32)


def dodge(senses: jax.Array) -> jax.Array:
    """Return the button that shoots, or leaves the column of a bullet within two cells, int32 (N,)."""
    view = senses.reshape(-1, 5, 5, 6)
    danger = view[:, :2, 2, BULLET].any(1)
    blocked = (view[:, 2, 1, EDGE] + view[:, 1, 1, BULLET]) > 0
    return jnp.where(danger, jnp.where(blocked, RIGHT, LEFT), SHOOT).astype(jnp.int32)


def dive(senses: jax.Array) -> jax.Array:
    """Return the button of a submarine that perceives the 3 x 3 cells around it, int32 (N,)."""
    near, gauges = senses[:, :72].reshape(-1, 3, 3, 8) > 0, senses[:, 72:] > 0
    threat, diver, looks_left = near[..., THREATS].any(-1), near[..., DIVER], near[:, 1, 2, BACK]
    left, right, free_above = threat[:, 1, 0], threat[:, 1, 2], ~threat[:, 0].any(1)
    rules = (  # the first that holds
        (near[:, 0, :, BEYOND].all(1), GO_DOWN),
        (~gauges[:, LOW] & gauges[:, SAVED], GO_UP),
        (jnp.where(looks_left, left, right), FIRE),
        (jnp.where(looks_left, right, left) & free_above, GO_UP),
        (jnp.where(looks_left, right, left), GO_DOWN),
        (diver[:, 0].any(1) & free_above, GO_UP),
        (diver[:, 2].any(1) & ~threat[:, 2].any(1) & ~near[:, 2, :, BEYOND].all(1), GO_DOWN),
        (diver[:, 1, 2], GO_RIGHT),
        (diver[:, 1, 0], GO_LEFT),
    )
    return jnp.select([when for when, _ in rules], [button for _, button in rules], FIRE)


def up(senses: jax.Array) -> jax.Array:
    """Return the button that goes up, int32 (N,)."""
    return jnp.full(len(senses), UP, jnp.int32)


PLAYERS: tuple[tuple[str, str, float, Callable], ...] = (
    ("stays under the ball", "Breakout", 0.1, follow),
    ("goes where the ball will be", "Breakout", 0.1, partial(follow, ahead=True)),
    ("stays under the ball, nothing sticks", "Breakout", 0.0, follow),
    ("shoots, and dodges bullets", "SpaceInvaders", 0.1, dodge),
    ("always goes up", "Freeway", 0.1, up),
    ("shoots, and brings divers up", "Seaquest", 0.1, dive),
)


def main() -> None:
    """Write the table."""
    device.prepare()
    rows, lines = [], []
    for name, game, sticky, act in PLAYERS:
        task, habitat = TASKS[game].format(game), {"sticky": sticky}
        lived, score = played(task, habitat, TICKS[game], act)
        rows += [
            {"player": name, "game": game, "sticky": sticky, "lifespan": int(a), "score": float(b)}
            for a, b in zip(lived, score, strict=True)
        ]
        spreads = (spread_text(each.tolist()) for each in (lived, score))
        lines.append([name, game, f"{sticky:g}", *spreads])
    head = ["player", "game", "sticky", "lifespan", "score"]
    note = f"Medians (quartiles) of {GAMES} games. Hunger is off."
    write_rows(RESULTS, rows, f"{table(head, lines)}\n\n{note}")


if __name__ == "__main__":
    main()
