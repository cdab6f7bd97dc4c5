"""Comparisons of runs: how soon worlds saturate, and how long organisms live.

The units are worlds. The worlds of one run are independent. If two runs have the same seeds, the
worlds of one seed are a pair; see `pairs`. The first run is the reference of all others. All
intervals of one outcome hold simultaneously; see `resample`. A world that stopped before it
saturated is treated as censored; see `measured`. If runs are forks, the births, ticks and lives of
all runs count from the tick of the latest fork. If few worlds saturate, lives count up to the last tick
that is on record in all worlds. With an island, the lives are those of the organisms born on it; what is
counted for whole worlds alone (saturation, food, extinctions) is then left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from primordia.comparison.contrast import Contrast, contrast
from primordia.comparison.differing import differing
from primordia.comparison.measured import Measured
from primordia.comparison.moments import first_long, often_saturated, saturation
from primordia.comparison.pace import Gathering, Pace, gathering, pace
from primordia.comparison.pairs import same_seeds
from primordia.comparison.survival import Survival, survival
from primordia.config import Config
from primordia.errors import InputError
from primordia.history.extinctions import Extinctions, extinctions
from primordia.history.islands import born_on
from primordia.history.series import plain
from primordia.runs.lives import Lives
from primordia.runs.records import Records

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
"""Outcomes that are compared only if saturation is rare."""
OF_WORLDS = ("births", "ticks", "food")
"""Outcomes that are known for whole worlds, not for an island."""


@dataclass(frozen=True)
class ComparedArm:
    """One run of a comparison."""

    name: str
    settings: dict[str, Any]
    """the settings in which the runs differ: dotted name -> value"""
    seeds: np.ndarray
    """the seed of each world, uint64 (W,)"""
    measured: dict[str, Measured]
    """name in OUTCOMES -> the outcome in each world.

    `first`: birth number of the first organism that reached the comparison's age. `births`,
    `ticks`: births (founders included) and ticks to saturation. `lifespan`: mean lifespan up to
    that age, in ticks. `longest`: ticks of the longest life so far. `pace`: ticks lived for each
    death. `food`: mean food of an organism in a `span` of time. `pace` and `food` are those of the
    last quarter of the time that is on record in all worlds.
    """
    survival: Survival
    pace: Pace
    gathering: Gathering
    extinctions: Extinctions
    """the extinctions in the compared time"""

    @property
    def worlds(self) -> int:
        """Number of worlds."""
        return len(self.measured["births"].value)

    @property
    def saturated(self) -> int:
        """Number of worlds known to saturate within the horizons."""
        return int((self.measured["births"].known & self.measured["ticks"].known).sum())


@dataclass(frozen=True)
class Comparison:
    """Runs of one task side by side."""

    task: str
    arms: tuple[ComparedArm, ...]
    """the first is the reference"""
    age: int
    """age, in ticks, up to which lives count"""
    begin: int
    """tick after which births, ticks and lives count: the tick of the latest fork, or 0"""
    births: int | None
    """horizon in births; None: no horizon"""
    ticks: int | None
    """horizon in ticks; None: no horizon"""
    span: str
    """unit of time for food: `second`, or `tick` if the habitat has no rate"""
    island: str | None = None
    """name of the island to whose natives the comparison is restricted"""

    @property
    def contrasts(self) -> int:
        """Number of runs that are compared with the reference; their intervals hold simultaneously."""
        return max(len(self.arms) - 1, 1)

    @property
    def outcomes(self) -> dict[str, str]:
        """Name -> title of each outcome that applies and is known in some world."""
        saturating = any(often_saturated(arm.measured) for arm in self.arms)
        useless: tuple[str, ...] = UNSATURATED if saturating else ()
        if self.island is not None:
            useless = OF_WORLDS
        return {
            name: title.format(span=self.span)
            for name, title in OUTCOMES.items()
            if name not in useless and any(arm.measured[name].known.any() for arm in self.arms)
        }

    def contrast(self, arm: ComparedArm, outcome: str) -> Contrast:
        """Return the contrast of a run with the reference in one of OUTCOMES."""
        reference = self.arms[0]
        pairs = same_seeds(arm.seeds, reference.seeds)
        return contrast(arm.measured[outcome], reference.measured[outcome], pairs, self.contrasts)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON; an unknown bound is None."""
        names = "task", "age", "begin", "births", "ticks"
        whole = {name: getattr(self, name) for name in names}
        if self.island is not None:
            whole["island"] = self.island
        return {**whole, "runs": [self._arm(arm) for arm in self.arms]}

    def _arm(self, arm: ComparedArm) -> dict[str, Any]:
        values: dict[str, Any] = {
            "name": arm.name,
            "settings": arm.settings,
            "worlds": arm.worlds,
        }
        if self.island is None:
            values["saturated"] = arm.saturated
            values["extinctions"] = int(arm.extinctions.total.sum())
            values["crashes"] = int(arm.extinctions.crashes.sum())
        for outcome, measured in arm.measured.items():
            if self.island is not None and outcome in OF_WORLDS:
                continue
            quartiles = [plain(measured.quantile(q)) for q in (0.25, 0.5, 0.75)]
            values[outcome] = dict(zip(("q1", "median", "q3"), quartiles, strict=True))
            if arm is not self.arms[0]:
                values[outcome]["against"] = self.contrast(arm, outcome).to_dict()
        return values


