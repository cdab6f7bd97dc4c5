"""The line of descent of an organism: its ancestors, their mutations, and how far each line spread."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from primordia.errors import InputError
from primordia.history import series
from primordia.history.ancestry import children, nearest
from primordia.history.islands import names_of
from primordia.history.rebuilding import bodies, changes, descent
from primordia.history.series import plain
from primordia.law.world import BirthCause, Cause
from primordia.phylogeny.coalescence import Genealogy
from primordia.phylogeny.fixation import UNKNOWN, first_ticks
from primordia.phylogeny.forks import Say, whole_past
from primordia.phylogeny.frequencies import instants
from primordia.phylogeny.living import Census, Turnover, branches
from primordia.runs.archive import Archive, run_of
from primordia.runs.lives import Lives
from primordia.runs.records import Records

SHARES = {"tenth": 0.1, "half": 0.5, "fixed": 1}
"""Shares of the living; `first_ticks` gives the first tick at which an ancestor's descendants reach
each share."""


@dataclass(frozen=True)
class CommonAncestor:
    """The youngest organism from which all the living of a world descend."""

    organism: int
    born: int
    """tick of its birth"""
    since: int
    """first tick after which all the living were the organism or its descendants"""
    generation: int
    """number of births from the root of the line to the organism"""


@dataclass(frozen=True)
class Ancestors:
    """An organism of a run and its D - 1 ancestors, the oldest first."""

    organism: int
    world: int
    line: Lives
    """the lives of the ancestors and the organism"""
    children: np.ndarray
    """number of children of each organism so far, int64 (D,)"""
    blocks: list[str]
    """names of the B blocks of weights"""
    changes: np.ndarray | None
    """size of each mutation by block, float64 (D, B), or None if unknown; see `rebuilding.changes`"""
    unknown: str | None
    """why the sizes of mutations, or of those before a fork, are not known"""
    ticks: dict[str, np.ndarray]
    """for each of SHARES, the first tick after which each organism's descendants were more than
    this share of the living (for a share of 1, all of the living), int64 (D,), or UNKNOWN"""
    census: Census
    """the living of the world at chosen instants"""
    branch: np.ndarray
    """place where the line of each organism of the world leaves this line, int64; see `branches`"""
    common: CommonAncestor | None
    """the common ancestor of the living; None if there is none on record"""
    roots: int
    """number of roots of the living: ancestors without a parent on record"""
    traits: dict[str, np.ndarray] | None = None
    """each trait of the organisms' bodies, as a factor, float64 (D,), NaN where it is not known; None if
    bodies are not inherited"""
    islands: list[str] | None = None
    """name of the island on which each organism was born, [D]; None if the worlds have no islands"""

    @property
    def migrations(self) -> np.ndarray | None:
        """Number of births on another island than the parent's, from the root of the line to each
        organism, int64 (D,); None if the worlds have no islands."""
        if self.islands is None:
            return None
        home = np.array(self.islands)
        return np.append(0, np.cumsum(home[1:] != home[:-1]))

    @cached_property
    def size(self) -> np.ndarray | None:
        """Size of each mutation over all blocks, float64 (D,); NaN where it is not known."""
        return None if self.changes is None else np.sqrt((self.changes**2).sum(axis=1))

    def shares(self, places: np.ndarray) -> np.ndarray:
        """Return the share of the living that descended from organisms of the line at each instant,
        (T, K).

        Args:
            places: places on the line, in ascending order, int64 (K,).
        """
        group = np.searchsorted(places, self.branch, side="right") - 1
        counts = self.census.counts(group, len(places))
        from_each = counts[:, ::-1].cumsum(axis=1)[:, ::-1]
        return from_each / np.maximum(self.census.living, 1)[:, None]

    def telling(self, most: int) -> np.ndarray:
        """Return the first, last and most important places on the line, in order; `most` limits them.

        Almost half of the places are those with the largest ratio of lifespan to parent's lifespan. The
        other places are evenly spaced.
        """
        count = len(self.line)
        if count <= most:
            return np.arange(count)
        lived = np.maximum(self.line.lifespan, 1)
        gain = np.append(0.0, np.log(lived[1:] / lived[:-1]))
        chosen = {0, count - 1, *np.argsort(-gain, kind="stable")[: most // 2 - 1].tolist()}
        spaced = series.places(count, most).tolist()
        others = [place for place in spaced if place not in chosen]
        wanted = most - len(chosen)
        return np.array(sorted(chosen | set(others[:: -(-len(others) // wanted)][:wanted])))

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON, with all ancestors."""
        return {
            "organism": self.organism,
            "world": self.world,
            "blocks": self.blocks,
            "changes_unknown": self.unknown,
            "roots_of_the_living": self.roots,
            "common_ancestor": self.common and asdict(self.common),
            "line": [self.step(place) for place in range(len(self.line))],
        }

    def step(self, place: int) -> dict[str, Any]:
        """Return an organism of the line as plain values; what is unknown or has not happened is None."""
        line, parent = self.line, int(self.line.parent[place])
        size = None if self.changes is None else plain(self.changes[place])
        places = {}
        if self.islands is not None and self.migrations is not None:
            places = {"island": self.islands[place], "migrations": int(self.migrations[place])}
        body = {name: plain(each[place]) for name, each in (self.traits or {}).items()}
        return {
            "generation": place,
            "organism": int(line.id[place]),
            "parent": None if parent < 0 else parent,
            "born": int(line.born[place]),
            "lifespan": int(line.lifespan[place]),
            "cause": Cause(line.cause[place]).label if line.died[place] else None,
            "children": int(self.children[place]),
            "birth_cause": BirthCause(line.birth_cause[place]).label,
            **places,
            **({"traits": body} if body else {}),
            "change": size and dict(zip(self.blocks, size, strict=True)),
            **{name: _happened(ticks[place]) for name, ticks in self.ticks.items()},
        }


