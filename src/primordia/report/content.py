"""The content of a page about a run or an experiment, as JSON values."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from primordia.experiments.campaign import Campaign
from primordia.history.info import info
from primordia.history.summary import seeds_text
from primordia.printable import counted
from primordia.progress import steps
from primordia.report import islands
from primordia.report.arms import arms, names
from primordia.report.curves import panels
from primordia.report.facts import facts
from primordia.report.film import film
from primordia.report.ground import Ground, palette
from primordia.report.lives import films
from primordia.report.organisms import organisms
from primordia.report.traits import with_traits
from primordia.report.tree import tree
from primordia.report.words import setting, words
from primordia.runs.records import Records

WORLDS = 6
"""Largest number of worlds whose pictures are in a page."""


def of_run(run: Records, filmed: bool = True) -> dict[str, Any]:
    """Return the content of the page of a run, or of several runs as one arm.

    Args:
        run: the run.
        filmed: whether to repeat some lives and film them.

    Raises:
        InputError: nothing has lived in the run yet.
        Trouble: the run is damaged.
    """
    assert len(run.lives)
    numbers = info(run)
    worlds = range(min(run.lives.worlds, WORLDS))
    seeds = run.world_seeds.tolist()
    left_out = run.lives.worlds - len(worlds)
    return {
        "palette": palette(),
        "arms": None,
        "title": run.config.task,
        "subtitle": f"{_name(run.path)}, {seeds_text(seeds)}",
        "words": words(run, numbers),
        "numbers": _numbers(numbers["worlds"]),
        "panels": [*panels(run), *islands.panels(run)],
        "worlds": [
            view(run, world, f"seed {seeds[world]}", len(worlds))
            for world in steps(worlds, "drawing")
        ],
        "left_out": f"{counted(left_out, 'further world')} not shown" if left_out else "",
        "films": films(run) if filmed else None,
        **_islands(run),
        "facts": [{"name": "", **facts(run, numbers)}],
    }


def of_experiment(chosen: Campaign) -> dict[str, Any]:
    """Return the content of the page of an experiment: its arms side by side, and a world of each arm.

    Raises:
        InputError: an arm has not begun, or the arms cannot be compared.
        Trouble: a run is damaged.
    """
    runs = chosen.opened()
    named = dict(zip(names(runs), runs, strict=True))
    numbers = {name: info(run) for name, run in named.items()}
    jobs = ", ".join(f"{jobs:,} {state}" for state, jobs in chosen.status().jobs.items() if jobs)
    shown = list(named.items())[:WORLDS]
    worlds = sum(len(each["worlds"]) for each in numbers.values())
    return {
        "palette": palette(),
        "title": chosen.plan.question or runs[0].config.task,
        "subtitle": f"{_name(chosen.path)}, {runs[0].config.task}, jobs: {jobs}",
        "words": [
            f"The experiment has {counted(len(runs), 'arm')}: {', '.join(named)}. The arms differ in"
            f" the settings below. All arms together have {counted(worlds, 'world')}.",
            setting(runs[0].config),
        ],
        "numbers": _numbers([world for each in numbers.values() for world in each["worlds"]]),
        "arms": arms(runs),
        "panels": [],
        "worlds": [
            view(run, 0, f"{name}, seed {run.world_seeds[0]}", len(shown)) for name, run in shown
        ],
        "left_out": "The first world of each arm is shown",
        "films": None,
        "facts": [{"name": name, **facts(run, numbers[name])} for name, run in named.items()],
    }


def view(run: Records, world: int, name: str, share: int) -> dict[str, Any]:
    """Return the pictures of one world of a run: space-time, organisms, film, phylogeny."""
    several = run.config.islands if run.config.islands.count > 1 else None
    ground = Ground(run.lives.of_world(world), run.config.cells, share, several)
    living = tree(ground)
    return {
        "name": name,
        "topology": run.config.placement.topology,
        "rate": run.description.rate,
        "ground": ground.data(),
        "organisms": organisms(ground.lives, ground.rows),
        "film": film(ground, run.config),
        "tree": living and with_traits(living, run, world),
        **({} if several is None else {"islands": islands.places(several)}),
    }


def _islands(run: Records) -> dict[str, Any]:
    """Return the section on islands, if there are any."""
    found = islands.overview(run)
    return {} if found is None else {"islands": found}


def _name(path: Path) -> str:
    return path.resolve().name


def _numbers(worlds: Sequence[dict[str, Any]]) -> list[dict[str, str]]:
    """Return the main numbers of some worlds, with their names."""
    total = {name: sum(world[name] for world in worlds) for name in ("births", "deaths", "alive")}
    several = len(worlds) > 1
    shown = {
        "worlds" if several else "times extinct": len(worlds)
        if several
        else worlds[0]["extinctions"],
        "ticks": max(world["ticks"] for world in worlds),
        "organisms born": total["births"],
        "died": total["deaths"],
        "alive": total["alive"],
        "age of the oldest alive": max(world["oldest_age"] or 0 for world in worlds),
    }
    return [{"name": name, "value": f"{value:,}"} for name, value in shown.items()]
