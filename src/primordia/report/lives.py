"""Short films of lives in a page: the lives of the champion and of the first organism."""

import base64
import shutil
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from primordia import device, interrupts
from primordia.errors import InputError, Trouble
from primordia.habitats.archipelago import at
from primordia.organism.inside import is_shown
from primordia.organism.reliving.replay import replay
from primordia.runs.lives import Lives
from primordia.runs.records import Records

PART = 6.0
"""Seconds shown at each end of a long life."""
LONGEST = {"jax": 2_000_000, "host": 100_000}
"""Largest number of ticks of a life that is lived again for a page, by kind of habitat; living them
again takes about a minute."""


def films(run: Records) -> dict[str, Any]:
    """Film lives of a run, for `lives.js`.

    A life is lived again in its habitat. This executes only the code of installed packages, and
    code that the user has trusted.

    Returns:
        `films`: each with its `title`, a description (`about`), `data`, an MP4 in base64, and `panel`:
        whether it has one below the body;
        `missing`: the reason why a life is not shown, or "".
    """
    rows = chosen(run.lives)
    shown, reasons = [], [] if rows else ["nothing has been born since the fork"]
    for title, row in rows.items():
        try:
            shown.append(_film(run, title, row))
        except (InputError, Trouble) as error:
            reasons.append(str(error).replace(str(run.path), "this run"))
    return {"films": shown, "missing": "; ".join(dict.fromkeys(reasons))}


def chosen(lives: Lives) -> dict[str, int]:
    """Return the rows of the lives that are filmed, by title: the first organism and the champion.

    Both were born in the run itself. If nothing has been born since a fork, the dict is empty.
    """
    born = np.flatnonzero(~lives.inherited)
    if not len(born):
        return {}
    return {
        "The first organism born in this run": int(born[0]),
        "The champion: the longest-lived of the later half": lives.oldest(),
    }


def _film(run: Records, title: str, row: int) -> dict[str, Any]:
    number, world = int(run.lives.id[row]), int(run.lives.world[row])
    islands = run.config.islands
    habitat, ticks = at(run.habitat, int(run.lives.cell[row])), int(run.lives.lifespan[row])
    if ticks > LONGEST[habitat.kind]:
        raise InputError(
            f"the life of organism {number} is {ticks:,} ticks long, too long for a page;"
            f" `primordia replay` films this life"
        )
    device.prepare()
    with (
        tempfile.TemporaryDirectory() as folder,
        interrupts.before_end(partial(shutil.rmtree, folder, ignore_errors=True)),
    ):
        path = replay(run, number, world, Path(folder) / "life.mp4", part=PART)
        data = base64.b64encode(path.read_bytes()).decode("ascii")
    where = f" of world {world}" if run.lives.worlds > 1 else ""
    where += (
        f" on {name}" if (name := islands.names[int(islands.of_cells(run.lives.cell[row]))]) else ""
    )
    end = "dead" if run.lives.died[row] else "alive"
    about = (
        f"Organism {number:,}{where}: born at tick {run.lives.born[row]:,}, {ticks:,} ticks, {end}"
    )
    panel = is_shown(run.law, habitat)
    return {"title": title, "about": about, "data": data, "panel": panel}
