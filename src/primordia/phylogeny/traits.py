"""The traits of the organisms in a phylogeny: their genomes are rebuilt, which takes time."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pyarrow as pa

from primordia.errors import InputError
from primordia.history.traits import factors_of
from primordia.phylogeny.phylogeny import Phylogeny
from primordia.runs.archive import Archive

PREFIX = "trait."
"""Beginning of the names of the columns."""


def with_traits(part: Phylogeny, runs: Sequence[Archive]) -> Phylogeny:
    """Return the organisms with their traits among the facts, as factors; null where a run has none.

    Args:
        part: organisms of a run and of those from which it was forked.
        runs: these runs, the latest first, as in `Past.runs`.

    Raises:
        InputError: bodies are not inherited, or the mutation is code that the user has not trusted.
    """
    traits = runs[0].config.traits
    if traits is None:
        raise InputError("--traits: bodies are not inherited in this run (habitat.traits)")
    found = np.full((len(part), len(traits.names)), np.nan)
    unknown = np.ones(len(part), bool)
    for run in runs:
        rows = run.lives.rows_of(part.lives.world, part.lives.id)
        here = unknown & (rows >= 0)
        if run.config.traits == traits and here.any():
            found[here] = factors_of(run, traits, rows[here])
        unknown &= ~here
    columns = {
        f"{PREFIX}{name}": pa.array(values, mask=np.isnan(values))
        for name, values in zip(traits.names, found.T, strict=True)
    }
    return replace(part, of_births={**part.of_births, **columns})
