"""How many late-born organisms live long, and how long do champions live that cannot learn?

    python experiments/learned.py experiments/learning/buttons.toml

The experiment must have been run (`primordia experiment`). A birth is late if it is in the last quarter
of a world's births. An organism that is alive and younger than LONG ticks at the end is left out.
Champions live GAMES lives of at most TICKS ticks, then the same lives without plasticity. The table goes
to `results/` beside the file, as Markdown and CSV.
"""

from pathlib import Path
from typing import Any

import named
from games import write_rows

import primordia
from primordia.assays.ablate import ablate
from primordia.assays.subjects import of_run
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table
from primordia.runs.records import Records

LATE, LONG = 0.75, 1000
GAMES, TICKS = 5, 10_000


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table."""
    rows, hazard = [], 0.0
    for folder in named.arms(file):
        run = primordia.load(folder).opened()
        hazard = run.config.hazard
        rows += [{"arm": folder.name, **row} for row in worlds_of(run)]
        print(f"{folder.name} is done", flush=True)
    text = summary(rows, (1 - hazard) ** LONG)
    write_rows(file.parent / "results" / f"{file.stem}-learned", rows, text)


def worlds_of(run: Records) -> list[dict[str, Any]]:
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


def summary(rows: list[dict[str, Any]], by_accident: float) -> str:
    """Return a table of medians and quartiles over worlds."""
    lines, columns = [], list(rows[0])[2:]
    for arm in dict.fromkeys(row["arm"] for row in rows):
        worlds = [row for row in rows if row["arm"] == arm]
        known = [[row[column] for row in worlds if row[column] != ""] for column in columns]
        lines.append([arm, len(worlds), *(spread_text(each) if each else "" for each in known)])
    note = (
        f"Medians over worlds (quartiles). Late-born: the last quarter of a world's births. If accidents"
        f" were the only cause of death, {by_accident:.3f} of them would live {LONG:,} ticks. Champions"
        f" live {GAMES} lives of at most {TICKS:,} ticks without accidents, and the same lives without"
        " plasticity."
    )
    return f"{table(['arm', 'worlds', *columns], lines)}\n\n{note}"


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
