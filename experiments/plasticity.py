"""How much do late-born organisms learn, beside their neutral shadows?

    python experiments/plasticity.py experiments/learning/price.toml

The experiment must have been run (`primordia experiment`). Learning is the sum of the changes of all fast
weights in a tick, in a fresh game of at most TICKS ticks: the mean over the game's ticks. The neutral
shadow of an organism has its pedigree, and as many mutations, but no selection. The table goes to
`results/` beside the file, as Markdown and CSV.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import named
import numpy as np
from by_world import measure

from primordia.assays.shadow import reborn
from primordia.organism.playing.games import Players, stretches
from primordia.organism.playing.seats import Manner
from primordia.runs.records import Records

LATE, ORGANISMS, TICKS = 0.75, 50, 256


NOTE = (
    f"Learning: changes of all fast weights in a tick, in a fresh game of at most {TICKS} ticks; median"
    f" of {ORGANISMS} organisms of the last quarter of the births, and of their neutral shadows."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table."""
    measure(file, "plasticity", worlds_of, NOTE)


def worlds_of(run: Records) -> list[dict[str, Any]]:
    """Return a row for each world."""
    lives, rows = run.lives, []
    late = lives.late(LATE) & (lives.parent >= 0)
    for world in range(run.config.seeds):
        own = np.flatnonzero(late & (lives.world == world))
        some = own[:: max(1, len(own) // ORGANISMS)][:ORGANISMS]
        (learns, lived), (drifts, _) = (
            learning(reborn(run, some, redrawn)) for redrawn in (False, True)
        )
        rows.append(
            {
                "seed": int(run.world_seeds[world]),
                "late-born": len(own),
                "ticks lived": round(float(lived.mean()), 1),
                "learning": round(float(np.median(learns)), 3),
                "shadows' learning": round(float(np.median(drifts)), 3),
                "learning / shadows'": round(float(np.median(learns) / np.median(drifts)), 3),
            }
        )
    return rows


def learning(players: Players) -> tuple[np.ndarray, np.ndarray]:
    """Return the changes of fast weights in a tick, and the ticks lived: float64 (K,) each."""
    law, count = players.law, len(players.genomes)
    priced = law.brain.model_copy(update={"price": 1.0})
    total, ticks, last = np.zeros(count), np.zeros(count), None
    for playing, memory in memories(players, TICKS):
        if last is not None:
            spent = priced.spent(jnp.asarray(last), jnp.asarray(memory), law.senses, law.outputs)
            total += np.where(playing, np.asarray(spent), 0)
            ticks += playing
        last = memory
    return total / np.maximum(ticks, 1), ticks + 1


def memories(players: Players, ticks: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield who plays in each tick of a game, bool (K,), and the memories, float32 (K, M)."""
    for part in stretches(players, 1, Manner(ticks, watched=True)):
        assert part.met is not None
        yield from zip(part.playing, np.asarray(part.met.memory), strict=True)
        if not part.alive.any():
            break


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
