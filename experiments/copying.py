"""What evolves after as many births, if organisms choose when to copy themselves?

    python experiments/copying.py experiments/investment/poles.toml

The experiment must have been run (`primordia experiment`). A world is late from the tick at which three
quarters of its births have happened. Its worlds had equally many births, so they lived for different
times. The table goes to `results/` beside the file, as Markdown and CSV.
"""

from pathlib import Path
from typing import Any

import named
import numpy as np
from by_world import measure

from primordia.comparison.pace import pace
from primordia.history.foraging import harvests
from primordia.history.info import info
from primordia.law.metabolism import ONE
from primordia.runs.records import Records

LATE = 0.75
NOTE = (
    "Late: from the tick on at which three quarters of a world's births have happened. Endowment: mean"
    " energy with which children begin that are born then. Tries: of all organisms, for each"
    " child that is born."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table."""
    measure(file, "copying", worlds_of, NOTE)


def worlds_of(run: Records) -> list[dict[str, Any]]:
    """Return a row for each world."""
    food, known = harvests(run, run.config.seeds), info(run)["worlds"]
    given = None if run.config.act is None else run.endowments_of(run.lives) / ONE
    late, rows = run.lives.late(LATE), []
    for world, lives in enumerate(run.lives.by_world()):
        own = late & (run.lives.world == world)
        children = own & (run.lives.parent >= 0)
        begin, end = int(run.lives.born[own].min()), int(run.ends[world])
        dying = pace([lives], begin, end)
        act = known[world].get("act")
        rows.append(
            {
                "seed": int(run.world_seeds[world]),
                "births": len(lives),
                "ticks": end,
                "extinctions": known[world]["extinctions"],
                "late ticks lived for each death": round(dying.lived.sum() / dying.deaths.sum(), 1),
                "late food in a tick": round(
                    float(food[world].between(np.array([begin, end]))[0]), 3
                ),
                "late endowment": ""
                if given is None or not children.any()
                else round(float(given[children].mean()), 2),
                "tries for each child": ""
                if act is None
                else round(act["tries"] / max(act["children"], 1), 2),
            }
        )
    return rows


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
