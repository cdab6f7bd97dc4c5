"""How organisms died in the last quarter of the time, in worlds that never saturate."""

from pathlib import Path

import numpy as np

import primordia
from primordia.comparison.comparison import Comparison
from primordia.comparison.pace import LATE

COLUMNS = {
    "late_deaths": "deaths in the last quarter",
    "late_lifespan": "their median lifespan",
    "late_score": "their median score",
    "best_score": "best score at any death",
}
"""What is told of each world, and in which words."""


def last_deaths(run: Path, compared: Comparison) -> list[dict[str, float]]:
    """COLUMNS of each world of a run, up to where runs are compared; scores where there are any."""
    edges = compared.arms[0].pace.edges
    begins, ends = edges[-1 - LATE], edges[-1]
    found = primordia.load(run)
    everyone, deaths = found.lives(), found.arrays("deaths")
    told = []
    for number in range(everyone.worlds):
        mine = everyone.of_world(number)
        late = mine.died & (begins < mine.ended) & (mine.ended <= ends)
        world = {"late_deaths": int(late.sum()), "late_lifespan": median(mine.lifespan[late])}
        if "score" in deaths:
            here = (deaths["world"] == number) & (deaths["tick"] <= ends)
            score, then = deaths["score"][here], deaths["tick"][here] > begins
            world |= {"late_score": median(score[then]), "best_score": score.max(initial=0)}
        told.append(world)
    return told


def median(values: np.ndarray) -> float:
    """NaN of nothing."""
    return float(np.median(values)) if len(values) else np.nan
