"""The seeds of a run's worlds, as text."""

from collections.abc import Iterable
from itertools import groupby

MAX_RANGES = 4
"""Largest number of ranges of seeds that are listed."""


def seeds_text(seeds: Iterable[int]) -> str:
    """Return the seeds of worlds in ascending order, such as `seed 3` or `seeds 0 to 4, 7`.

    The worlds of several runs may have gaps between their seeds, and any order.
    """
    ordered = sorted(set(map(int, seeds)))
    runs = groupby(enumerate(ordered), lambda placed: placed[1] - placed[0])
    ranges = [[seed for _, seed in run] for _, run in runs]
    parts = [f"{each[0]} to {each[-1]}" if len(each) > 1 else f"{each[0]}" for each in ranges]
    if len(parts) > MAX_RANGES:
        parts = [*parts[: MAX_RANGES - 1], f"others up to {ordered[-1]}"]
    return f"{'seed' if len(ordered) == 1 else 'seeds'} {', '.join(parts)}"
