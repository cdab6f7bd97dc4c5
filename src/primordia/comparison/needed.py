"""How many worlds a claim needs: those with which an effect of its size would be told from none.

Noether (1987, Sample size determination for some common nonparametric tests, JASA 82, 645-647) gives the
numbers for the test of Mann and Whitney and for the sign test. Both are normal approximations. That for
Mann and Whitney's test leaves ties out of account, so with many ties fewer worlds may do.
"""

import math
from statistics import NormalDist

from primordia.comparison.pairs import Paired

POWER = 0.8
"""Probability with which the effect would be told from none."""


def of_each_run(delta: float, missed: float) -> int | None:
    """Return the worlds of each run for Cliff's `delta`; None if it is 0.

    Args:
        delta: share of all pairs of worlds with the larger value in one run, less the share with the
            smaller.
        missed: level of the test, with two sides.
    """
    return math.ceil(_sum_of_quantiles(missed) ** 2 / (1.5 * delta**2)) if delta else None


def of_pairs(effect: Paired, missed: float) -> int | None:
    """Return the pairs of worlds for a sign test, in which ties do not count; None if delta is 0."""
    if not effect.delta:
        return None
    untied = (effect.larger + effect.smaller) / effect.pairs
    return math.ceil(_sum_of_quantiles(missed) ** 2 * untied / effect.delta**2)


def _sum_of_quantiles(missed: float) -> float:
    """Return the normal quantiles of a level with two sides and of the power, added."""
    normal = NormalDist()
    return normal.inv_cdf(1 - missed / 2) + normal.inv_cdf(POWER)
