"""How many late-born organisms live long, and how long do champions live that cannot learn?

    python experiments/learned.py experiments/learning/buttons.toml

The experiment must have been run (`primordia experiment`). A birth is late if it is in the last quarter
of a world's births. An organism that is alive and younger than LONG ticks at the end is left out.
Champions live GAMES lives of at most TICKS ticks, then the same lives without plasticity. The table goes
to `results/` beside the file, as Markdown and CSV.
"""

from pathlib import Path

import named
from by_world import Row, measure

import primordia
from primordia.assays.ablate import ablate
from primordia.assays.subjects import of_run
from primordia.runs.records import Records

LATE, LONG = 0.75, 1000
GAMES, TICKS = 5, 10_000


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table."""
    hazard = primordia.load(named.arms(file)[-1]).opened().config.hazard
    note = (
        f"Late-born: the last quarter of a world's births. If accidents were the only cause of death,"
        f" {(1 - hazard) ** LONG:.3f} of them would live {LONG:,} ticks. Champions live {GAMES} lives of"
        f" at most {TICKS:,} ticks without accidents, and the same lives without plasticity."
    )
    measure(file, "learned", worlds_of, note)


def worlds_of(run: Records) -> list[Row]:
    """Return a row for each world."""
    lost = ablate(of_run(run), games=GAMES, ticks=TICKS)
    innate = {each.world: each for each in lost if each.without == "plasticity"}
    rows = []
    for world, lives in enumerate(run.lives.by_world()):
        span, late = lives.lifespan, lives.late(LATE)
        late &= lives.died | (span >= LONG)
        one = innate.get(world)
        rows.append(
            {
                "seed": int(run.world_seeds[world]),
                "late-born": int(late.sum()),
                f"live {LONG} ticks": round(float((span[late] >= LONG).mean()), 4),
                "champion lives": "" if one is None else round(one.intact, 1),
                "without plasticity": "" if one is None else round(one.lifespan, 1),
            }
        )
    return rows


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
