"""The summary of a run in a few lines."""

from collections import Counter
from collections.abc import Iterable
from itertools import groupby
from typing import Any

import numpy as np

from primordia.printable import counted, often

MAX_LISTED = 4
"""Largest number of worlds that are described one by one."""
AGES = ("mean age", "median lifespan")
"""Numbers of an island that are medians over worlds; others are sums."""
MAX_RANGES = 4
"""Largest number of ranges of seeds that are listed."""


def summary(info: dict[str, Any]) -> str:
    """Return the summary of a run from its numbers (`info.info`)."""
    worlds = info["worlds"]
    control = "" if info["inheritance"] == "parent" else ", no heredity"
    lines = [f"{info['task']}: {counted(len(worlds), 'world')} of {info['cells']:,} cells{control}"]
    lines += _break_even(worlds) + _too_few_copies(worlds)
    if len(worlds) <= MAX_LISTED:
        for world in worlds:
            lines += _one_world(world)
    else:
        lines += _all_worlds(worlds)
    if faults := sum(world["deaths_by_cause"].get("fault", 0) for world in worlds):
        lines.append(
            f"  {counted(faults, 'organism')} died of a fault: a number was not finite, or the habitat"
            " raised an error, which faults.txt names"
        )
    if not info["exact"]:
        lines.append("  not exact: parts of this run cannot be repeated bit for bit")
    lines += [
        f"  not the newest state, since a checkpoint is damaged: {each}" for each in info["damaged"]
    ]
    if times := info["restarts"]:
        lines.append(f"  the living got new bodies {often(times)}, when the run was resumed")
    return "\n".join(lines)


def _one_world(world: dict[str, Any]) -> list[str]:
    lines = [
        f"  seed {world['seed']}: {world['ticks']:,} ticks, {world['births']:,} births, "
        f"deaths: {_causes([world])}{_extinct(world)}",
        f"    {world['alive']:,} alive",
    ]
    if world["alive"]:
        lines[-1] += f", mean age {world['mean_age']:,.0f}, oldest {world['oldest_age']:,}"
    if "tallies" in world:
        lines.append(f"    tallies of the living: {_tallies(world['tallies'])}")
    if world["fixation"]:
        lines.append(
            f"    all descend from one child of a founder since {_when(world['fixation'])}"
        )
    lines += _act([world]) + _traits([world]) + _threshold([world]) + _islands([world])
    if world["saturation"]:
        return [*lines, f"    saturated at {_when(world['saturation'])}"]
    return [*lines, "    not saturated"]


def _extinct(world: dict[str, Any]) -> str:
    times, crashes = world["extinctions"], world["crashes"]
    if not times:
        return ""
    extinct = f", extinct {often(times)}"
    if not crashes:
        return extinct
    risen = "" if times == 1 else f" {often(crashes)}"
    return f"{extinct},{risen} after half of the cells were full"


def _break_even(worlds: list[dict[str, Any]]) -> list[str]:
    """Return a line with the food that keeps an organism alive: the range over all worlds.

    There is no line if living costs nothing without effort.
    """
    amounts, costs = [], False
    for unit in ("tick", "second"):
        food = [world.get("break_even", {}).get(f"food_per_{unit}") for world in worlds]
        if None not in food:
            low, high = f"{min(food):.3g}", f"{max(food):.3g}"
            amounts.append(f"{low if low == high else f'{low} to {high}'} a {unit}")
            costs |= max(food) > 0
    return [f"  break-even: food of {', or '.join(amounts)}"] if costs else []


def _too_few_copies(worlds: list[dict[str, Any]]) -> list[str]:
    """Return a line that says why worlds die out, if organisms replicate less than once in a life."""
    births = sum(world["births"] for world in worlds)
    if not births or not any(world["extinctions"] for world in worlds) or "act" in worlds[0]:
        return []
    tries = sum(world["births"] * (world["tries_per_life"] or 0) for world in worlds) / births
    few = f"  an organism tries to copy itself {tries:.2g} times in its life; raise `replication`"
    return [f"{few}, or lineages die out"] if tries < 1 else []


def _act(worlds: list[dict[str, Any]]) -> list[str]:
    """Return a line on tries to copy and on endowments, if replication is an act."""
    acts = [world["act"] for world in worlds if "act" in world]
    if not acts:
        return []
    tries, failed, children, invested = (
        sum(each[name] for each in acts) for name in ("tries", "failed", "children", "invested")
    )
    given = f"; a child begins with {invested / children:,.3g} on average" if children else ""
    return [f"    {tries:,} tries to copy, {failed:,} of them failed{given}"]


