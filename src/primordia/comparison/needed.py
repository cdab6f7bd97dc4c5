"""Sample sizes: the number of worlds with which an effect of a given size would be found.

Noether (1987, Sample size determination for some common nonparametric tests, JASA 82, 645-647) gives the
numbers for the test of Mann and Whitney and for the sign test. Both formulas are normal
approximations. The formula for Mann and Whitney's test ignores ties, so fewer worlds may suffice if
there are many ties.
"""

import math
from statistics import NormalDist

from primordia.comparison.pairs import Paired

POWER = 0.8
"""Power: the probability that the test finds the effect."""


def of_each_run(delta: float, missed: float) -> int | None:
    """Return the number of worlds that each run needs for Cliff's `delta`; None if delta is 0.

    Args:
        delta: share of all pairs of worlds in which the run's value is larger, minus the share in
            which the run's value is smaller.
        missed: two-sided level of the test.
    """
    return math.ceil(_sum_of_quantiles(missed) ** 2 / (1.5 * delta**2)) if delta else None


def of_pairs(effect: Paired, missed: float) -> int | None:
    """Return the number of pairs that a sign test needs; ties do not count. None if delta is 0."""
    if not effect.delta:
        return None
    untied = (effect.larger + effect.smaller) / effect.pairs
    return math.ceil(_sum_of_quantiles(missed) ** 2 * untied / effect.delta**2)


def _sum_of_quantiles(missed: float) -> float:
    """Return the sum of the normal quantiles of a two-sided level and of the power."""
    normal = NormalDist()
    return normal.inv_cdf(1 - missed / 2) + normal.inv_cdf(POWER)
