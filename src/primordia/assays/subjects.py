"""The subjects of assays: organisms of a run, genomes of a file, or founders of a task."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np

from primordia import config, device
from primordia.brains import genomes
from primordia.compiled import shared
from primordia.config import Config
from primordia.errors import InputError
from primordia.history.climate import PastClimate
from primordia.law.genesis import initial_climate
from primordia.law.law import Law
from primordia.law.metabolism import Rates
from primordia.mutations.contract import PURPOSES, Draws
from primordia.organism.playing.evaluation import changed
from primordia.organism.playing.games import Players, lifespans
from primordia.organism.playing.players import players_of
from primordia.random.keys import Purpose, stream, streams
from primordia.random.wide import wide
from primordia.runs.records import Records
from primordia.settings.tables import tasks
from primordia.settings.values import shown

GAMES = 5
"""Default number of games of each genome; one game if the habitat draws nothing at random."""
TICKS = 20_000
"""Default length at which games are cut, in ticks."""
FOUNDERS, BEST = 512, 16
"""Numbers of a task's founders: those that live once, and the longest-lived, which become subjects."""


class Subjects(NamedTuple):
    """K organisms that an assay lets live again, all in one habitat."""

    source: str
    """the run, the genome file or the task"""
    config: Config
    """settings of the run, or of the task; the habitat may be changed"""
    players: Players
    organism: np.ndarray
    """birth numbers, or numbers in the file or among the founders, int64 (K,)"""
    world: np.ndarray
    """worlds of the organisms, int64 (K,); 0 outside a run"""
    notes: np.ndarray
    """the mutation's notes, int32 (K, n)"""
    climate: Mapping[str, np.ndarray]
    """present values of the settings that seasons change, each float32 (K,)"""

    @property
    def law(self) -> Law:
        """The law by which the subjects live."""
        return self.players.law

    @property
    def names(self) -> list[str]:
        """The subjects' names in tables."""
        pairs = zip(self.organism.tolist(), self.world.tolist(), strict=True)
        return [f"{organism} of world {world}" for organism, world in pairs]

    def games(self, wanted: int) -> int:
        """Return the number of games to play: one if all games would be the same."""
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
        InputError: no such organism was born, one is given twice, or nothing was born; or the
            habitat has no such setting.
    """
    if len(set(organisms)) < len(organisms):
        raise InputError(f"{run.path}: an organism is given twice")
    lives = run.lives
    rows = np.array([lives.row(*each) for each in organisms]) if organisms else lives.champions()
    if not len(rows):
        raise InputError(f"{run.path}: nothing has been born since the fork")
    chosen = lives.take(rows)
    where = changed(run.config, habitat or {})
    return Subjects(
        source=str(run.path),
        config=where,
        players=players_of(run, rows)._replace(habitat=where.build_habitat()),
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
        numbers: numbers of the genomes in the file, counted from 0; by default all.
        task: the task in which they live; by default the task of Primordia that the file names.
        habitat: as in `of_run`.

    Raises:
        InputError: the file cannot be read, names no task or has no such genome; or its genomes do
            not fit the task's brain.
    """
    named = task or _task_of(file)
    device.prepare()
    chosen = changed(config.load(named), habitat or {})
    everyone = genomes.read([str(file)], chosen.build_layout(chosen.build_habitat()))
    for number in numbers:
        _check_number(file, number, len(everyone))
    which = np.array(numbers or range(len(everyone)), np.int64)
    return _fresh(str(file), chosen, which, everyone[which], key=which)


def _task_of(file: Path) -> str:
    """Return the task that a genome file names.

    Raises:
        InputError: the file names no task of Primordia. Any other task could be a stranger's code.
    """
    named = genomes.about(file).get("task")
    if named is None:
        raise InputError(
            f"{file} does not say which task its genomes live in; name the task: --task"
        )
    if named not in tasks():
        raise InputError(
            f"{file} names {shown(named)}, which is no task of Primordia; name the task: --task"
        )
    return named


def of_task(
    task: str, numbers: Sequence[int] = (), habitat: Mapping[str, Any] | None = None
) -> Subjects:
    """Return founders of a task, before any evolution: by default the longest-lived of many.

    Each of the many lives once, so that the longest-lived can be chosen. The subjects' own games
    have other keys.

    Args:
        task: name of a task, or a TOML file.
        numbers: which founders to take, from 0 to FOUNDERS - 1; by default the longest-lived; see BEST.
        habitat: as in `of_run`.

    Raises:
        InputError: there is no such task or founder, or a setting is wrong.
    """
    device.prepare()
    chosen = changed(config.load(task), habitat or {})
    for number in numbers:
        _check_number(task, number, FOUNDERS)
    made = founders(chosen, FOUNDERS)
    which = np.array(numbers) if numbers else _longest_lived(chosen, made)
    # No founder is judged by the game in which it was chosen, so these keys differ from those.
    return _fresh(task, chosen, which, made[which], key=FOUNDERS + which)


def _longest_lived(chosen: Config, made: np.ndarray) -> np.ndarray:
    """Return the numbers of the BEST longest-lived in one game of each founder (FOUNDERS, P)."""
    everyone = np.arange(FOUNDERS)
    lived = lifespans(_fresh("", chosen, everyone, made, key=everyone).players, TICKS)
    return np.argsort(-lived, kind="stable")[:BEST]


def founders(chosen: Config, count: int) -> np.ndarray:
    """Return genomes of founders, drawn by the task's mutation class, float32 (count, P)."""
    heredity = chosen.build_heredity(chosen.build_layout(chosen.build_habitat()))
    seed = stream(wide(np.full(count, chosen.seed)), Purpose.CONTROL, wide([0]))
    draws = Draws(
        streams(seed, wide([0]), *PURPOSES), jax.device_put(np.arange(count, dtype=np.int32))
    )
    mutation, layout = heredity.mutation, heredity.layout
    return np.asarray(shared(type(mutation).founders, mutation, layout)(draws))


def _fresh(
    source: str, chosen: Config, number: np.ndarray, own: np.ndarray, *, key: np.ndarray
) -> Subjects:
    """Return subjects that come from no run: `own` are genomes (K, P), `number` is (K,).

    Subjects with different numbers `key` (K,) play games with different random keys.
    """
    habitat, count = chosen.build_habitat(), len(number)
    law = chosen.build_law(habitat)
    everywhere = {name: np.asarray(each) for name, each in initial_climate(law, count).items()}
    island = law.islands.of_cells(number % law.cells)
    climate = law.islands.here(everywhere, island, np.where)
    keys = stream(wide(np.full(count, chosen.seed)), Purpose.EVALUATION, wide(key))
    rates = Rates.of(jax.device_put(climate))
    players = Players(law, habitat, own, keys, rates, island)
    notes = np.asarray(law.heredity.mutation.founders_notes(count))
    return Subjects(source, chosen, players, number, np.zeros_like(number), notes, climate)


def _check_number(source: str | Path, number: int, count: int) -> None:
    if not 0 <= number < count:
        raise InputError(f"{source} has no genome {number}; the genomes are 0 to {count - 1}")
