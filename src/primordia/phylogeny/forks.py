"""Forks: the record of a fork, joined with the records of the runs from which it was forked.

A fork's records begin with the births of the organisms then alive. Their ancestors, and all that died
before, are on record in the run that was forked.
"""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from primordia.errors import InputError, Trouble
from primordia.phylogeny.phylogeny import Phylogeny, recorded, stacked, taken
from primordia.runs import bundle
from primordia.runs.archive import Archive
from primordia.runs.arrays import read_count
from primordia.runs.lives import Lives
from primordia.runs.opening import archive

AS_INHERITED = ("world", "id", "parent", "cell", "birth_cause", "born")
"""Columns that a fork copies from the births of the organisms alive at the fork."""
Say = Callable[[str], object]
"""A function that is called with a line of text for the user."""


class Past(NamedTuple):
    """All organisms of a run, with those that lived before its fork, back through all earlier forks."""

    whole: Phylogeny
    runs: list[Archive]
    """the run, the run from which it was forked, and so on"""


def whole_past(run: Archive, say: Say) -> Past:
    """Return all organisms of a run, and the runs that have them on record.

    Args:
        run: the run, read as of its newest checkpoint.
        say: called if the run that was forked is missing, or another run is in its place. Then the
            organisms alive at that fork are roots.

    Raises:
        InputError: nothing has lived in the run yet.
        Trouble: the run's records are damaged.
    """
    past, runs, seen = recorded(run), [run], {_real(bundle.origin_of(run.path))}
    while (fork := runs[-1].config.fork) is not None:
        run = runs[-1]
        for place in _places(run):
            if _real(place) in seen:
                continue
            try:
                source = archive(place)
                longer = _joined(_until(source, fork.tick), past, run)
            except (InputError, Trouble):
                continue
            if longer is not None:
                past = longer
                runs.append(source)
                break
        else:
            say(
                f"{bundle.origin_of(run.path)} was forked from {fork.run}, which is missing or was"
                f" replaced by another run: the organisms alive at tick {fork.tick} are roots"
            )
            break
        seen.add(_real(place))
    return Past(past.rooted().with_migrations(), runs)


def _places(run: Archive) -> list[Path]:
    """Return the paths at which the run that was forked may be: as named, or beside the fork."""
    assert run.config.fork is not None
    named = Path(run.config.fork.run)
    return [named, _real(bundle.origin_of(run.path)).parent / named.name]


def _real(path: Path) -> Path:
    """Return a path without links; `Path.resolve` raises an error for links in a circle."""
    return Path(os.path.realpath(path))


def _until(run: Archive, tick: int) -> Phylogeny:
    """Return what a run had on record at the end of a tick.

    Raises:
        InputError: a world has not lived through the tick.
    """
    if run.ends.min() < tick:
        raise InputError(f"{run.path} has not reached tick {tick}")
    known = recorded(run)
    before = known.take(np.flatnonzero(known.lives.born <= tick))
    return replace(before, lives=before.lives.recorded_until(tick))


def _joined(earlier: Phylogeny, later: Phylogeny, fork: Archive) -> Phylogeny | None:
    """Return the organisms of a run up to its fork, and of the fork; None if the fork is of another run.

    Args:
        earlier: organisms of the run that was forked, on record at the end of the fork's tick.
        later: organisms of the fork, and of its forks.
        fork: the fork itself.
    """
    assert fork.config.fork is not None
    alive, again = np.flatnonzero(~earlier.lives.died), np.flatnonzero(later.lives.inherited)
    own = np.flatnonzero(~later.lives.inherited)
    same = _agree(earlier.lives.take(alive), later.lives.take(again))
    if not (same and _follow(later.lives.take(own), earlier.lives, fork)):
        return None
    begun = np.concatenate([np.arange(len(earlier)), len(earlier) + own])
    ended = begun.copy()  # organisms alive at the fork end as the fork records
    ended[alive] = len(earlier) + again
    world = np.concatenate([earlier.lives.world, later.lives.world])[begun]
    order = np.argsort(world.astype(np.uint16), kind="stable")
    begun, ended = begun[order], ended[order]
    lengths = len(earlier), len(later)

    def column(name: str, rows: np.ndarray) -> np.ndarray:
        return np.concatenate([getattr(each.lives, name) for each in (earlier, later)])[rows]

    born = {name: column(name, begun) for name in (*AS_INHERITED, "seen", "inherited")}
    lives = Lives(**born, ended=column("ended", ended), cause=column("cause", ended))
    return Phylogeny(
        lives,
        taken(stacked(earlier.of_births, later.of_births, lengths), begun),
        taken(stacked(earlier.of_deaths, later.of_deaths, lengths), ended),
    )


def _agree(living: Lives, inherited: Lives) -> bool:
    """Return whether the organisms alive in a run are those with which its fork began."""
    return all(
        np.array_equal(getattr(living, name), getattr(inherited, name)) for name in AS_INHERITED
    )


def _follow(own: Lives, past: Lives, fork: Archive) -> bool:
    """Return whether a fork's birth numbers begin where those of the run's past end."""
    if fork.origin is None:
        return False
    births = read_count(fork.origin, "world.worlds.births").astype(np.int64)
    if max(past.worlds, own.worlds) > len(births):
        return False
    return bool((past.id < births[past.world]).all() and (own.id >= births[own.world]).all())
