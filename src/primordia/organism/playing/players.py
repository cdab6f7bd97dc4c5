"""Players of a run: recorded organisms and fresh founders, in the habitat of their task."""

from collections.abc import Mapping

import jax
import numpy as np

from primordia.history import pedigree
from primordia.history.climate import PastClimate
from primordia.history.founders import founders
from primordia.history.islands import number_of
from primordia.law.metabolism import Rates
from primordia.organism.playing.games import Players
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide
from primordia.runs.records import Records


def players_of(run: Records, rows: np.ndarray) -> Players:
    """Return organisms, by their rows in the run's lives, int (K,), as players."""
    genomes, lives = pedigree.genomes(run, rows), run.lives.take(rows)  # first: it prepares JAX
    climate = PastClimate(run).of_lives(lives, run.ends[lives.world])
    keys = evaluation_keys(run, lives.world, lives.id)
    return as_players(run, genomes, keys, climate, lives.cell)


def founders_of(
    run: Records, worlds: np.ndarray, counts: np.ndarray, island: str | None = None
) -> tuple[np.ndarray, np.ndarray, Players]:
    """Return alternative founders of worlds, each with a different key, spread evenly over all cells.

    Args:
        run: the run, or an arm.
        worlds: some worlds, int (V,).
        counts: number of founders of each world, int (V,).
        island: name of the island on whose cells they are; by default they are on all cells.

    Returns:
        the world of each founder, its number in the world, from 0, int (K,) each; and the players.

    Raises:
        InputError: there is no such island.
    """
    world, number = np.repeat(worlds, counts), np.concatenate([np.arange(n) for n in counts])
    genomes = [founders(run, *each) for each in zip(worlds.tolist(), counts.tolist(), strict=True)]
    here, islands = range(run.config.cells), run.config.islands
    if island is not None:
        here = islands.cells[number_of(islands, island)]
    cell = here.start + number * len(here) // np.repeat(counts, counts)
    climate = PastClimate(run).of_cells(world, cell, run.ends[world])
    keys = stream(wide(run.world_seeds[world]), Purpose.CONTROL, wide(number))
    return world, number, as_players(run, np.concatenate(genomes), keys, climate, cell)


def moved(run: Records, players: Players, worlds: np.ndarray, island: int) -> Players:
    """Return the players on an island, with the settings that it has at the end of the records.

    Args:
        run: the run, or an arm.
        players: K organisms.
        worlds: the world of each, int (K,).
        island: number of the island.
    """
    cells = np.full(len(worlds), run.config.islands.bounds[island])
    climate = PastClimate(run).of_cells(worlds, cells, run.ends[worlds])
    rates = Rates.of(jax.device_put(climate))
    return players._replace(rates=rates, island=np.full(len(worlds), island))


def evaluation_keys(run: Records, world: np.ndarray, number: np.ndarray) -> Wide:
    """Return the keys for evaluating organisms, by world and birth number, (K,)."""
    return stream(wide(run.world_seeds[world]), Purpose.EVALUATION, wide(number))


def as_players(
    run: Records,
    genomes: np.ndarray,
    keys: Wide,
    climate: Mapping[str, np.ndarray],
    cells: np.ndarray,
) -> Players:
    """Return K players with these genomes, float32 (K, P), and keys, in their cells' climate (K,)."""
    rates, island = Rates.of(jax.device_put(climate)), run.config.islands.of_cells(cells)
    return Players(run.law, run.config.build_habitat(), genomes, keys, rates, island)
