"""The neutral shadow: lifespans of the same pedigree without selection.

A sample of organisms is born again, each alone and with fresh random keys that no run has used.
Their shadows are born with the same keys. A shadow has the pedigree of its original, and the same
births mutate, by the same sizes. But its founder and the noise of its mutations are drawn again. So it
has as many generations and mutations as its original, but no genome in its line was selected. If the
originals live longer than the shadows, the difference is due to selection (Bedau & Packard 1992).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from primordia.comparison.pairs import sign_test
from primordia.comparison.resample import LEAST, interval, resamples
from primordia.errors import InputError
from primordia.history import pedigree
from primordia.history.climate import PastClimate
from primordia.history.islands import born_on
from primordia.history.series import spaced
from primordia.organism.playing.games import Players, lifespans
from primordia.organism.playing.players import as_players
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.records import Records, on_its_device

ORGANISMS = 500
"""Default for the largest number of organisms of a world that are born again."""


@dataclass(frozen=True)
class Shadow:
    """The second lives of K organisms of W worlds, and those of their shadows."""

    name: str
    births: int
    """number of births on record, of which the organisms are a sample"""
    world: np.ndarray
    """world of each organism, int32 (K,), in ascending order"""
    original: np.ndarray
    """ticks that each organism lived when it was born again, int64 (K,)"""
    shadow: np.ndarray
    """ticks that the shadow of each organism lived, int64 (K,)"""
    cut: int
    """ticks after which lives were cut"""
    island: str | None = None
    """name of the island on which all the organisms were born"""

    @property
    def means(self) -> tuple[np.ndarray, np.ndarray]:
        """Mean life of originals and of shadows in each world, each float64 (W,)."""
        _, place, count = np.unique(self.world, return_inverse=True, return_counts=True)
        original, shadow = (np.bincount(place, each) for each in (self.original, self.shadow))
        return original / count, shadow / count

    @property
    def longer(self) -> tuple[int, int]:
        """Numbers of worlds in which originals live longer than shadows on average, and shorter."""
        original, shadow = self.means
        return int((original > shadow).sum()), int((original < shadow).sum())

    @property
    def p(self) -> float:
        """Probability of a split at least this uneven if selection has no effect (sign test)."""
        return sign_test(*self.longer)

    @property
    def ratio(self) -> float:
        """Median over worlds of the originals' mean life divided by the shadows' mean life."""
        return float(np.median(np.divide(*self.means)))

    @property
    def ratio_interval(self) -> tuple[float, float] | None:
        """The 95 % interval of `ratio` over resampled worlds; None if worlds are fewer than LEAST."""
        ratios = np.divide(*self.means)
        if len(ratios) < LEAST:
            return None
        medians = [np.median(ratios[rows], axis=1) for rows in resamples(len(ratios))]
        low, high = interval(np.concatenate(medians))
        return float(low), float(high)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        lines = {"original": self.original, "shadow": self.shadow}
        return {
            "name": self.name,
            **({} if self.island is None else {"island": self.island}),
            "worlds": len(self.means[0]),
            "births": self.births,
            "organisms": len(self.world),
            "cut": self.cut,
            "ticks": int(sum(each.sum() for each in lines.values())),
            **{
                line: {"mean": float(each.mean()), "reached_cut": int((each >= self.cut).sum())}
                for line, each in lines.items()
            },
            "worlds_longer": self.longer[0],
            "worlds_shorter": self.longer[1],
            "p": self.p,
            "ratio": self.ratio,
            "interval": self.ratio_interval,
        }


@on_its_device
def shadow(
    run: Records,
    organisms: int = ORGANISMS,
    ticks: int | None = None,
    island: str | None = None,
) -> Shadow:
    """Let organisms of a run and their shadows live again, in pairs.

    Args:
        run: the run, or an arm.
        organisms: largest number of organisms of each world, evenly spaced over all its births but
            the last.
        ticks: age at which lives are cut; by default the task's `saturation_ticks`.
        island: name of an island; only organisms that were born on it live again. Their ancestors may
            have lived on other islands.

    Raises:
        InputError: a number is below one, no world has two births since the fork (on the island), or
            there is no such island.
    """
    cut = run.config.saturation_ticks if ticks is None else ticks
    if organisms < 1 or cut < 1:
        raise InputError("shadow needs at least one organism and one tick")
    own = np.flatnonzero(~run.lives.inherited & born_on(run, island))
    rows = _sample(run.lives.world[own], own, organisms) if len(own) else own
    if not len(rows):
        where = "a world" if island is None else f"a world on the island {island}"
        raise InputError(
            f"{run.path}: shadow needs two births in {where}; in a fork, two births since the fork"
        )
    original, redrawn = (_lifespans(run, rows, each, cut) for each in (False, True))
    return Shadow(run.path.name, len(own), run.lives.world[rows], original, redrawn, cut, island)


def _sample(worlds: np.ndarray, rows: np.ndarray, most: int) -> np.ndarray:
    """Return at most `most` rows of each world, evenly spaced, without the last birth of a world.

    A saturated world stopped because its last-born lived long. So the last birth depends on the
    limit. Without the last birth, the births up to such a limit are an unbiased sample (Haldane 1945).
    """
    each = (rows[worlds == world][:-1] for world in np.unique(worlds))
    return np.concatenate([spaced(own, most) for own in each])


def _lifespans(run: Records, rows: np.ndarray, redrawn: bool, cut: int) -> np.ndarray:
    """Return the ticks that organisms or their shadows live, (K,)."""
    return lifespans(reborn(run, rows, redrawn), cut)


def reborn(run: Records, rows: np.ndarray, redrawn: bool) -> Players:
    """Return organisms, or their shadows if `redrawn`, as players, each with its own fresh key."""
    genomes = pedigree.genomes(run, rows, redrawn)  # first, since it prepares JAX
    lives = run.lives.take(rows)
    climate = PastClimate(run).of_lives(lives, lives.born)
    keys = stream(wide(run.world_seeds[lives.world]), Purpose.REBIRTH, wide(lives.id))
    return as_players(run, genomes, keys, climate, lives.cell)
