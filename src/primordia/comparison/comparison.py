"""Runs side by side: how soon their worlds saturate, and how long organisms live in them.

Worlds are the units, taken to be independent. (Those of the same seed in two runs share random
words, which makes them alike if anything; intervals are then too wide rather than too narrow.) The
first run is the reference that each other is held against. Worlds that stopped unsaturated count for
what is known of them, and no more; see `contrast`. Where some are forks, lives are looked at from the
tick on at which the last of them was forked, in all runs; where few worlds saturate, which ends them,
up to the tick that all worlds have lived through.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from primordia.comparison.contrast import Bounds, Contrast, Figures, contrast
from primordia.comparison.gathering import Gathering, gathering
from primordia.comparison.pace import Pace, pace
from primordia.comparison.survival import Survival, survival
from primordia.config import Config
from primordia.errors import InputError
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import NEVER, read_count
from primordia.runs.lives import Lives

OUTCOMES = {
    "first": "births to first long life",
    "births": "births to saturation",
    "ticks": "ticks to saturation",
    "lifespan": "mean lifespan",
    "longest": "longest life",
    "pace": "ticks lived for each death, late",
    "food": "food a {span}, late",
}
UNSATURATED = ("longest", "pace")
"""Those that are of use only where saturation is rare."""


@dataclass(frozen=True)
class Arm:
    """A run, as far as it is compared."""

    name: str
    settings: dict[str, Any]
    """dotted name -> value, of those settings in which the runs differ"""
    figures: dict[str, Figures]
    """of each of OUTCOMES: which birth the first was that lived to the comparison's age; births and
    ticks to saturation, founders counted; mean lifespan in a world, in ticks, up to that age; ticks of
    the longest life, so far or in all; ticks lived for each death, and food that an organism gathered in
    a span, in the last quarter of the time that all worlds have lived through"""
    survival: Survival
    pace: Pace
    gathering: Gathering

    @property
    def worlds(self) -> int:
        """How many."""
        return len(self.figures["births"].value)

    @property
    def saturated(self) -> int:
        """How many worlds are known to be, within the horizons."""
        return int((self.figures["births"].known & self.figures["ticks"].known).sum())


@dataclass(frozen=True)
class Comparison:
    """Some runs of one task."""

    task: str
    arms: tuple[Arm, ...]
    """the first is the reference"""
    age: int
    """ticks of age up to which lives count"""
    births: int | None
    """horizon, or None: as far as each world went"""
    ticks: int | None
    """horizon, or None: as far as each world went"""
    span: str
    """of time in which food is counted: a second, or a tick where the habitat knows of no seconds"""

    @property
    def outcomes(self) -> dict[str, str]:
        """Those of OUTCOMES that tell something: known of some world, and of use."""
        untold = UNSATURATED if any(saturates(arm.figures) for arm in self.arms) else ()
        return {
            name: words.format(span=self.span)
            for name, words in OUTCOMES.items()
            if name not in untold and any(arm.figures[name].known.any() for arm in self.arms)
        }

    def contrast(self, arm: Arm, outcome: str) -> Contrast:
        """A run against the reference in one of OUTCOMES."""
        return contrast(arm.figures[outcome], self.arms[0].figures[outcome])

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; a bound that is not known is None."""
        whole = {"task": self.task, "age": self.age, "births": self.births, "ticks": self.ticks}
        return {**whole, "runs": [self._arm(arm) for arm in self.arms]}

    def _arm(self, arm: Arm) -> dict[str, Any]:
        found: dict[str, Any] = {
            "name": arm.name,
            "settings": arm.settings,
            "worlds": arm.worlds,
            "saturated": arm.saturated,
        }
        for outcome, figures in arm.figures.items():
            quartiles = [_plain(figures.quantile(q)) for q in (0.25, 0.5, 0.75)]
            found[outcome] = dict(zip(("q1", "median", "q3"), quartiles, strict=True))
            if arm is not self.arms[0]:
                against = self.contrast(arm, outcome)
                found[outcome]["against"] = {
                    "delta": against.delta,
                    "word": against.word,
                    "decided": against.decided,
                    "ratio": _plain(against.ratio),
                    "interval": _plain(against.interval),
                }
        return found


def compare(
    runs: Sequence[Archive], births: int | None = None, ticks: int | None = None
) -> Comparison:
    """Read runs and put them side by side.

    Args:
        runs: the first is the reference.
        births: horizon: only worlds that saturate before they have so many births count as saturated.
        ticks: the same in ticks.

    Raises:
        InputError: fewer than two runs, one given twice, different tasks, a run in which nothing has
            lived, or a world that stopped, unsaturated, before a horizon.
    """
    configs = _configs(runs)
    age = min(config.saturation_ticks for config in configs)
    names = [run.path.resolve().name for run in runs]
    everyone = [run.lives for run in runs]
    since, until = _common(runs, configs, everyone)
    everyone = [each.recorded_since(since) for each in everyone]
    moments = [_saturation(run, births, ticks) for run in runs]
    if not any(map(saturates, moments)):
        everyone = [each.recorded_until(until) for each in everyone]
    arms, rate = [], runs[0].habitat.rate
    each_run = zip(runs, everyone, moments, names, differing(configs), strict=True)
    for run, lived, saturation, name, own in each_run:
        worlds = _worlds(lived)
        survived, dying = survival(lived, len(worlds), age), pace(worlds, since, until)
        gathered = gathering(run, len(worlds), since, until, rate or 1)
        figures = {
            "first": first_long(worlds, age),
            **saturation,
            "lifespan": _all_known(survived.restricted_mean),
            "longest": _all_known([world.lifespan.max() for world in worlds]),
            "pace": dying.late,
            "food": gathered.late,
        }
        label = name if names.count(name) == 1 else str(run.path)
        arms.append(Arm(label, own, figures, survived, dying, gathered))
    span = "second" if rate else "tick"
    return Comparison(configs[0].task, tuple(arms), age, births, ticks, span)


