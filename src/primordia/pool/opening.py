"""The choice of a run's pool."""

from collections.abc import Sequence
from typing import Any

from primordia import cores
from primordia.pool.board import Field
from primordia.pool.contract import Pool
from primordia.pool.in_process import InProcess
from primordia.pool.workers import Workers


def open_pool(
    simulator: str,
    settings: dict[str, Any],
    fields: dict[str, Field],
    cells: int,
    workers: int | None = None,
    modules: Sequence[str] = (),
) -> Pool:
    """Make the simulators.

    Args:
        simulator: `module:Class` that keeps the contract of `contract.Simulator`.
        settings: the simulator's settings, in JSON's types.
        fields: dtype and shape of the arrays by name.
        cells: number of simulators.
        workers: number of worker processes, at most one for each cell; 0: the simulators are in this
            process; None: one worker for each core, but 0 if there is only one core or one
            simulator, since a process takes a second to start.
        modules: the user's own modules that the simulators import.

    Raises:
        Trouble: a simulator cannot be made, or a worker does not start.
    """
    if workers is None:
        among = cores.count()
        workers = among if among > 1 and cells > 1 else 0
    if workers == 0:
        return InProcess(simulator, settings, fields, cells)
    return Workers(simulator, settings, fields, cells, min(workers, cells), modules)
