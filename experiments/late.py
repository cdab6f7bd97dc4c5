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
"""Figures of each world, with their names in tables."""


def last_deaths(run: Path, compared: Comparison) -> list[dict[str, float]]:
    """Return COLUMNS of each world of a run, up to where runs are compared; scores if there are any."""
    edges = compared.arms[0].pace.edges
    begins, ends = edges[-1 - LATE], edges[-1]
    opened = primordia.load(run)
    lives, deaths = opened.lives(), opened.arrays("deaths")
    figures = []
    for number in range(lives.worlds):
        in_world = lives.of_world(number)
        late = in_world.died & (begins < in_world.ended) & (in_world.ended <= ends)
        world = {"late_deaths": int(late.sum()), "late_lifespan": median(in_world.lifespan[late])}
        if "score" in deaths:
            here = (deaths["world"] == number) & (deaths["tick"] <= ends)
            score, then = deaths["score"][here], deaths["tick"][here] > begins
            world |= {"late_score": median(score[then]), "best_score": score.max(initial=0)}
        figures.append(world)
    return figures


def median(values: np.ndarray) -> float:
    """Return the median; NaN if there are no values."""
    return float(np.median(values)) if len(values) else np.nan
