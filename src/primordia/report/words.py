"""A summary of a run in words, for readers who do not know Primordia."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from primordia.config import Config
from primordia.figures.survival import quarters
from primordia.live.panel import duration
from primordia.printable import counted, often
from primordia.runs.lives import Lives
from primordia.runs.records import Records

WORLDS = {
    "ring": "cells on a ring",
    "torus4": "cells on a torus, a plane whose opposite edges meet",
    "torus8": "cells on a torus, a plane whose opposite edges meet",
    "well-mixed": "cells, all of which are neighbours",
}
DEATHS = {
    "fatal": "killed by their world",
    "starved": "of hunger",
    "hazard": "by accident",
    "replaced": "because a child took their cell",
    "fault": "of a fault in their body or brain",
    "time-limit": "at the time limit of the task",
    "restart": "when the run was resumed without their bodies",
}

FEWEST = 10
"""The medians of the first and the last quarter are left out if either has fewer lives than this."""


def words(run: Records, info: dict[str, Any]) -> list[str]:
    """Return paragraphs about a run.

    Args:
        run: the run.
        info: the run in numbers, see `history.info.info`.
    """
    worlds = info["worlds"]
    happened = _one_world if len(worlds) == 1 else _many_worlds
    rate = run.description.rate
    return [setting(run.config), " ".join(happened(worlds, run, rate)), " ".join(_lives(run, rate))]


def setting(config: Config) -> str:
    """Return a paragraph on the organisms of a run and their rules."""
    about = f"{config.about.rstrip('.')}. " if config.about else ""
    worlds = "The world has" if config.seeds == 1 else f"Each of {config.seeds:,} worlds has"
    taken = ", whose organism dies" if config.placement.rule == "replacing" else ""
    room = "a neighbouring" if taken else "an empty neighbouring"
    parts = [
        f"{about}{worlds} {config.cells:,} {WORLDS[config.placement.topology]}. In each cell lives"
        " at most one organism: a small neural network with its own simulated body.",
        "Nobody chooses which organisms live or have children. An organism lives until its world kills"
        f" it. Meanwhile the organism copies itself into {room} cell{taken}.",
    ]
    if config.islands.count > 1:
        parts.append(
            f"The cells are divided into {config.islands.count} islands: {listed(config.islands.names)}."
            " Each of them has a habitat and rates of its own."
        )
    if config.inheritance == "parent":
        parts.append("Copies differ from their parent by small random changes.")
    else:
        parts.append(
            "Nothing is inherited in this run, a control: each child is a new random network."
        )
    if config.metabolism is not None:
        parts.append("An organism that gathers too little food starves.")
    return " ".join(parts)


def listed(names: Sequence[str]) -> str:
    """Return names as text, with "and" before the last."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def _one_world(worlds: list[dict[str, Any]], run: Records, rate: float | None) -> list[str]:
    (world,) = worlds
    config = run.config
    parts = [
        f"In {world['ticks']:,} ticks{simulated(world['ticks'], rate)},"
        f" {counted(world['births'], 'organism')} {'was' if world['births'] == 1 else 'were'} born,"
        f" and {_deaths(worlds)}.",
        *_extinct(world["extinctions"], config, "The world"),
    ]
    if fixed := world["fixation"]:
        parts.append(
            f"Since tick {fixed['tick']:,} ({fixed['births']:,} births until then) all living organisms"
            " descend from one child of a founder."
        )
    if saturated := world["saturation"]:
        parts.append(
            f"At tick {saturated['tick']:,} the world was saturated: all {config.cells:,} cells"
            f" were full, and no organism had died for {config.saturation_ticks:,} ticks."
        )
    elif world["alive"]:
        parts.append(
            f"{counted(world['alive'], 'organism')} live{'s' if world['alive'] == 1 else ''} now in"
            f" the {config.cells:,} cells. The world is not saturated: organisms still die, and"
            " others follow."
        )
    else:
        parts.append("Nothing lives in the world now.")
    return parts


def _many_worlds(worlds: list[dict[str, Any]], run: Records, rate: float | None) -> list[str]:
    def total(name: str) -> int:
        return sum(world[name] for world in worlds)

    longest = max(world["ticks"] for world in worlds)
    saturated = sum(world["saturation"] is not None for world in worlds)
    most = "All" if saturated == len(worlds) else f"{saturated:,} of {len(worlds):,}"
    are = "is" if saturated == 1 else "are"
    return [
        f"In up to {longest:,} ticks{simulated(longest, rate)} of each world,"
        f" {counted(total('births'), 'organism')} were born in all, and {_deaths(worlds)}.",
        *_extinct(total("extinctions"), run.config, "In all, the worlds"),
        f"{most} worlds {are} saturated: all cells full, and no death for"
        f" {run.config.saturation_ticks:,} ticks.",
    ]


def _deaths(worlds: Sequence[dict[str, Any]]) -> str:
    """Return the numbers of deaths by cause as text."""
    causes: dict[str, int] = {}
    for world in worlds:
        for cause, number in world["deaths_by_cause"].items():
            causes[cause] = causes.get(cause, 0) + number
    died = [(number, DEATHS[cause]) for cause, number in causes.items() if number]
    if not died:
        return "none has died"
    if len(died) == 1:
        return f"{died[0][0]:,} died, {died[0][1]}"
    listed = ", ".join(f"{number:,} {how}" for number, how in died)
    return f"{sum(number for number, _ in died):,} died: {listed}"


def _extinct(times: int, config: Config, what: str) -> list[str]:
    if not times:
        return []
    new = "a random founder" if config.genesis == "one" else "founders in all cells"
    new = new if not config.ancestors else "the given genomes"
    return [f"{what} died out {often(times)}, and life began again with {new}."]


def _lives(run: Records, rate: float | None) -> list[str]:
    """Return sentences that compare early and late lives, and name the longest life."""
    lives = run.lives
    parts = []
    # Of the organisms born before a fork only those that lived until then are on record.
    early, *_, late = quarters(lives.take(~lives.inherited))
    if min(len(early), len(late)) >= FEWEST:
        births = "births since the fork" if lives.inherited.any() else "births"
        parts.append(
            f"In the first quarter of the {births}, half of the organisms lived {_median(early)}; in the"
            f" last quarter, half lived {_median(late)} so far."
        )
    row = int(lives.lifespan.argmax())
    which = f"organism {lives.id[row]:,}"
    where = f" of world {lives.world[row]}" if lives.worlds > 1 else ""
    fate = "is dead" if lives.died[row] else "is alive"
    long = int(lives.lifespan[row])
    parts.append(
        f"The longest life is that of {which}{where}, born at tick {lives.born[row]:,}: {long:,}"
        f" ticks{simulated(long, rate)}. This organism {fate}."
    )
    return parts


def _median(lives: Lives) -> str:
    return f"{int(np.quantile(lives.lifespan, 0.5, method='lower')):,} ticks or more"


def simulated(ticks: int, rate: float | None) -> str:
    """Return the simulated time in brackets as text; "" if the habitat has no clock."""
    return f" ({duration(ticks / rate)} of simulated time)" if rate else ""
