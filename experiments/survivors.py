"""Measure hand-written players in Craftax-Classic. They perceive what organisms perceive.

    python experiments/survivors.py

Nothing has to be run before. Each player plays GAMES games of at most TICKS ticks. The table goes to
`experiments/skill/results/craftax-handmade`.
"""

from functools import partial
from pathlib import Path
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from craftax.craftax_classic.constants import Action, BlockType
from games import write_rows
from handmade import GAMES, played
from jax import Array

from primordia import device
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table

TASK, TICKS = "Craftax-Classic-survival", 1_000
RESULTS = Path(__file__).parent / "skill" / "results" / "craftax-handmade"
VIEW, HERE = (7, 9, 21), (3, 4)
"""Rows, columns and channels of the map that is perceived, and the player's cell in it."""
ZOMBIE, COW = 17, 18
"""Channels after those of the kinds of ground."""
SAPLING = 1328
"""The sense that says how many saplings a player has."""
STEPS = np.array([[0, -1], [0, 1], [-1, 0], [1, 0]])
"""Rows and columns of a step to the left, to the right, up and down."""
FREE = [BlockType.GRASS.value, BlockType.SAND.value, BlockType.PATH.value]
HUNGRY, THIRSTY, TIRED = 0.6, 0.6, 0.3
"""Food, drink and energy below which a player looks for more; the most is 0.9."""


class Player(NamedTuple):
    """What a hand-written player does, beside walking on and turning at obstacles."""

    fights: bool = False
    """hits zombies that are beside it"""
    feeds: bool = False
    """drinks, and eats cows, and goes to water and cows that it sees"""
    sleeps: bool = False
    """sleeps when it is tired, until it wakes"""
    plants: bool = False
    """gathers saplings from the grass before it, and plants them there; nothing walks through plants"""


def act(player: Player, senses: Array) -> Array:
    """Return the buttons of players for their senses (N, 1345), int32 (N,)."""
    return jax.vmap(partial(button, player))(senses).astype(jnp.int32)


def button(player: Player, senses: Array) -> Array:
    """Return the button of one player for its senses (1345,)."""
    view = senses[:1323].reshape(VIEW) > 0
    _, food, drink, energy = senses[1335:1339]
    facing, asleep = jnp.argmax(senses[1339:1343]), senses[1344] > 0
    beside = view[HERE[0] + STEPS[:, 0], HERE[1] + STEPS[:, 1]]
    free = beside[:, FREE].any(1) & ~beside[:, [ZOMBIE, COW]].any(1)
    turned = (jnp.arange(4) - facing) % 4
    step = jnp.argmin(turned + 4 * ~free)
    chosen = Action.LEFT.value + step
    if player.plants:
        with_sapling = senses[SAPLING] > 0
        sown = jnp.where(with_sapling, Action.PLACE_PLANT.value, Action.DO.value)
        chosen = jnp.where(beside[facing, BlockType.GRASS.value], sown, chosen)
    if player.feeds:
        for channel, short in ((COW, food < HUNGRY), (BlockType.WATER.value, drink < THIRSTY)):
            aim, seen = nearest(view[..., channel])
            there = jnp.argmax(STEPS @ aim)
            chosen = jnp.where(short & seen & free[there], Action.LEFT.value + there, chosen)
            chosen = jnp.where(short, touched(beside[:, channel], facing, chosen), chosen)
    if player.sleeps:
        chosen = jnp.where(asleep | (energy < TIRED), Action.SLEEP.value, chosen)
    return touched(beside[:, ZOMBIE], facing, chosen) if player.fights else chosen


def nearest(cells: Array) -> tuple[Array, Array]:
    """Return the way to the nearest of these cells, int (2,), and whether there is one."""
    rows, columns = jnp.mgrid[: VIEW[0], : VIEW[1]]
    way = jnp.stack([rows - HERE[0], columns - HERE[1]], axis=-1)
    steps = jnp.where(cells, jnp.abs(way).sum(-1), 99).ravel()
    return way.reshape(-1, 2)[jnp.argmin(steps)], cells.any()


def touched(beside: Array, facing: Array, otherwise: Array) -> Array:
    """Return the button that faces, and then touches, what is beside the player (4,), if it is there."""
    there = jnp.argmax(beside)
    near = jnp.where(beside[facing], Action.DO.value, Action.LEFT.value + there)
    return jnp.where(beside.any(), near, otherwise)


PLAYERS = {
    "walks": Player(),
    "walks, fights": Player(fights=True),
    "walks, fights, drinks and eats": Player(fights=True, feeds=True),
    "walks, fights, drinks, eats and sleeps": Player(fights=True, feeds=True, sleeps=True),
    "walks, fights, plants": Player(fights=True, plants=True),
    "walks, fights, drinks, eats, plants": Player(fights=True, feeds=True, plants=True),
    "walks, fights, drinks, eats, sleeps, plants": Player(
        fights=True, feeds=True, sleeps=True, plants=True
    ),
}


def main() -> None:
    """Write the table."""
    device.prepare()
    rows, lines = [], []
    for name, player in PLAYERS.items():
        lived, _ = played(TASK, {}, TICKS, jax.jit(partial(act, player)))
        rows += [{"player": name, "lifespan": int(each)} for each in lived]
        lines.append([name, spread_text(lived.tolist()), max(lived)])
        print(f"{name} is done", flush=True)
    note = f"Medians (quartiles) of {GAMES} games, which were cut after {TICKS:,} ticks."
    write_rows(RESULTS, rows, f"{table(['player', 'lifespan', 'longest'], lines)}\n\n{note}")


if __name__ == "__main__":
    main()
