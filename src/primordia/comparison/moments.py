"""Times in a world's history that are compared: its first long life, and its saturation."""

from collections.abc import Sequence

import numpy as np

from primordia.comparison.measured import Measured
from primordia.errors import InputError
from primordia.runs.arrays import NEVER
from primordia.runs.lives import Lives
from primordia.runs.records import Records


def first_long(worlds: Sequence[Lives], age: int) -> Measured:
    """Count each world's births since a fork, up to the first birth whose life reaches an age.

    The number is known if all organisms born before that birth are dead. Otherwise it is at least
    the number of the first organism that is still alive.
    """
    value, known = [], []
    for lived in (world.take(np.flatnonzero(~world.inherited)) for world in worlds):
        long = lived.lifespan >= age
        first, undecided = (
            int(each.argmax()) if each.any() else len(lived) for each in (long, ~long & ~lived.died)
        )
        value.append(min(first, undecided) + 1)
        known.append(first < undecided)
    return Measured(np.array(value, float), np.array(known))


def saturation(
    run: Records, lives: Lives, begin: int, births: int | None, ticks: int | None
) -> dict[str, Measured]:
    """Return the births and ticks to saturation of each world of a run, counted from tick `begin`.

    Both are 0 in a world that was saturated at that tick. The argument `lives` holds the lives
    recorded since that tick.
    """

    def by_world(name: str) -> np.ndarray:
        return run.count(f"world.worlds.{name}").astype(np.int64)

    known = run.count("world.worlds.saturated") != NEVER
    since = np.bincount(lives.world[~lives.inherited], minlength=len(known))
    before = {"births": by_world("births") - since, "ticks": begin}
    columns = {"births": ("births", "saturated_births"), "ticks": ("tick", "saturated")}
    measured = {}
    for unit, (now, then) in columns.items():
        moment = np.where(known, by_world(then), by_world(now)).astype(float)
        measured[unit] = Measured(np.maximum(moment - before[unit], 0), known)
    for unit, horizon in (("births", births), ("ticks", ticks)):
        if horizon is not None:
            try:
                measured[unit] = measured[unit].before(horizon)
            except InputError as error:
                raise InputError(f"--{unit} {horizon}: in {run.path}, {error}") from None
    return measured


def often_saturated(measured: dict[str, Measured]) -> bool:
    """Return whether at least half of a run's worlds saturate within the horizons."""
    known = measured["births"].known & measured["ticks"].known
    return 2 * int(known.sum()) >= len(known)
