"""Invented pedigrees: small ones drawn by hypothesis, and Moran processes with or without selection."""

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st

from primordia.law.world import BirthCause
from primordia.random.trials import words
from primordia.runs.lives import Lives
from tests.synthetic import one_world

FEW = st.lists(st.integers(0, 30), max_size=3)
HISTORY = st.lists(st.tuples(FEW, FEW), max_size=30)
"""For each tick: which of the living have a child, and which of them die."""
Event = tuple[list[int], list[int]]


def walked(history: list[Event], founders: int = 1) -> Lives:
    """Return the lives of a world with this history; when it dies out it is founded again at once."""
    parent, born = [-1] * founders, [0] * founders
    ended, now = [-1] * founders, list(range(founders))
    for tick, (mothers, dying) in enumerate(history, 1):
        begin = len(parent)
        parent += [now[each % len(now)] for each in mothers]
        dead = {now[each % len(now)] for each in dying}
        now = [each for each in now + list(range(begin, len(parent))) if each not in dead]
        if not now:
            now = list(range(len(parent), len(parent) + founders))
            parent += [-1] * founders
        born += [tick] * (len(parent) - len(born))
        ended += [-1] * (len(parent) - len(ended))
        for each in dead:
            ended[each] = tick
    died = [each >= 0 for each in ended]
    ended = [each if each >= 0 else len(history) for each in ended]
    return lives_of(parent, born, ended, died)


def living_after(lives: Lives, tick: int) -> list[int]:
    """Return the rows of those alive after a tick, looked at one by one."""
    return [
        row
        for row in range(len(lives))
        if lives.born[row] <= tick and not (lives.died[row] and lives.ended[row] <= tick)
    ]


def line_to(lives: Lives, row: int) -> list[int]:
    """Return the rows of an organism and its ancestors, the youngest first."""
    line = [row]
    while lives.parent[line[-1]] >= 0:
        line.append(int(lives.parent[line[-1]]))
    return line


def share_after(lives: Lives, ancestor: int, tick: int) -> float:
    """Return the share of those alive after a tick that descend from an ancestor, or are it."""
    living = living_after(lives, tick)
    return sum(ancestor in line_to(lives, row) for row in living) / max(len(living), 1)


def common_after(lives: Lives, tick: int) -> int | None:
    """Return the youngest common ancestor of those alive after a tick."""
    lines = [line_to(lives, row) for row in living_after(lives, tick)]
    return next((row for row in lines[0] if all(row in line for line in lines)), None)


def moran(
    size: int, births: int, name: int = 0, fitness: Callable[[int], float] | None = None
) -> Lives:
    """Return the lives of a world filled with founders; each tick has one birth and one death.

    The child of a random organism takes the place of a random organism, which may be its parent.

    Args:
        size: number of living.
        births: number of births after those of the founders.
        name: name of the random numbers.
        fitness: relative probability, at most 1, that an organism drawn as a parent is one, by the row
            of its founder; otherwise another is drawn. None: all are equal.
    """
    draws = iter((words(name, 8 * births + 64).astype(np.uint64) * size >> np.uint64(32)).tolist())
    accepts = iter((words(name + 1, 8 * births + 64) / 2**32).tolist())
    place, founder = list(range(size)), list(range(size))
    parent, ended = [-1] * size, [births] * size
    died = [False] * size
    for tick in range(1, births + 1):
        of = next(draws)
        while fitness is not None and next(accepts) >= fitness(founder[place[of]]):
            of = next(draws)
        dead, gone = next(draws), len(parent)
        parent.append(place[of])
        founder.append(founder[place[of]])
        ended.append(births)
        died.append(False)
        ended[place[dead]], died[place[dead]] = tick, True
        place[dead] = gone
    return lives_of(parent, [0] * size + list(range(1, births + 1)), ended, died)


def lives_of(parent: list[int], born: list[int], ended: list[int], died: list[bool]) -> Lives:
    """Return the lives of one world by the rows of parents; all that have one are mutants."""
    cause = np.where(np.array(parent) < 0, BirthCause.FOUNDER, BirthCause.MUTANT).astype(np.int8)
    cell = np.zeros(len(parent), np.int32)
    return one_world(born, ended, died, parent, cell=cell, birth_cause=cause)
