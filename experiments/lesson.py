"""What does a class see in the lesson? The worlds of its worksheet, for all numbers of a world.

    python experiments/lesson.py

Nothing has to be run before. The worlds of seeds 1 to 20 are lived as in `docs/teach/worksheet.md`. The
table goes to `cartpole/results/lesson.csv` beside this file: a row for each world, which the page for the
teacher is filled with.
"""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from games import write_rows

import primordia
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table

RESULTS = Path(__file__).parent / "cartpole" / "results" / "lesson"
SEED, SEEDS = 1, 20
PARTS: dict[str, tuple[str, int, dict[str, Any]]] = {
    "with heredity": ("CartPole-survival", 5_000, {}),
    "without": ("CartPole-survival", 5_000, {"inheritance": "founder"}),
    "velocities hidden": ("CartPole-survival-hidden", 5_000, {}),
    "mutations 30 times as large": ("CartPole-survival", 5_000, {"mutation": {"scale": 0.3}}),
    "no mutation": ("CartPole-survival", 5_000, {"mutation": {"scale": 0.0}}),
    "hidden, longer": ("CartPole-survival-hidden", 20_000, {}),
    "hidden, longer, without": ("CartPole-survival-hidden", 20_000, {"inheritance": "founder"}),
}
"""task, ticks and settings of each part of the lesson"""
NUMBERS = ("died", "alive", "mean_age", "oldest", "longest_life")


def worlds(part: str, folder: Path) -> list[dict[str, Any]]:
    """Live the worlds of a part of the lesson and return a row for each."""
    task, ticks, settings = PARTS[part]
    stop = {"ticks": ticks, "until": None}
    run = primordia.run(
        task, folder / "run", {**settings, "seed": SEED, "seeds": SEEDS, "stop": stop}
    )
    lives, rows = run.lives(), []
    for number in range(SEEDS):
        own = lives.of_world(number)
        ages = own.lifespan[~own.died]
        rows.append(
            {
                "part": part,
                "seed": SEED + number,
                "died": int(own.died.sum()),
                "alive": len(ages),
                "mean_age": round(float(np.mean(ages)), 1) if len(ages) else 0.0,
                "oldest": int(ages.max(initial=0)),
                "longest_life": int(own.lifespan.max()),
            }
        )
    return rows


def main() -> None:
    """Live all parts and write the table."""
    rows = []
    for part in PARTS:
        with TemporaryDirectory() as folder:
            rows += worlds(part, Path(folder))
    lines = [
        [
            part,
            *(spread_text([row[name] for row in rows if row["part"] == part]) for name in NUMBERS),
        ]
        for part in PARTS
    ]
    note = f"Medians over the worlds of seeds {SEED} to {SEED + SEEDS - 1} (quartiles)."
    write_rows(RESULTS, rows, f"{table(['', *NUMBERS], lines)}\n\n{note}")


if __name__ == "__main__":
    main()
