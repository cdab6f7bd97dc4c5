"""How long do organisms live if a whole world is of one game, with the ticks of all islands?

    python experiments/alone.py experiments/archipelago/minatar-alone.toml

The experiment must have been run (`primordia experiment`). In each world that has lived all its ticks,
EACH late-born organisms live again, GAMES games of at most TICKS ticks without accidents, as natives do
in `archipelagos.py`. The table goes to `results/` beside the file.
"""

from pathlib import Path

import named
import numpy as np
from archipelagos import EACH, GAMES, LATE, TICKS
from by_world import Row, measure

from primordia.history.series import spaced
from primordia.organism.playing.games import lifespans_in_games
from primordia.organism.playing.players import players_of
from primordia.runs.records import Records

NOTE = (
    f"Alone: ticks that {EACH} late-born organisms of a world live, in games of at most {TICKS:,} ticks;"
    " all cells of the world are of one game."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the table."""
    measure(file, "lives", rows_of, NOTE)


def rows_of(run: Records) -> list[Row]:
    """Return a row for each world that has lived all its ticks."""
    found: list[Row] = []
    done = run.ends >= (run.config.stop.ticks or 0)
    for world in np.flatnonzero(done).tolist():
        late = np.flatnonzero(run.lives.late(LATE) & (run.lives.world == world))
        players = players_of(run, spaced(late, EACH))
        lived = lifespans_in_games(players, GAMES, TICKS).mean()
        found.append({"seed": int(run.world_seeds[world]), "alone": round(float(lived), 1)})
    return found


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
