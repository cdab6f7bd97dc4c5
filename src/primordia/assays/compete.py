"""Two genomes in one empty world: whose descendants take over?

Each genome begins in half of the cells, and children are exact copies. So only survival and
replication decide.
"""

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from primordia.assays.subjects import Subjects
from primordia.brains import genomes
from primordia.comparison.pairs import sign_test
from primordia.config import Config, checked, parsed
from primordia.errors import InputError
from primordia.history.ancestry import nearest
from primordia.history.series import mean_of_known, plain, population
from primordia.law.world import BirthCause
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from primordia.settings.islands import KEY

WORLDS = 10
"""Default number of worlds."""
TICKS = 5_000
"""Default number of ticks of each world."""
MOMENTS = 101
"""Number of ticks at which shares are counted, including the first and the last tick."""


@dataclass(frozen=True)
class Competition:
    """The descendants of two genomes in W worlds."""

    one: str
    other: str
    tick: np.ndarray
    """int64 (T,)"""
    share: np.ndarray
    """share of the living that descend from the first genome, after each tick, float64 (W, T); NaN
    if nothing lives"""

    @property
    def late_share(self) -> np.ndarray:
        """Mean of `share` over the later half of the ticks, float64 (W,); NaN if nothing lives then."""
        return mean_of_known(self.share[:, self.share.shape[1] // 2 :], axis=1)

    @property
    def won(self) -> tuple[int, int]:
        """Numbers of worlds that the first and second genome won: `late_share` above and below 0.5."""
        late = self.late_share
        return int((late > 0.5).sum()), int((late < 0.5).sum())

    @property
    def p(self) -> float:
        """Probability of a split at least this uneven if both genomes are equally good (sign test)."""
        return sign_test(*self.won)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "one": self.one,
            "other": self.other,
            "worlds": len(self.share),
            "late_share": plain(self.late_share),
            "won": list(self.won),
            "p": self.p,
            "tick": self.tick.tolist(),
            "share": plain(self.share),
        }


def compete(
    one: Subjects, other: Subjects, worlds: int = WORLDS, ticks: int = TICKS
) -> Competition:
    """Let two genomes compete in empty worlds.

    Founders take the two genomes in turn and fill all cells. If all organisms die, founders fill
    the cells again. There is no mutation and no recombination. All other settings are those of the
    first genome, `one`.

    Args:
        one: a single organism or genome, and the law.
        other: a single organism or genome of the same brain.
        worlds: number of worlds; the seeds count up from the seed in the first genome's settings.
        ticks: ticks of each world.

    Raises:
        InputError: there are several genomes on a side, or the brains differ.
    """
    for side in (one, other):
        if len(side.organism) != 1:
            raise InputError(
                f"{side.source}: name one organism to compete, not {len(side.organism)}"
            )
    layout = one.law.heredity.layout
    if layout != other.law.heredity.layout:
        raise InputError(
            f"{one.source} and {other.source} have different brains, so they cannot share a world"
        )
    with TemporaryDirectory() as folder:
        file = Path(folder, "both.safetensors")
        both = np.concatenate([one.players.genomes, other.players.genomes])
        genomes.write(file, layout, both, {})
        run = Path(folder, "run")
        loop.start(_settings(one.config, file, worlds, ticks), run)
        archive = Archive(run)
        lives, seeds = archive.lives, archive.world_seeds
    tick = np.linspace(0, ticks, MOMENTS).astype(np.int64)
    shares = [_shares(lives.of_world(w), seed, tick) for w, seed in enumerate(seeds)]
    first, second = (f"{Path(side.source).name}: {side.names[0]}" for side in (one, other))
    return Competition(first, second, tick, np.stack(shares))


def _settings(config: Config, file: Path, worlds: int, ticks: int) -> Config:
    """Return the settings of worlds with these two ancestors and without mutation."""
    habitat, seasons = dict(config.habitat), config.seasons
    if islands := habitat.get(KEY):
        habitat[KEY] = [{**island, "mutation": {}} for island in islands]
    changes: dict[str, Any] = {
        "habitat": config.on_copies(habitat),
        "ancestors": (str(file),),
        "genesis": "fill",
        "inheritance": "parent",
        "mutation": {"kind": "gaussian", "probability": 0.0},
        "recombination": None,
        "seasons": [s.model_dump() for s in seasons if not _of_mutation(config, s.setting)],
        "seeds": worlds,
        "stop": {"ticks": ticks},
        "fork": None,
    }
    values = config.model_dump(exclude=set(changes)) | changes
    return checked(parsed(values, source="compete"), source="compete")


def _of_mutation(config: Config, setting: str) -> bool:
    """Return whether a season's setting is one of the mutation, of the world or of an island."""
    return config.islands.split(setting)[1].startswith("mutation.")


def _shares(lives: Lives, seed: np.uint64, tick: np.ndarray) -> np.ndarray:
    """Return the share of one world's living that descend from the first genome, float64 (T,)."""
    first = _of_first(lives, seed)
    sides = (lives.take(np.flatnonzero(side)) for side in (first, ~first))
    alive = np.stack([population(side, tick) for side in sides])
    total = alive.sum(axis=0)
    return np.where(total > 0, alive[0] / np.maximum(total, 1), np.nan)


def _of_first(lives: Lives, seed: np.uint64) -> np.ndarray:
    """Return which organisms descend from founders with the first genome, bool (L,).

    Founders take the genomes in turn by seed and birth number; see `law.heredity`.
    """
    founders = np.flatnonzero(lives.birth_cause == BirthCause.FOUNDER)
    founder = nearest(lives.parent_row, founders)
    return (lives.id[founder].astype(np.uint64) + seed) % np.uint64(2) == 0