def _traits(worlds: list[dict[str, Any]]) -> list[str]:
    """Return a line with each trait of the living: median and quartiles, or medians over worlds."""
    known = [world["traits"] for world in worlds if "traits" in world]
    if not known:
        return []
    parts = []
    for name, first in known[0].items():
        middle = [each[name]["median"] for each in known]
        spread = np.quantile(middle, [0.25, 0.5, 0.75]) if len(worlds) > 1 else first.values()
        q1, median, q3 = spread
        parts.append(f"{name} x {median:.3g} ({q1:.3g} to {q3:.3g})")
    over = "" if len(worlds) == 1 else ", medians over worlds"
    return [f"    traits of the living{over}: {', '.join(parts)}"]


def _tallies(tallies: dict[str, dict[str, float]]) -> str:
    parts = [
        f"{name} {values['median']:,.0f} (best {values['best']:,})"
        for name, values in tallies.items()
    ]
    return f"median {', '.join(parts)}"


def _when(moment: dict[str, int]) -> str:
    return f"tick {moment['tick']:,} ({moment['births']:,} births until then)"


def _all_worlds(worlds: list[dict[str, Any]]) -> list[str]:
    def total(name: str) -> int:
        return sum(world[name] for world in worlds)

    oldest = max(world["oldest_age"] or 0 for world in worlds)
    crashes = total("crashes")
    risen = f" ({crashes:,} after half of the cells were full)" if crashes else ""
    return [
        f"  {seeds_text(world['seed'] for world in worlds)}: {total('ticks'):,} ticks, "
        f"{total('births'):,} births, deaths: {_causes(worlds)}",
        f"    {total('alive'):,} alive, oldest {oldest:,}; extinctions: "
        f"{total('extinctions'):,}{risen}",
        f"    {_share(worlds, 'fixation', 'descend from one child of a founder')}",
        f"    {_share(worlds, 'saturation', 'saturated')}",
        *_act(worlds),
        *_traits(worlds),
        *_threshold(worlds),
        *_islands(worlds),
    ]


def _islands(worlds: list[dict[str, Any]]) -> list[str]:
    """Return a line for each island: sums over worlds, and medians over worlds; none without islands."""
    lines = []
    for each in zip(*(world.get("islands", []) for world in worlds), strict=True):
        living, cells, births, immigrants = (
            sum(island[name] for island in each)
            for name in ("living", "cells", "births", "immigrants")
        )
        over = "; medians over worlds: " if len(each) > 1 else ", "
        ages = [
            _median(words, [island[words.replace(" ", "_")] for island in each]) for words in AGES
        ]
        lines.append(
            f"    {each[0]['name']}: {living:,} / {cells:,} alive, {births:,} births, "
            + counted(immigrants, "immigrant")
            + (over + ", ".join(filter(None, ages)) if any(ages) else "")
        )
    return lines


def _median(words: str, values: list[float | None]) -> str:
    """Return a number of one world, or the median over worlds; "" if no world has one."""
    known = [value for value in values if value is not None]
    return f"{words} {np.median(known):,.0f}" if known else ""


def _threshold(worlds: list[dict[str, Any]]) -> list[str]:
    """Return a line on the error threshold, or no line if the threshold is unknown."""
    known = [each["threshold"] for each in worlds if each["threshold"]["held"] is not None]
    if not known:
        return []
    p, v, s, held = (
        f"{np.median([each[name] for each in known]):.2g}"
        for name in ("mutated", "as_good", "advantage", "held")
    )
    above = sum(each["held"] > 1 for each in known)
    numbers = f"p {p}, v {v}, s {s}: s (1 - p (1 - v)) is {held}"
    if len(worlds) == 1:
        return [f"    good lines {'persist' if above else 'are lost'}: {numbers}"]
    return [f"    good lines persist in {above:,} of {len(known):,} worlds; medians {numbers}"]


def _causes(worlds: list[dict[str, Any]]) -> str:
    counts = sum((Counter(world["deaths_by_cause"]) for world in worlds), Counter[str]())
    return ", ".join(f"{count:,} {cause}" for cause, count in counts.items()) or "none"


def _share(worlds: list[dict[str, Any]], name: str, what: str) -> str:
    """Return how many worlds passed a moment, and after how many births; other worlds count as later."""
    births = np.array([world[name]["births"] if world[name] else np.inf for world in worlds])
    share = f"{np.isfinite(births).sum():,} of {len(worlds):,} {what}"
    q1, median, q3 = np.quantile(births, [0.25, 0.5, 0.75], method="inverted_cdf")
    if not np.isfinite(q1):
        return share
    middle, high = (f"{b:,.0f}" if np.isfinite(b) else "later" for b in (median, q3))
    return f"{share}, births until then: median {middle} (quartiles {q1:,.0f}, {high})"


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
