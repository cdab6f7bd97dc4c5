"""What happened in a run, in a few lines."""

from collections import Counter
from typing import Any

import numpy as np

FEW = 4
"""so many worlds have lines of their own"""


def summary(info: dict[str, Any]) -> str:
    """Of `info.info`."""
    worlds, heredity = info["worlds"], info["inheritance"] == "parent"
    count = "1 world" if len(worlds) == 1 else f"{len(worlds):,} worlds"
    lines = [
        f"{info['task']}: {count} of {info['cells']:,} cells{', no heredity' * (not heredity)}"
    ]
    lines += _break_even(worlds) + _too_few_copies(worlds)
    if len(worlds) <= FEW:
        for world in worlds:
            lines += _one(world)
    else:
        lines += _many(worlds)
    if not info["exact"]:
        lines.append("  not exact: parts of this run cannot be repeated bit for bit")
    return "\n".join(lines)


def _one(world: dict[str, Any]) -> list[str]:
    times = world["extinctions"]
    extinct = f", extinct {times:,} time{'s' * (times > 1)}" * bool(times)
    lines = [
        f"  seed {world['seed']}: {world['ticks']:,} ticks, {world['births']:,} births, "
        f"deaths: {_causes([world])}{extinct}",
        f"    {world['alive']:,} alive",
    ]
    if world["alive"]:
        lines[-1] += f", mean age {world['mean_age']:,.0f}, oldest {world['oldest_age']:,}"
    if "tallies" in world:
        lines.append(f"    of the living: {_tallies(world['tallies'])}")
    if world["fixation"]:
        lines.append(f"    came to descend from one ancestor {_when(world['fixation'])}")
    if world["saturation"]:
        return [*lines, f"    saturated {_when(world['saturation'])}"]
    return [*lines, "    not saturated"]


def _break_even(worlds: list[dict[str, Any]]) -> list[str]:
    """What food keeps one alive, from the world where it is least to where it is most."""
    told = []
    for unit in ("tick", "second"):
        each = [world.get("break_even", {}).get(f"food_per_{unit}") for world in worlds]
        if None not in each:
            low, high = f"{min(each):.3g}", f"{max(each):.3g}"
            told.append(f"{low if low == high else f'{low} to {high}'} a {unit}")
    return [f"  break-even: food of {', or '.join(told)}"] if told else []


def _too_few_copies(worlds: list[dict[str, Any]]) -> list[str]:
    """Why worlds die out, where lineages cannot last."""
    births = sum(world["births"] for world in worlds)
    if not births or not any(world["extinctions"] for world in worlds):
        return []
    tries = sum(world["births"] * (world["tries_per_life"] or 0) for world in worlds) / births
    few = f"  an organism tries to copy itself {tries:.2g} times in its life; raise `replication`"
    return [f"{few}, or lineages die out"] if tries < 1 else []


def _tallies(tallies: dict[str, dict[str, float]]) -> str:
    each = (f"{name} {of['median']:,.0f} (best {of['best']:,})" for name, of in tallies.items())
    return f"median {', '.join(each)}"


def _when(moment: dict[str, int]) -> str:
    return f"at tick {moment['tick']:,} after {moment['births']:,} births"


def _many(worlds: list[dict[str, Any]]) -> list[str]:
    def total(name: str) -> int:
        return sum(world[name] for world in worlds)

    oldest = max(world["oldest_age"] or 0 for world in worlds)
    return [
        f"  seeds {worlds[0]['seed']} to {worlds[-1]['seed']}: {total('ticks'):,} ticks, "
        f"{total('births'):,} births, deaths: {_causes(worlds)}",
        f"    {total('alive'):,} alive, oldest {oldest:,}; extinctions: {total('extinctions'):,}",
        f"    {_share(worlds, 'fixation', 'of one ancestor')}",
        f"    {_share(worlds, 'saturation', 'saturated')}",
    ]


def _causes(worlds: list[dict[str, Any]]) -> str:
    counts = sum((Counter(world["deaths_by_cause"]) for world in worlds), Counter[str]())
    return ", ".join(f"{count:,} {cause}" for cause, count in counts.items()) or "none"


def _share(worlds: list[dict[str, Any]], name: str, what: str) -> str:
    """How many worlds came to a moment, and after how many births; the others count as later."""
    births = [world[name]["births"] if world[name] else np.inf for world in worlds]
    came = f"{np.isfinite(births).sum():,} of {len(worlds):,} {what}"
    low, middle, high = np.percentile(births, [25, 50, 75], method="lower")
    if not np.isfinite(low):
        return came
    half, most = (f"{b:,.0f}" if np.isfinite(b) else "later" for b in (middle, high))
    return f"{came}, births until then: median {half} (quartiles {low:,.0f}, {most})"
