"""How long does a player of MinAtar's Breakout live that always stays under the ball?

    python experiments/tracker.py

Nothing has to be run before. Hand-written players live GAMES games each, with and without sticky actions,
of at most TICKS ticks: one stays under the ball, the other goes where the ball will be in the next tick.
The table goes to `experiments/skill/results/minatar-breakout-tracker`.
"""

from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
from games import write_rows

from primordia import config, device
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table

TASK, GAMES, TICKS = "MinAtar-Breakout-survival", 200, 1_000
PADDLE, BALL, TRAIL = range(3)
NOOP, LEFT, RIGHT = range(3)
RESULTS = Path(__file__).parent / "skill" / "results" / "minatar-breakout-tracker"


def lives(sticky: float, ahead: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the ticks and the score of each game, (GAMES,)."""
    habitat = config.load(TASK, {"habitat": {"sticky": sticky}}).build_habitat()
    words = np.random.default_rng(1000).integers(0, 2**32, (GAMES, 2), dtype=np.uint32)
    bodies, tick = habitat.reset(words), jax.jit(habitat.tick)
    alive, lived, score = np.ones(GAMES, bool), np.zeros(GAMES, int), np.zeros(GAMES)
    for _ in range(TICKS):
        bodies, values = tick(bodies, action(habitat.sense(bodies), ahead))
        score += alive * np.asarray(values["reward"])
        alive &= ~np.asarray(values["done"])
        lived += alive
    return lived, score


def action(senses: jnp.ndarray, ahead: bool) -> jnp.ndarray:
    """Return the button that brings the paddle under the ball, int32 (N,)."""
    grid = senses.reshape(-1, 10, 10, 4)
    place = [grid[..., part].sum(1).argmax(1) for part in (PADDLE, BALL, TRAIL)]
    paddle, ball, before = place
    aim = jnp.clip(2 * ball - before, 0, 9) if ahead else ball
    return jnp.where(aim < paddle, LEFT, jnp.where(aim > paddle, RIGHT, NOOP)).astype(jnp.int32)


def main() -> None:
    """Write the table."""
    device.prepare()
    rows, lines = [], []
    for sticky in (0.0, 0.1):
        for name, ahead in (("stays under the ball", False), ("goes where the ball will be", True)):
            lived, score = lives(sticky, ahead)
            rows += [
                {"player": name, "sticky": sticky, "lifespan": int(a), "score": float(b)}
                for a, b in zip(lived, score, strict=True)
            ]
            lines.append(
                [name, f"{sticky:g}", *(spread_text(each.tolist()) for each in (lived, score))]
            )
    note = f"Medians (quartiles) of {GAMES:,} games of at most {TICKS:,} ticks."
    write_rows(
        RESULTS, rows, f"{table(['player', 'sticky', 'lifespan', 'score'], lines)}\n\n{note}"
    )


if __name__ == "__main__":
    main()
