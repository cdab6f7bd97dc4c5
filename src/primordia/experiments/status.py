"""The status of an experiment: states of jobs and counts of arms, read without opening a run."""

from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import numpy as np

from primordia.comparison.resample import LEAST
from primordia.experiments.ledger import Entry, WorldCounts
from primordia.experiments.plan import Plan

SIGMAS = 1.96
"""Standard deviations from the mean within which 95 % of a normal distribution lies."""
STATES = ("done", "running", "failed", "waiting")


@dataclass(frozen=True)
class ArmStatus:
    """The state of an arm, over the worlds that have begun so far."""

    name: str
    worlds: int
    """number of worlds that the arm will have"""
    begun: int
    saturated: int
    life: float | None
    """ticks lived for each death, median over the worlds that have begun; None if none has begun"""
    life_interval: tuple[float, float] | None
    """95 % interval of the median over worlds; None for fewer than 5 worlds"""


@dataclass(frozen=True)
class CampaignStatus:
    """An experiment so far."""

    question: str
    jobs: dict[str, int]
    """state -> number of jobs"""
    arms: tuple[ArmStatus, ...]
    running: tuple[Entry, ...]
    failed: tuple[Entry, ...]

    @property
    def rate(self) -> float:
        """Organism-ticks a second of all jobs under way."""
        return sum(entry.rate or 0.0 for entry in self.running)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "question": self.question,
            "jobs": self.jobs,
            "arms": [vars(arm) for arm in self.arms],
            "running": [entry.model_dump() for entry in self.running],
            "failed": [entry.model_dump(include={"job", "arm", "error"}) for entry in self.failed],
        }


def status(plan: Plan, entries: list[Entry], names: Collection[str]) -> CampaignStatus:
    """Return the status of the arms with these names, from the entries of their jobs."""
    states = Counter(entry.state for entry in entries)
    arms = [arm for arm in plan.arms if arm.name in names]
    worlds: dict[str, list[WorldCounts]] = {arm.name: [] for arm in arms}
    for entry in entries:
        worlds[entry.arm] += entry.worlds
    return CampaignStatus(
        question=plan.question,
        jobs={state: states[state] for state in STATES},  # type: ignore[index]
        arms=tuple(_arm(arm.name, int(arm.settings["seeds"]), worlds[arm.name]) for arm in arms),
        running=tuple(entry for entry in entries if entry.state == "running"),
        failed=tuple(entry for entry in entries if entry.state == "failed"),
    )


def _arm(name: str, count: int, worlds: list[WorldCounts]) -> ArmStatus:
    lives = np.array([world.organism_ticks / max(world.deaths, 1) for world in worlds])
    saturated = sum(world.saturated is not None for world in worlds)
    median = float(np.median(lives)) if len(lives) else None
    return ArmStatus(name, count, len(worlds), saturated, median, _interval(lives))


def _interval(lives: np.ndarray) -> tuple[float, float] | None:
    """Return the interval of the median by ranks: the normal approximation of Conover (1999, 3.2)."""
    if len(lives) < LEAST:
        return None
    outside = max(int(len(lives) / 2 - SIGMAS / 2 * np.sqrt(len(lives))), 0)
    ordered = np.sort(lives)
    return float(ordered[outside]), float(ordered[len(lives) - 1 - outside])
