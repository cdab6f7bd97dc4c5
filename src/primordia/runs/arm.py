"""Arms: several runs read as one, if only their seeds and limits differ."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from primordia import files
from primordia.brains.genomes import FOUNDERS
from primordia.errors import InputError
from primordia.runs.records import Records
from primordia.settings.tables import flat

OWN = ("about", "seed", "seeds", "stop", "fork")
"""The settings in which the runs of an arm may differ; forks must begin at the same tick."""
MOST = 2**16
"""Largest number of worlds of an arm."""


def arm(path: Path, runs: Sequence[Records]) -> Records:
    """Return the records of several runs as those of one arm.

    Args:
        path: the arm's folder, or any name.
        runs: one run or more, with the same settings except OWN.

    Raises:
        InputError: settings differ, or a world is given twice.
    """
    _refuse_others(runs)
    joined = Records(path, runs)
    _refuse_twice(runs, joined.world_seeds)
    return joined


def _refuse_others(runs: Sequence[Records]) -> None:
    """Raise InputError unless all runs have the settings, the code and the founders of the first."""
    first, *others = runs
    compared: dict[str, Callable[[Records], Any]] = {
        "settings": _settings,
        "description": lambda run: flat(run.description.model_dump(exclude={"files_from"})),
        "ancestors": lambda run: {
            "genomes": run.config.ancestors and files.sha256(run.path / FOUNDERS)
        },
    }
    for run in others:
        for values in compared.values():
            own, reference = values(run), values(first)
            names = own | reference
            if differing := [name for name in names if own.get(name) != reference.get(name)]:
                raise InputError(
                    f"{run.path} and {first.path} do not belong to one arm: they differ in"
                    f" {differing[0]}"
                )
        own = {name: getattr(run.config, name) for name in OWN}
        run.config = first.config.model_copy(update=own)  # stored once, and the description too
        run.description = first.description


def _settings(run: Records) -> dict[str, Any]:
    """Return the settings that must be equal, by dotted name.

    Each run has the genomes of its ancestors in a file of its own; `_refuse_others` compares the content.
    """
    ignored: Any = {**dict.fromkeys((*OWN, "ancestors"), True), "fork": {"run"}}
    return flat(run.config.model_dump(mode="json", exclude=ignored))


def _refuse_twice(runs: Sequence[Records], seeds: np.ndarray) -> None:
    if len(seeds) > MOST:
        raise InputError(f"an arm has at most {MOST:,} worlds, not {len(seeds):,}")
    run_of = np.repeat(np.arange(len(runs)), [run.config.seeds for run in runs])
    order = np.argsort(seeds, kind="stable")
    twice = np.flatnonzero(seeds[order][1:] == seeds[order][:-1])
    if len(twice):
        one, other = (runs[run_of[row]].path for row in order[twice[0] : twice[0] + 2])
        raise InputError(f"{one} and {other} both hold the world of seed {seeds[order[twice[0]]]}")
