"""The diversity of the living over time: of their tree (Faith 1992), and of their lines (Hill 1973).

A life is divided into pieces at the births of its children. Each piece is a branch of the tree of all
organisms. A piece belongs to the tree of the living at a tick if an organism alive at this tick lived
the piece or descends from it. So the sum of branches needs no tree: a piece is added when it is
complete, and removed when its last descendant dies.
"""

from array import array

import numpy as np

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

    Each result is int64. The first pieces of all lives come first. Then comes the piece of each
    parent that begins with the birth of a child, and ends with the birth of the next one.
    """
    parents, born = (array("q", each.tobytes()) for each in (lives.parent_row, lives.born))
    # So far, an organism has only the children that are younger than the one that is looked at.
    until = array("q", np.minimum(stops(lives), lives.ended.max() + 1).tobytes())  # small numbers
    gone = until[:]
    following, rest = until[:], until[:]
    for row in range(len(parents) - 1, -1, -1):
        if (parent := parents[row]) >= 0:
            following[row], rest[row] = until[parent], gone[parent]
            until[parent] = born[row]
            if gone[row] > gone[parent]:
                gone[parent] = gone[row]
    child = np.flatnonzero(lives.parent_row >= 0)
    begin = np.concatenate([lives.born, lives.born[child]])
    of_lives, of_parents = ((until, gone), (following, rest))
    end, last = (
        np.concatenate([np.frombuffer(first, np.int64), np.frombuffer(later, np.int64)[child]])
        for first, later in zip(of_lives, of_parents, strict=True)
    )
    return begin, end, last
