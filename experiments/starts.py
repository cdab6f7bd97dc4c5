"""From how many starts do the populations of an experiment keep their poles up?

    python experiments/starts.py experiments/cartpole/any-start.toml

The experiment must have been run (`primordia experiment`). These play games of TICKS ticks: the champion
of each world and all organisms that are alive at its end; in the first arm also the best of as many
founders as the world had births (at most MOST), and founders as they come. Each game begins with other
coordinates, up to SPREAD away from zero; the pole then has up to 95 % of the fatal angle. A start is
mastered if the organism lives to the end of the game. Some starts might be lost for every player, so the
last row is a controller made by hand. The table goes to `results/` beside the file, as Markdown and CSV.
"""

from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import named
import numpy as np
from games import write_rows

import primordia
from primordia.assays.controls import Group, evolved, unevolved
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table
from primordia.habitats.cartpole.habitat import CartPole
from primordia.organism.playing.evaluation import judged

SPREAD, TICKS = 0.2, 3_000
GAMES = {"champion": 200, "all alive": 20, "best founder": 200, "founder": 20}
"""number of games of each organism of a group"""
MOST = 2_000
WEIGHTS = (0.1, 0.2, 0.75, 0.4)
"""of the four coordinates; the controller pushes right if their weighted sum is above zero"""
BY_HAND = "a controller made by hand"


def report(file: Path) -> None:
    """Let the organisms of an experiment play and write the table."""
    rows = []
    for number, folder in enumerate(named.arms(file)):
        run = primordia.load(folder).opened()
        for group in evolved(run):
            rows += played(f"{folder.name}: {group.name}", group)
        for group in unevolved(run, MOST) if number == 0 else ():
            rows += played(f"{folder.name}: {group.name}", group)
        print(f"{folder.name}: done", flush=True)
    rows.append({"who": BY_HAND, "seed": "", "organisms": 1, "games": 10_000, "share": by_hand()})
    write_rows(file.parent / "results" / f"{file.stem}-starts", rows, summary(rows))


def played(name: str, group: Group) -> list[dict[str, Any]]:
    """Let the organisms of a group play, and return a row for each world with the share mastered."""
    games, rows = GAMES[group.name], []
    found = judged(
        *(group.run.config, group.players, group.numbers),
        games=games, ticks=TICKS, senses="live", habitat={"spread": SPREAD},
    )  # fmt: skip
    for world in dict.fromkeys(each.world for each in found):
        here = [int((~each.lived.over).sum()) for each in found if each.world == world]
        row = {"who": name, "seed": int(group.run.world_seeds[world]), "organisms": len(here)}
        rows.append(row | {"games": games, "share": round(float(np.mean(here)) / games, 4)})
    return rows


def by_hand() -> float:
    """Return the share of starts that the controller made by hand masters."""
    habitat, noise = CartPole(spread=SPREAD), np.random.default_rng(0)
    starts = habitat.reset(jnp.asarray(noise.integers(2**32, size=(10_000, 4), dtype=np.uint32)))

    def tick(_: int, now: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        bodies, alive = now
        push = habitat.sense(bodies) @ jnp.array(WEIGHTS) > 0
        bodies, outcome = habitat.step(bodies, push.astype(jnp.int32))
        return bodies, alive & ~outcome.fatal

    _, alive = jax.lax.fori_loop(0, TICKS, tick, (starts, jnp.ones(len(starts), bool)))
    return round(float(alive.mean()), 4)


def summary(rows: list[dict[str, Any]]) -> str:
    """Return a table of medians and quartiles over worlds."""
    lines = []
    for who in dict.fromkeys(row["who"] for row in rows):
        shares = [row["share"] for row in rows if row["who"] == who]
        nearly = sum(share >= 0.99 for share in shares)
        lines.append([who, len(shares), spread_text(shares), min(shares), nearly])
    note = (
        f"Share of games in which an organism lives {TICKS:,} ticks: the mean over the organisms of a"
        f" world, then the median (quartiles) over worlds. Each coordinate of a start is up to {SPREAD}"
        f" from zero. The best founder is the longest-lived of as many founders as its world had births,"
        f" at most {MOST:,}. No game here chose an organism."
    )
    head = ["who", "worlds", "share of starts mastered", "least", "worlds with 0.99 or more"]
    return f"{table(head, lines)}\n\n{note}"


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