def _common(
    runs: Sequence[Archive], configs: Sequence[Config], everyone: Sequence[Lives]
) -> tuple[int, int]:
    """The ticks between which all worlds of all runs are on record: since the last fork."""
    begun = [config.begins for config in configs]
    ended = [min(int(world.ended.max(initial=0)) for world in _worlds(each)) for each in everyone]
    if 0 < max(begun) >= min(ended):
        late, early = runs[begun.index(max(begun))], runs[ended.index(min(ended))]
        raise InputError(
            f"{late.path} was forked at tick {max(begun):,}, {early.path} ends at {min(ended):,}:"
            " they have no time in common"
        )
    return max(begun), min(ended)


def _all_known(values: ArrayLike) -> Figures:
    """A figure that every world has."""
    value = np.asarray(values, float)
    return Figures(value, np.ones(value.shape, bool))


def _worlds(lived: Lives) -> list[Lives]:
    """Of a run, one by one."""
    return [lived.of_world(world) for world in range(lived.worlds)]


def _configs(runs: Sequence[Archive]) -> list[Config]:
    """Settings of runs that can be compared."""
    if len(runs) < 2:
        raise InputError("compare needs two runs or more; the first is the reference of the others")
    if len({run.path.resolve() for run in runs}) < len(runs):
        raise InputError("a run is given twice; its worlds cannot be compared with themselves")
    first, *others = runs
    for run in others:
        if run.config.task != first.config.task:
            raise InputError(
                f"{first.path} is a run of {first.config.task}, {run.path} one of"
                f" {run.config.task}; only runs of one task can be compared"
            )
    return [run.config for run in runs]


def differing(configs: Sequence[Config]) -> list[dict[str, Any]]:
    """Of each configuration, the settings in which it is not as all the others."""
    untold: Any = {"about": True, "origin": {"run"}}  # words, and the name of a folder
    flat = [_flat(config.model_dump(mode="json", exclude=untold)) for config in configs]
    names = [name for each in flat for name in each]
    several = [
        name
        for name in dict.fromkeys(names)
        if any(each.get(name) != flat[0].get(name) for each in flat)
    ]
    return [{name: each.get(name) for name in several} for each in flat]


def first_long(worlds: Sequence[Lives], age: int) -> Figures:
    """Which birth of each world, since the fork if there was one, was the first to live so long.

    Known if all who were born before are dead; otherwise it is at least the first one's still alive.
    """
    value, known = [], []
    for lived in (world.take(np.flatnonzero(world.entered == 0)) for world in worlds):
        long = lived.lifespan >= age
        first, open_ = (
            int(each.argmax()) if each.any() else len(lived) for each in (long, ~long & ~lived.died)
        )
        value.append(min(first, open_) + 1)
        known.append(first < open_)
    return Figures(np.array(value, float), np.array(known))


def _saturation(run: Archive, births: int | None, ticks: int | None) -> dict[str, Figures]:
    """Births and ticks to saturation, of each world of a run."""

    def of_worlds(name: str) -> np.ndarray:
        return read_count(run.state, f"world.worlds.{name}")

    known = of_worlds("saturated") != NEVER
    now_and_then = {"births": ("births", "saturated_births"), "ticks": ("tick", "saturated")}
    found = {
        unit: Figures(np.where(known, of_worlds(then), of_worlds(now)).astype(float), known)
        for unit, (now, then) in now_and_then.items()
    }
    for unit, horizon in (("births", births), ("ticks", ticks)):
        if horizon is not None:
            try:
                found[unit] = found[unit].before(horizon)
            except InputError as error:
                raise InputError(f"--{unit} {horizon}: in {run.path}, {error}") from None
    return found


def saturates(figures: dict[str, Figures]) -> bool:
    """Whether at least half of a run's worlds do, within the horizons."""
    known = figures["births"].known & figures["ticks"].known
    return 2 * int(known.sum()) >= len(known)


def _flat(values: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested tables as one, with dotted names."""
    found: dict[str, Any] = {}
    for name, value in values.items():
        inner = isinstance(value, dict)
        found |= _flat(value, f"{prefix}{name}.") if inner else {prefix + name: value}
    return found


def _plain(bounds: Bounds) -> list[float | None]:
    """For JSON, which has no infinity."""
    return [each if np.isfinite(each) else None for each in bounds]
