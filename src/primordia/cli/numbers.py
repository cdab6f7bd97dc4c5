"""Numbers as values of options."""

import math
from typing import Any

import click


class Finite(click.FloatRange):
    """A number in a range, and not NaN, which no bound of a range refuses."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number. A wrong value is a usage error."""
        number = float(super().convert(value, param, ctx))
        if math.isnan(number):
            self.fail(f"{value!r} is not a number", param, ctx)
        return number
