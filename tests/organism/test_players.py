"""Players from several worlds of a run: their keys, genomes and climates."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.history import pedigree
from primordia.organism.playing import players
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.settings.islands import Islands


def pairs(keys: Any) -> list[tuple[int, int]]:
    """Return the two words of each key."""
    return list(zip(keys.hi.tolist(), keys.lo.tolist(), strict=True))


def key_of(seed: int, purpose: Purpose, number: int) -> tuple[int, int]:
    """Return the key of one organism of the world with a seed."""
    key = stream(wide(np.array([seed], np.uint64)), purpose, wide(np.array([number])))
    return pairs(key)[0]


def test_founders_of_a_garden_have_keys_and_genomes_of_their_worlds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three founders are of world 2 (seed 33), and two are of world 0 (seed 11)."""

    def genomes(run: Any, world: int, count: int) -> np.ndarray:
        return np.array([[100 * world + k] for k in range(count)], np.float32)

    class Past:
        def __init__(self, run: Any) -> None: ...

        def of_cells(self, worlds: np.ndarray, _: Any, ticks: np.ndarray) -> dict[str, np.ndarray]:
            return {"world": worlds, "tick": ticks}

    monkeypatch.setattr(players, "founders", genomes)
    monkeypatch.setattr(players, "PastClimate", Past)
    monkeypatch.setattr(players, "as_players", lambda *given: given)
    seeds, ends = np.array([11, 22, 33], np.uint64), np.array([500, 600, 700])
    islands = Islands(("sea", "lagoon"), (0, 4, 12))
    run: Any = SimpleNamespace(
        world_seeds=seeds, ends=ends, config=SimpleNamespace(cells=12, islands=islands)
    )
    world, number, found = players.founders_of(run, np.array([2, 0]), np.array([3, 2]))
    given: Any = found
    _, rows, keys, climate, cells = given
    assert cells.tolist() == [0, 4, 8, 0, 6]
    assert world.tolist() == [2, 2, 2, 0, 0]
    assert number.tolist() == [0, 1, 2, 0, 1]
    assert np.ravel(rows).tolist() == [200, 201, 202, 0, 1]
    assert climate["world"].tolist() == [2, 2, 2, 0, 0]
    assert climate["tick"].tolist() == [700, 700, 700, 500, 500]
    numbers = [(33, 0), (33, 1), (33, 2), (11, 0), (11, 1)]
    assert pairs(keys) == [key_of(seed, Purpose.CONTROL, number) for seed, number in numbers]
    *_, given = players.founders_of(run, np.array([2, 0]), np.array([3, 2]), "lagoon")
    assert given[-1].tolist() == [4, 6, 9, 4, 8]


def test_organisms_play_with_keys_and_the_last_climate_of_their_worlds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Players are in the order of the request."""

    class Past:
        def __init__(self, run: Any) -> None: ...

        def of_lives(self, lives: Any, ticks: np.ndarray) -> dict[str, Any]:
            return {"lives": lives.tolist(), "ticks": ticks.tolist()}

    class Table(np.ndarray):
        world = np.array([2, 0, 2])
        id = np.array([6, 7, 5])
        cell = np.array([50, 60, 70])

    def taken(rows: np.ndarray) -> Any:
        return rows.view(Table)

    monkeypatch.setattr(pedigree, "genomes", lambda run, rows: rows.tolist())
    monkeypatch.setattr(players, "PastClimate", Past)
    monkeypatch.setattr(players, "as_players", lambda *given: given[1:])
    lives = SimpleNamespace(take=taken)
    seeds, ends = np.array([11, 22, 33], np.uint64), np.array([500, 600, 700])
    run: Any = SimpleNamespace(lives=lives, world_seeds=seeds, ends=ends)
    genomes, keys, climate, cells = tuple[Any, ...](players.players_of(run, np.array([30, 4, 29])))
    assert cells.tolist() == [50, 60, 70]
    assert genomes == [30, 4, 29]
    numbers = [(33, 6), (11, 7), (33, 5)]
    assert pairs(keys) == [key_of(seed, Purpose.EVALUATION, number) for seed, number in numbers]
    assert climate == {"lives": [30, 4, 29], "ticks": [700, 500, 700]}