def ancestors(run: Records, organism: int, world: int = 0, say: Say = warnings.warn) -> Ancestors:
    """Follow the line of descent of an organism, from the records alone.

    A line ends with a founder. At a fork the line goes on in the run that was forked.

    Args:
        run: the organism's run, or an arm.
        organism: birth number.
        world: the organism's world.
        say: called if a run that was forked is missing, or another run is in its place. Then the
            line ends with an organism that was alive at that fork.

    Raises:
        InputError: no such organism was born.
    """
    archive, own = run_of(run, world)
    lives, runs = archive.lives, [archive]
    if archive.config.fork is not None:
        past = whole_past(archive, say)
        lives, runs = past.whole.lives, past.runs
    lives = lives.of_world(own)
    line = descent(lives, organism, own)
    turnover, branch = Turnover.of(lives), branches(lives.parent_row, line)
    ticks = first_ticks(turnover, branch, len(line), tuple(SHARES.values()))
    known, unknown = _along(changes, runs, lives.take(line), own)
    genealogy = Genealogy.of(lives)
    begin = max(int(lives.born[line[0]]), int(lives.seen.min()))
    return Ancestors(
        organism=organism,
        world=world,
        line=lives.take(line),
        children=children(lives.parent_row)[line],
        blocks=archive.layout.names,
        changes=known,
        unknown=unknown,
        ticks=dict(zip(SHARES, ticks, strict=True)),
        census=Census(lives, instants(begin, int(lives.ended.max()))),
        branch=branch,
        common=_common(genealogy),
        roots=len(genealogy.roots),
        traits=_bodies(runs, lives.take(line), own),
        islands=_islands(runs, lives.take(line)),
    )


def _islands(runs: Sequence[Archive], line: Lives) -> list[str] | None:
    """Return the island of birth of each organism of a line, from the run in which it was born; None
    if no run has islands."""
    found = [""] * len(line)
    for run in reversed(runs):
        since = int((line.born <= run.config.begins).sum())
        first = since if run is not runs[-1] else 0
        found[first:] = names_of(run.config.islands, line.cell[first:]) or found[first:]
    return found if any(found) else None


def _along(
    of_run: Callable[[Records, int, int], np.ndarray],
    runs: Sequence[Archive],
    line: Lives,
    world: int,
) -> tuple[np.ndarray | None, str | None]:
    """Return numbers of the organisms on a line, float64 (D, n), and why some are unknown.

    Each run gives its part. Code of a run is executed only if the user has trusted the code.

    Args:
        of_run: returns the numbers of an organism of a run and of its ancestors.
        runs: the run of the line, then those from which it was forked.
        line: the line, the oldest first.
        world: the world of the line.
    """
    found, until = None, len(line)
    for run in runs:
        before = int((line.born <= run.config.begins).sum())
        if before == until and run is not runs[-1]:
            continue  # all were alive at the run's fork, or are older
        try:
            own = of_run(run, int(line.id[until - 1]), world)
        except InputError as error:
            return found, str(error)
        if found is None:
            found = np.full((len(line), own.shape[1]), np.nan)
        found[until - len(own) : until] = own
        if not before:
            break
        until = before
    return found, None


def _bodies(runs: Sequence[Archive], line: Lives, world: int) -> dict[str, np.ndarray] | None:
    """Return each trait of the organisms on a line, float64 (D,); None if none is known."""
    if (traits := runs[0].config.traits) is None:
        return None
    found, _ = _along(bodies, runs, line, world)
    return None if found is None else dict(zip(traits.names, found.T, strict=True))


def _common(genealogy: Genealogy) -> CommonAncestor | None:
    """Return the common ancestor of the living of one world."""
    row, lives = genealogy.common_ancestor, genealogy.lives
    if row is None:
        return None
    younger = np.maximum(lives.parent_row[row:] - row, -1)  # its descendants are among them
    others = np.append(lives.ended[:row], lives.ended[row:][nearest(younger, np.zeros(1, int)) < 0])
    above = genealogy.rows[: np.searchsorted(genealogy.rows, row)]  # all its ancestors
    return CommonAncestor(
        organism=int(lives.id[row]),
        born=int(lives.born[row]),
        since=int(max(lives.born[row], others.max(initial=0))),  # all others are dead
        generation=len(above),
    )


def _happened(tick: int) -> int | None:
    return None if tick == UNKNOWN else int(tick)
