"""Replication as an act: an organism copies itself when its brain says so, and pays for it.

A brain has one more output than the habitat's actions need, and a second one if it also chooses the
endowment. In Avida and Tierra copying is part of an organism's code; here it is part of its behaviour.
"""

from typing import Annotated, Literal, NamedTuple

import jax.numpy as jnp
from jax import Array
from pydantic import Field

from primordia.brains.layers import gate
from primordia.law.metabolism import to_fixed_point
from primordia.random.wide import Wide, signed, total
from primordia.settings.base import Rate, Settings
from primordia.settings.fields import NUMBER, OTHER, number_or_word


class Tries(NamedTuple):
    """The tries of N organisms to copy themselves in one tick."""

    tried: Array
    """bool (N,): the organism tries, and pays the price"""
    price: Array
    """int32 (N,), fixed point: what the organism pays for its try; 0 without a try"""
    endowment: Array
    """int32 (N,), fixed point: what the parent pays if its child is born, and the child begins with"""


class Acts(NamedTuple):
    """The tries of each world since its beginning, (W,)."""

    tries: Wide
    births: Wide
    """tries that led to a birth"""
    invested: Wide
    """energy that parents gave to their children, fixed point"""

    def tried(self, tried: Array) -> "Acts":
        """Add the tries of one tick, bool (W, N)."""
        return self._replace(tries=self.tries.plus(tried.sum(axis=1, dtype=jnp.uint32)))

    def born(self, given: Array) -> "Acts":
        """Add the births of one tick; `given` is the endowment paid by each cell, int32 (W, N), or 0."""
        births = (given > 0).sum(axis=1, dtype=jnp.uint32)
        invested = self.invested + total(signed(given), axis=1)
        return self._replace(births=self.births.plus(births), invested=invested)


class Act(Settings):
    """An organism tries to copy itself in each tick in which its copying output is above 0.

    A try costs `price`, whether or not a child is born: if the child's cell is occupied, the price is
    spent and nothing else happens. If a child is born, its parent also pays the child's `endowment`, so
    energy is conserved. An organism that cannot pay both does not try. A try comes before accidents: an
    organism that dies by accident in the tick of its try has paid the price.

    If the endowment is chosen, it is the share 1 / (1 + exp(-y)) of the parent's energy, where y is the
    brain's last output, but at most what is left when the price is paid.
    """

    kind: Literal["act"] = Field(description="act: organisms copy themselves when they choose to")
    price: Rate = Field(1.0, ge=0, le=1e6, description="energy that a try to copy costs")
    endowment: Annotated[
        NUMBER[Annotated[float, Field(gt=0, le=1e6)]] | OTHER[Literal["chosen"]], number_or_word
    ] = Field(
        "chosen",
        description="energy that a parent gives to its child; chosen: a second output sets its share of"
        " the parent's energy",
    )
    fatal: bool = Field(
        False, description="true: a parent may give all its energy away, and then starves"
    )

    @property
    def outputs(self) -> int:
        """Number of outputs that the act adds to a brain."""
        return 2 if self.endowment == "chosen" else 1

    @staticmethod
    def all_outputs(action: int, act: "Act | None") -> int:
        """Return the number of a brain's outputs: those of the action, and those that an act adds."""
        return action + (0 if act is None else act.outputs)

    def tries(self, copying: Array, energy: Array, price: Array) -> Tries:
        """Return which organisms try to copy themselves, and what they pay.

        Args:
            copying: the added outputs, float32 (N, `outputs`).
            energy: energy before the try, int32 (N,).
            price: price of a try, float32, (N,) or broadcast to it.
        """
        price = to_fixed_point(price)
        most = energy - price - (0 if self.fatal else 1)
        if isinstance(self.endowment, float):
            endowment = jnp.full_like(energy, to_fixed_point(jnp.float32(self.endowment)))
        else:
            given = (gate(copying[:, 1]) * energy.astype(jnp.float32)).astype(jnp.int32)
            endowment = jnp.minimum(given, most)
        tried = (copying[:, 0] > 0) & (endowment > 0) & (endowment <= most)
        return Tries(tried, jnp.where(tried, price, 0), jnp.where(tried, endowment, 0))
