"""The diversity of the living over time: of their tree (Faith 1992), and of their lines (Hill 1973).

A life is divided into pieces at the births of its children. Each piece is a branch of the tree of all
organisms. A piece belongs to the tree of the living at a tick if an organism alive at this tick lived
the piece or descends from it. So the sum of branches needs no tree: a piece is added when it is
complete, and removed when its last descendant dies.
"""

import numpy as np

from primordia.history.ancestry import ROWS
from primordia.phylogeny.living import stops
from primordia.runs.lives import Lives


def phylogenetic_diversity(lives: Lives, ticks: np.ndarray) -> np.ndarray:
    """Return the total length of the tree of the living after each tick, from its roots on, int64 (T,).

    The unit is ticks. The length is the time for which the lines of the living have existed, and
    each tick counts once for each line that existed then. In a fork, lines begin at the births of
    those organisms that were alive at the fork and whose parents are not on record.

    Source: Faith 1992, "Conservation evaluation and phylogenetic diversity".
    """
    begin, end, gone = _pieces(lives)
    last = len(ticks)
    length = np.zeros(last + 1, np.int64)
    complete, left = np.searchsorted(ticks, end), np.searchsorted(ticks, gone)
    inside = complete < left
    np.add.at(length, complete[inside], (end - begin)[inside])
    np.add.at(length, left[inside], -(end - begin)[inside])
    # Pieces that are being lived reach up to the tick.
    entered, ended = np.searchsorted(ticks, begin), np.minimum(complete, left)
    lived = entered < ended
    number, sum_of_begins = np.zeros(last + 1, np.int64), np.zeros(last + 1, np.int64)
    for places, sign in ((entered[lived], 1), (ended[lived], -1)):
        np.add.at(number, places, sign)
        np.add.at(sum_of_begins, places, sign * begin[lived])
    whole, now, begun = (each.cumsum()[:last] for each in (length, number, sum_of_begins))
    return whole + now * ticks - begun


def hill_numbers(counts: np.ndarray) -> np.ndarray:
    """Return the effective numbers of lines of orders 0, 1 and 2, float64 (3, ...); 0 if nothing lives.

    They are the number of lines, the exponential of Shannon's entropy of their shares, and the inverse
    of the probability that two of the living, drawn with replacement, are of one line.

    Args:
        counts: how many of each line are alive, (..., K).

    Source: Hill 1973, "Diversity and evenness: a unifying notation and its consequences".
    """
    share = counts / np.maximum(counts.sum(axis=-1, keepdims=True), 1)
    logs = np.log(np.where(share > 0, share, 1))
    some = share.any(axis=-1)
    richness = (share > 0).sum(axis=-1).astype(float)
    entropy = np.where(some, np.exp(-(share * logs).sum(axis=-1)), 0)
    twice = (share**2).sum(axis=-1)
    return np.array([richness, entropy, np.where(some, 1 / np.where(some, twice, 1), 0)])


def _pieces(lives: Lives) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return when the pieces of lives begin and end, and when the last descendant of each piece dies.

    Each result is int64. The last piece of a life ends with the life.
    """
    stop = np.minimum(stops(lives), lives.ended.max() + 1)  # small numbers
    parent = lives.parent_row
    gone = _last_descendant(parent, stop)
    child = np.flatnonzero(parent >= 0)
    order = np.argsort(parent[child], kind="stable")  # by parent, and the older child first
    child = child[order]
    of, later = parent[child], _next_of_group(parent[child])
    # Each child's birth begins a piece of its parent, which the next child's birth ends.
    following = np.where(later, lives.born[np.append(child[1:], 0)], stop[of])
    first = np.flatnonzero(np.diff(of, prepend=-1))
    until = stop.copy()  # the end of the first piece of each life
    until[of[first]] = lives.born[child[first]]
    rest = _latest_after(of, gone[child], stop[of])
    begin = np.concatenate([lives.born, lives.born[child]])
    return begin, np.concatenate([until, following]), np.concatenate([gone, rest])


def _next_of_group(groups: np.ndarray) -> np.ndarray:
    """Return, for each element, whether the next element has the same group, bool."""
    return np.append(groups[1:] == groups[:-1], False)


def _latest_after(of: np.ndarray, gone: np.ndarray, stop: np.ndarray) -> np.ndarray:
    """Return, for each child, when its parent and the lines of all later children have ended, int64.

    Args:
        of: parent of each child, rising; its children in the order of birth.
        gone: when the last of each child's line dies.
        stop: when each child's parent dies.
    """
    apart = int(max(gone.max(initial=0), stop.max(initial=0))) + 1
    lift = (of.max(initial=0) - of)[::-1] * apart  # one parent's values are above those of the next
    latest = (np.maximum.accumulate(gone[::-1] + lift) - lift)[::-1]
    return np.maximum(stop, np.where(_next_of_group(of), np.append(latest[1:], 0), 0))


def _last_descendant(parent_row: np.ndarray, stop: np.ndarray) -> np.ndarray:
    """Return the tick from which each organism and all its descendants are dead, int64 (L,)."""
    gone = stop.copy()
    for first in range((len(stop) - 1) // ROWS * ROWS, -1, -ROWS):
        own, parent = gone[first : first + ROWS], parent_row[first : first + ROWS]
        child, jump = np.flatnonzero(parent >= first), parent - first
        while len(child):  # the way up is doubled in each step
            np.maximum.at(own, jump[child], own[child])
            further = jump[jump[child]]
            jump[child] = further
            child = child[further >= 0]
        older = np.flatnonzero((parent >= 0) & (parent < first))
        np.maximum.at(gone, parent[older], own[older])
    return gone
