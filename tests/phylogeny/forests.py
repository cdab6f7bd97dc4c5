"""Invented phylogenies, and the libraries that read them back."""

import warnings
from itertools import accumulate

import numpy as np
import pandas as pd
import pyarrow as pa
from hypothesis import strategies as st
from phyloframe import legacy as phyloframe  # noqa: F401, for the tests
from phylotrackpy import systematics

from primordia.law.world import BirthCause, Cause
from primordia.phylogeny.phylogeny import Phylogeny
from primordia.runs.lives import ALIVE, Lives

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # one of its readers imports what Python 3.13 has no more
    import alifedata_phyloinformatics_convert as convert  # noqa: F401, for the tests

END = 1000
"""The last tick of invented worlds."""
ORGANISM = st.tuples(st.integers(0, 9), st.integers(0, 6), st.booleans())
"""How many births ago the parent was born, where 0 is a founder; ticks since the last birth; alive."""
WORLD = st.lists(ORGANISM, min_size=1, max_size=30)
FORESTS = st.lists(WORLD, min_size=1, max_size=3)


def forest(*worlds: list[tuple[int, int, bool]]) -> Phylogeny:
    """Return the phylogeny of worlds, from what is said of each organism in turn; see ORGANISM."""
    ago, alive = (
        np.concatenate([[organism[place] for organism in world] for world in worlds])
        for place in (0, 2)
    )
    number = np.concatenate([np.arange(len(world)) for world in worlds])
    born = np.concatenate([[*accumulate(organism[1] for organism in world)] for world in worlds])
    parent = np.where((ago > 0) & (ago <= number), number - ago, -1)
    lives = Lives(
        world=np.repeat(np.arange(len(worlds), dtype=np.int32), [len(each) for each in worlds]),
        id=number,
        parent=parent,
        cell=(number % 7).astype(np.int32),
        birth_cause=np.where(parent < 0, BirthCause.FOUNDER, BirthCause.COPY).astype(np.int8),
        born=born,
        seen=born,
        inherited=np.zeros(len(born), bool),
        ended=np.where(alive, END, born + 1 + number % 5),
        cause=np.where(alive, ALIVE, Cause.FATAL).astype(np.int8),
    )
    food = pa.array(number / 2, mask=alive.astype(bool))
    return Phylogeny(lives, {}, {"food": food})


def frame(table: pa.Table) -> pd.DataFrame:
    """Return a table as the frame that other libraries take."""
    return table.to_pandas().astype({"birth_cause": str, "death_cause": str})


def parents_of(table: pa.Table) -> dict[int, list[int]]:
    """Return the parents of each organism by id, from the lists of the standard."""
    lists = zip(table["id"].to_pylist(), table["ancestor_list"].to_pylist(), strict=True)
    return {
        number: [] if text == "[NONE]" else [int(each) for each in text[1:-1].split(",")]
        for number, text in lists
    }


def ancestry(parents: dict[int, list[int]], chosen: set[int]) -> set[int]:
    """Return organisms and all their ancestors."""
    found: set[int] = set()
    while chosen:
        found |= chosen
        chosen = {parent for each in chosen for parent in parents[each]} - found
    return found


def phylotrack(path: str) -> systematics.Systematics:
    """Return a phylogeny as phylotrackpy loads it; the living have no time of death."""
    loaded = systematics.Systematics(lambda organism: organism)
    loaded.load_from_file(path, "id", False)
    return loaded
