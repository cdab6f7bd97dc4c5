"""Numbers as values of options."""

import math
from typing import Any

import click

TICKS = click.IntRange(1, 2**31 - 1)
"""A number of ticks."""
COUNT = click.IntRange(1, 2**16)
"""A number of games, worlds, mutants or other copies of an organism."""


class Finite(click.FloatRange):
    """A number in a range, but neither NaN, which no bound refuses, nor infinity."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number. A wrong value is a usage error."""
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{value!r} is not a finite number", param, ctx)
        return number
