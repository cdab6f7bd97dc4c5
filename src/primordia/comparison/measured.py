"""One value of each world, some of them censored.

If a world stopped before it saturated, its value is *at least* the births or ticks that it reached.
Nothing is assumed about its course after the stop. A quartile is given by its bounds, which are
equal if the quartile is known. So every statement is exact, whatever stopped the worlds.
"""

from dataclasses import dataclass

import numpy as np

from primordia.errors import InputError

Bounds = tuple[float, float]
"""Lower and upper bound of a value; infinity if no upper bound is known."""


@dataclass(frozen=True)
class Measured:
    """One value of each world, known or censored."""

    value: np.ndarray
    """float64 (W,)"""
    known: np.ndarray
    """bool (W,); False if the true value is only known to be at least `value`"""

    @property
    def high(self) -> np.ndarray:
        """Upper bound of each value, float64 (W,)."""
        return np.where(self.known, self.value, np.inf)

    def before(self, horizon: float) -> "Measured":
        """Return the values censored at a horizon.

        Raises:
            InputError: a world stopped before the horizon, and its value is not known.
        """
        if (short := ~self.known & (self.value < horizon)).any():
            world = int(np.flatnonzero(short)[0])
            raise InputError(
                f"world {world} stopped at {self.value[world]:,.0f} before it saturated, so it is"
                f" unknown whether the world would be saturated at {horizon:,.0f}"
            )
        near = self.value < horizon
        return Measured(np.where(near, self.value, horizon), self.known & near)

    def take(self, rows: np.ndarray) -> "Measured":
        """Return the values of some worlds; `rows` may have any shape."""
        return Measured(self.value[rows], self.known[rows])

    def quantile(self, q: float) -> Bounds:
        """Return bounds of the q-quantile: the smallest value that a share q of worlds does not
        exceed."""
        both = np.stack([self.value, self.high])
        low, high = np.quantile(both, q, axis=1, method="inverted_cdf")
        return float(low), float(high)
