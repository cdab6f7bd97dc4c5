"""What do parents give to their children, beside what theory says?

    python experiments/endowments.py founders experiments/investment/tasks/nursery.toml
    python experiments/endowments.py experiments/investment/theory.toml

The first command writes the founders' genomes. The second one needs the experiment to have been run
(`primordia experiment`). Theory: a parent that has energy to give leaves most grown children if it gives
each of them the e with the largest f(e) / (e + price), where f(e) is the share of children that grow up
(Smith & Fretwell 1974, American Naturalist 108, for a price of 0). The neutral shadow of an organism has
its pedigree, and as many mutations, but no selection; both are asked at which energy they would copy
themselves first, and what they would give. The table goes to `results/` beside the file.
"""

import sys
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import named
import numpy as np
from by_world import measure
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from primordia import config
from primordia.brains import genomes
from primordia.history import pedigree
from primordia.law.metabolism import ONE
from primordia.runs.records import Records

LATE, ORGANISMS = 0.75, 200
FOUNDERS = {"generous": (50.0, 0.95), "stingy": (11.0, 0.9)}
"""Energy above which a founder copies itself, and the share of it that its child is given."""
ENERGIES = np.arange(1, 400) / 2
Floats = NDArray[np.float64]


def write_founders(file: Path) -> None:
    """Write a genome for each of FOUNDERS into the folder above that of the task's file."""
    settings = config.load(str(file))
    layout, store = settings.build_layout(settings.build_habitat()), settings.metabolism.store
    for name, (energy, share) in FOUNDERS.items():
        weights = np.zeros((1, 4, 2), np.float32)
        weights[0, 2] = -energy / store, 1
        weights[0, 3, 0] = np.log(share / (1 - share))
        shape = layout.blocks[0][1]
        genome = weights if shape == (4, 2) else weights.transpose(0, 2, 1)
        path = file.parent.parent / f"{name}.safetensors"
        genomes.write(path, layout, genome.reshape(1, -1), {"copies above": str(energy)})


NOTE = (
    "In units of energy. Late births: the last quarter of a world's births. `would give`: what an"
    f" organism gives at the least energy at which it copies itself, median of {ORGANISMS} late-born; its"
    " shadow has the same pedigree without selection."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table."""
    measure(file, "endowments", worlds_of, NOTE)


def optimum(run: Records) -> float:
    """Return the endowment at which f(e) / (e + price) is largest."""
    world, price = run.config.habitat, run.config.act.price

    def gain(e: float) -> float:
        odds = (e / world["scale"]) ** world["shape"]
        grown = 1 - np.exp(-odds) if world["survival"] == "weibull" else odds / (1 + odds)
        return -grown / (e + price)

    return float(minimize_scalar(gain, (world["scale"], 2 * world["scale"])).x)


def worlds_of(run: Records) -> list[dict[str, Any]]:
    """Return a row for each world."""
    lives, best = run.lives, optimum(run)
    given, child = run.endowments_of(lives) / ONE, lives.parent >= 0
    late, rows = lives.late(LATE) & child, []
    for world in range(run.config.seeds):
        own = np.flatnonzero(late & (lives.world == world))
        some = own[:: max(1, len(own) // ORGANISMS)][:ORGANISMS]
        would, shadows = (first_gift(run, some, redrawn) for redrawn in (False, True))
        rows.append(
            {
                "seed": int(run.world_seeds[world]),
                "theory": round(best, 2),
                "first births": round(
                    float(given[child & (lives.world == world)][:1000].mean()), 2
                ),
                "late births": round(float(given[own].mean()), 2),
                "late / theory": round(float(given[own].mean()) / best, 3),
                "would give": round(float(np.nanmedian(would)), 2),
                "shadow would give": round(float(np.nanmedian(shadows)), 2),
                "shadow: 10 %": round(float(np.nanquantile(shadows, 0.1)), 2),
                "shadow: 90 %": round(float(np.nanquantile(shadows, 0.9)), 2),
                "shadows that never copy": round(float(np.isnan(shadows).mean()), 3),
            }
        )
    return rows


def first_gift(run: Records, rows: np.ndarray, redrawn: bool) -> Floats:
    """Return what each organism gives at the least energy at which it copies itself; NaN if at none."""
    made, act = pedigree.genomes(run, rows, redrawn), run.config.act
    store, found = run.config.metabolism.store, np.full(len(rows), np.nan)
    for energy in ENERGIES[::-1]:
        senses = jnp.tile(jnp.array([1, energy / store], jnp.float32), (len(rows), 1))
        blocks = run.layout.split(jnp.asarray(made))
        outputs = run.law.brain(blocks, senses[:, :0], senses)[1][:, 2:]
        whole = jnp.full(len(rows), round(energy * ONE), jnp.int32)
        tries = act.tries(outputs, whole, jnp.float32(act.price))
        found = np.where(tries.tried, np.asarray(tries.endowment) / ONE, found)
    return found


if __name__ == "__main__":
    if sys.argv[1:2] == ["founders"]:
        del sys.argv[1]
        named.for_each_named(write_founders, __doc__)
    else:
        named.for_each_named(report, __doc__)
