"""The subjects of an assay: organisms of a run, or genomes of a file, that live again."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from primordia import config, device
from primordia.brains import genomes
from primordia.config import Config
from primordia.errors import InputError
from primordia.history.climate import PastClimate
from primordia.law.genesis import initial_climate
from primordia.law.law import Law
from primordia.law.metabolism import Rates
from primordia.organism.evaluation import changed
from primordia.organism.games import Players
from primordia.organism.players import players_of
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.records import Records

GAMES = 5
"""Games of each genome, if not told otherwise; one where nothing is drawn at random."""
TICKS = 20_000
"""Length at which games are cut, if not told otherwise."""


class Subjects(NamedTuple):
    """K organisms that an assay lets live again, all in one habitat."""

    source: str
    """the run, or the genome file"""
    config: Config
    """settings of the run, or of the task; the habitat may be changed"""
    players: Players
    organism: np.ndarray
    """birth number of each, or its number in the file, int64 (K,)"""
    world: np.ndarray
    """world of each, int64 (K,); 0 in a file"""
    notes: np.ndarray
    """the mutation's notes, int32 (K, n)"""
    climate: Mapping[str, np.ndarray]
    """present values of the settings that seasons change, float32 (K,) each"""

    @property
    def law(self) -> Law:
        """The law by which they live."""
        return self.players.law

    @property
    def names(self) -> list[str]:
        """What each is called in tables."""
        pairs = zip(self.organism.tolist(), self.world.tolist(), strict=True)
        return [f"{organism} of world {world}" for organism, world in pairs]

    def games(self, wanted: int) -> int:
        """Return the number of games that are worth playing: one where all would be the same."""
        return 1 if self.players.deterministic else wanted


def of_run(
    run: Records,
    organisms: Sequence[tuple[int, int]] = (),
    habitat: Mapping[str, Any] | None = None,
) -> Subjects:
    """Return organisms of a run.

    Args:
        run: the run, or an arm.
        organisms: birth number and world of each; by default the champion of each world.
        habitat: changed settings of the habitat, such as `{"sticky": 0.25, "noops": 30}`.

    Raises:
        InputError: no such organism was born, nothing was born, or the habitat has no such setting.
    """
    lives = run.lives
    rows = np.array([lives.row(*each) for each in organisms]) if organisms else lives.champions()
    if not len(rows):
        raise InputError(f"{run.path}: nothing has been born since the fork")
    chosen = lives.take(rows)
    numbers = list(zip(chosen.id.tolist(), chosen.world.tolist(), strict=True))
    where = changed(run.config, habitat or {})
    return Subjects(
        source=str(run.path),
        config=where,
        players=players_of(run, numbers)._replace(habitat=where.build_habitat()),
        organism=chosen.id,
        world=chosen.world.astype(np.int64),
        notes=run.notes_of(chosen),
        climate=PastClimate(run).of_lives(chosen, run.ends[chosen.world]),
    )


def of_file(
    file: Path,
    numbers: Sequence[int] = (),
    task: str | None = None,
    habitat: Mapping[str, Any] | None = None,
) -> Subjects:
    """Return genomes of a file.

    Args:
        file: a genome file, such as `primordia export` writes.
        numbers: those in the file, counted from 0; by default all.
        task: in which they live; by default the one that the file names.
        habitat: as in `of_run`.

    Raises:
        InputError: the file cannot be read, names no task or has no such genome; or the task's brain is
            another one.
    """
    named = task or genomes.about(file).get("task")
    if named is None:
        raise InputError(f"{file} does not say which task its genomes live in; name it: --task")
    device.prepare()
    chosen = changed(config.load(named), habitat or {})
    own = chosen.build_habitat()
    law = chosen.build_law(own)
    everyone = genomes.read([str(file)], law.heredity.layout)
    for number in numbers:
        if not 0 <= number < len(everyone):
            raise InputError(
                f"{file} has no genome {number}; they count from 0 to {len(everyone) - 1}"
            )
    which = np.array(numbers or range(len(everyone)), np.int64)
    climate = {name: np.asarray(each) for name, each in initial_climate(law, len(which)).items()}
    keys = stream(wide(np.full(len(which), chosen.seed)), Purpose.EVALUATION, wide(which))
    rates = Rates.of(jax.tree.map(jnp.asarray, climate))
    players = Players(law, own, everyone[which], keys, rates)
    notes = np.asarray(law.heredity.mutation.founders_notes(len(which)))
    return Subjects(str(file), chosen, players, which, np.zeros_like(which), notes, climate)