def compare(
    runs: Sequence[Records],
    births: int | None = None,
    ticks: int | None = None,
    island: str | None = None,
) -> Comparison:
    """Compare runs, read from their records.

    Args:
        runs: the first is the reference of the others, if there are any.
        births: horizon: a world counts as saturated only if it saturates before this number of
            births, counted from the latest fork.
        ticks: the same horizon in ticks.
        island: name of an island; only organisms that were born on it count.

    Raises:
        InputError: one run is given twice, the tasks differ, nothing has lived in a run, or a world
            stopped before a horizon and before it saturated; or a run has no such island, nothing was
            born on it in a world, or a horizon is given with it.
    """
    configs = _configs(runs)
    if island is not None and (births, ticks) != (None, None):
        raise InputError(
            "--island: --births and --ticks are horizons of saturation, which is that of whole worlds;"
            " leave them out"
        )
    age = min(config.saturation_ticks for config in configs)
    begin, end = _common_ticks(runs, configs)
    lives = [run.lives.recorded_since(begin) for run in runs]
    saturated = [
        saturation(run, lived, begin, births, ticks) for run, lived in zip(runs, lives, strict=True)
    ]
    if not any(map(often_saturated, saturated)):
        lives = [each.recorded_until(end) for each in lives]
    if island is not None:
        lives = [_natives(run, begin, end, island) for run in runs]
    arms = tuple(
        _arm(*each, age, begin, end)
        for each in zip(_names(runs), differing(configs), runs, lives, saturated, strict=True)
    )
    span = "second" if runs[0].description.rate else "tick"
    return Comparison(configs[0].task, arms, age, begin, births, ticks, span, island)


def _arm(
    name: str,
    settings: dict[str, Any],
    run: Records,
    lived: Lives,
    saturated: dict[str, Measured],
    age: int,
    begin: int,
    end: int,
) -> ComparedArm:
    """Return the measurements of a run, of which `settings` differ from those of other runs.

    The lives that count, `lived`, do so up to an age. The common time is from tick `begin` to `end`.
    """
    worlds = lived.by_world()
    survived, dying = survival(lived, len(worlds), age), pace(worlds, begin, end)
    gathered = gathering(run, len(worlds), begin, end, run.description.rate or 1)
    measured = {
        "first": first_long(worlds, age),
        **saturated,
        "lifespan": _known_everywhere(survived.restricted_mean),
        "longest": _known_everywhere([world.lifespan.max() for world in worlds]),
        "pace": dying.late,
        "food": gathered.late,
    }
    lost = extinctions(worlds, run.config.cells)
    return ComparedArm(name, settings, run.world_seeds, measured, survived, dying, gathered, lost)


def _natives(run: Records, begin: int, end: int, island: str) -> Lives:
    """Return the lives of an island's natives that are on record between two ticks.

    Raises:
        InputError: there is no such island, or nothing lived on it in some world.
    """
    lives = run.lives.take(np.flatnonzero(born_on(run, island)))
    lives = lives.recorded_since(begin).recorded_until(end)
    if len(empty := np.setdiff1d(np.arange(run.config.seeds), lives.world)):
        raise InputError(
            f"--island {island}: nothing has lived there in world {empty[0]} of {run.path} up to tick"
            f" {end:,}, so worlds cannot be compared; genesis `fill` gives founders to every island"
        )
    return lives


def _common_ticks(runs: Sequence[Records], configs: Sequence[Config]) -> tuple[int, int]:
    """Return the first and last tick between which all worlds of all runs are on record."""
    begun = [config.begins for config in configs]
    ended = [min(int(world.ended.max(initial=0)) for world in run.lives.by_world()) for run in runs]
    if 0 < max(begun) >= min(ended):
        late, early = runs[begun.index(max(begun))], runs[ended.index(min(ended))]
        raise InputError(
            f"{late.path} was forked at tick {max(begun):,}, {early.path} ends at {min(ended):,}:"
            " they have no ticks in common"
        )
    return max(begun), min(ended)


def _names(runs: Sequence[Records]) -> list[str]:
    """Return the names of the runs' directories, or the whole path if two have the same name."""
    names = [run.path.resolve().name for run in runs]
    return [
        name if names.count(name) == 1 else str(run.path)
        for run, name in zip(runs, names, strict=True)
    ]


def _known_everywhere(values: ArrayLike) -> Measured:
    """Return values that are known in every world."""
    value = np.asarray(values, float)
    return Measured(value, np.ones(value.shape, bool))


def _configs(runs: Sequence[Records]) -> list[Config]:
    """Return the settings of runs; raise InputError if the runs cannot be compared."""
    named = [str(run.path) for run in runs]
    paths = [path.resolve() for run in runs for path in run.paths]
    if len(set(paths)) < len(paths):
        twice = next(path for path in paths if paths.count(path) > 1)
        raise InputError(f"{twice} is given twice; worlds cannot be compared with themselves")
    if len(set(named)) < len(named):
        raise InputError(f"two runs are named {max(named, key=named.count)}; name them differently")
    first, *others = runs
    for run in others:
        if run.config.task != first.config.task:
            raise InputError(
                f"{first.path} is a run of {first.config.task}, {run.path} one of"
                f" {run.config.task}; only runs of one task can be compared"
            )
    return [run.config for run in runs]
