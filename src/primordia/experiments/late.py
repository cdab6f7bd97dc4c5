"""How organisms died in the last quarter of the time, in worlds that never saturate."""

import numpy as np

from primordia.comparison.comparison import Comparison
from primordia.comparison.pace import LATE
from primordia.runs.records import Records

COLUMNS = {
    "late_deaths": "deaths in the last quarter",
    "late_lifespan": "their median lifespan",
    "late_score": "their median score",
    "best_score": "best score at any death",
}
"""Columns with the values of each world: name -> name in tables."""


def last_deaths(run: Records, compared: Comparison) -> list[dict[str, float]]:
    """Return COLUMNS of each world, up to the last compared tick; scores only if there are any."""
    edges = compared.arms[0].pace.edges
    begins, ends = edges[-1 - LATE], edges[-1]
    deaths = run.table("deaths") if "score" in run.schema.tallies else None
    figures = []
    for number, in_world in enumerate(run.lives.by_world()):
        late = in_world.died & (begins < in_world.ended) & (in_world.ended <= ends)
        world = {"late_deaths": int(late.sum()), "late_lifespan": _median(in_world.lifespan[late])}
        if deaths is not None:
            tick, here = deaths["tick"].to_numpy(), deaths["world"].to_numpy() == number
            score = deaths["score"].to_numpy()
            then = here & (begins < tick) & (tick <= ends)
            every = score[here & (tick <= ends)]
            best = every.max() if len(every) else np.nan
            world |= {"late_score": _median(score[then]), "best_score": best}
        figures.append(world)
    return figures


def _median(values: np.ndarray) -> float:
    """Return the median; NaN if there are no values."""
    return float(np.median(values)) if len(values) else np.nan
