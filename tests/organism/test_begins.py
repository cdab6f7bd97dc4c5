"""Where lives begin that are lived again, and the players of a run's worlds, all of different ages."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.law.metabolism import ONE
from primordia.law.world import BirthCause, Cause
from primordia.organism import players
from primordia.organism.reliving import relived
from primordia.organism.reliving.course import Course
from primordia.organism.reliving.relived import RelivedLife
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.lives import ALIVE, Lives


def life_of(row: int, stored: Any = None, **run: Any) -> RelivedLife:
    """Return a life of two: organism 5 of world 1, which lives, and organism 6, which has starved."""
    record = Lives(
        world=np.array([1, 1]),
        id=np.array([5, 6]),
        parent=np.array([-1, 5]),
        cell=np.array([2, 3]),
        birth_cause=np.array([BirthCause.FOUNDER, BirthCause.COPY]),
        born=np.array([40, 45]),
        seen=np.array([40, 45]),
        inherited=np.array([False, False]),
        ended=np.array([90, 72]),
        cause=np.array([ALIVE, Cause.STARVED]),
    ).take(np.array([row]))
    none: Any = None
    return RelivedLife(SimpleNamespace(**run), none, none, none, none, record, stored)


@pytest.mark.parametrize(("row", "cause", "ends"), [(0, None, 90), (1, Cause.STARVED, 72)])
def test_a_life_begins_at_its_birth_or_at_the_tick_of_its_own_world(
    row: int, cause: Any, ends: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(relived, "world_ticks", lambda arrays: arrays["ticks"])
    born = life_of(row)
    assert (born.begins, born.ends, born.cause) == ([40, 45][row], ends, cause)
    later = life_of(row, {"ticks": np.array([9, 60, 70])})
    assert (later.begins, later.ends, later.cause) == (60, ends, cause)
    assert (Course(born).tick, Course(later).tick) == ([40, 45][row], 60)


def test_the_row_of_a_death_is_that_of_the_organism_in_its_world() -> None:
    """Other worlds have an organism of this number; the row is in the second segment."""
    import pyarrow as pa

    def row(world: int, number: int, energy: float) -> dict[str, Any]:
        own = {"world": world, "id": number, "tick": 72, "cause": "starved", "energy": energy}
        return {**own, "food": 2 * energy, "score": int(9 * energy)}

    asked: list[Any] = []

    def segments(table: str, columns: tuple[str, ...]) -> Any:
        asked.append((table, columns))
        yield pa.Table.from_pylist([row(0, 6, 1.0), row(1, 5, 2.0)])
        yield pa.Table.from_pylist([row(2, 6, 3.0), row(1, 6, 4.5), row(1, 7, 6.0)])

    life = life_of(1, segments=segments, schema=SimpleNamespace(tallies=("score",)))
    assert life.death == row(1, 6, 4.5)
    assert life.at_death == (4.5 * ONE, 9 * ONE)
    names = ("world", "id", "tick", "cause", "energy", "food", "score")
    assert asked == [("deaths", names)]


def test_founders_of_a_garden_have_keys_and_genomes_of_their_worlds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three founders of the world with seed 33, and two of that with seed 11; each world its climate."""

    def genomes(run: Any, world: int, count: int) -> np.ndarray:
        return np.array([[100 * world + k] for k in range(count)], np.float32)

    class Past:
        def __init__(self, run: Any) -> None: ...

        def of_worlds(self, worlds: np.ndarray, ticks: np.ndarray) -> dict[str, np.ndarray]:
            return {"world": worlds, "tick": ticks}

    monkeypatch.setattr(players, "founders", genomes)
    monkeypatch.setattr(players, "PastClimate", Past)
    monkeypatch.setattr(players, "_players", lambda *given: given)
    seeds, ends = np.array([11, 22, 33], np.uint64), np.array([500, 600, 700])
    run: Any = SimpleNamespace(world_seeds=seeds, ends=ends)
    world, found = players.founders_of(run, np.array([2, 0]), np.array([3, 2]))
    given: Any = found
    _, rows, keys, climate = given
    assert world.tolist() == [2, 2, 2, 0, 0]
    assert np.ravel(rows).tolist() == [200, 201, 202, 0, 1]
    assert climate["world"].tolist() == [2, 2, 2, 0, 0]
    assert climate["tick"].tolist() == [700, 700, 700, 500, 500]
    for k, (seed, number) in enumerate([(33, 0), (33, 1), (33, 2), (11, 0), (11, 1)]):
        one = wide(np.array([seed], np.uint64)), wide(np.array([number]))
        key = stream(one[0], Purpose.CONTROL, one[1])
        assert (int(keys.hi[k]), int(keys.lo[k])) == (int(key.hi[0]), int(key.lo[0]))


def test_organisms_play_under_the_climate_at_the_end_of_their_own_world(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Players come in the order in which they are asked for."""
    asked: dict[str, Any] = {}

    class Past:
        def __init__(self, run: Any) -> None: ...

        def of_lives(self, lives: Any, ticks: np.ndarray) -> dict[str, Any]:
            return {"lives": lives.tolist(), "ticks": ticks.tolist()}

    class Table(np.ndarray):
        world = np.array([2, 0, 2])
        id = np.array([6, 7, 5])

    def taken(rows: np.ndarray) -> Any:
        return rows.view(Table)

    def rebuild_all(run: Any, organisms: Any) -> list[Any]:
        asked["genomes"] = list(organisms)
        return asked["genomes"]

    monkeypatch.setattr(players, "rebuild_all", rebuild_all)
    monkeypatch.setattr(players, "PastClimate", Past)
    monkeypatch.setattr(players, "_players", lambda *given: given[1:])
    monkeypatch.setattr(players, "evaluation_keys", lambda run, *given: [x.tolist() for x in given])
    wanted = [(6, 2), (7, 0), (5, 2)]
    rows = {(6, 2): 30, (7, 0): 4, (5, 2): 29}
    lives = SimpleNamespace(row=lambda *each: rows[each], take=taken)
    run: Any = SimpleNamespace(lives=lives, ends=np.array([500, 600, 700]))
    genomes, keys, climate = tuple[Any, ...](players.players_of(run, wanted))
    assert genomes == wanted
    assert keys == [[2, 0, 2], [6, 7, 5]]
    assert climate == {"lives": [30, 4, 29], "ticks": [700, 500, 700]}


def test_games_of_organisms_have_keys_of_their_world_and_number() -> None:
    run: Any = SimpleNamespace(world_seeds=np.array([11, 22, 33], np.uint64))
    keys = players.evaluation_keys(run, np.array([2, 0, 2]), np.array([5, 5, 0]))
    for k, (seed, number) in enumerate([(33, 5), (11, 5), (33, 0)]):
        one = wide(np.array([seed], np.uint64)), wide(np.array([number]))
        key = stream(one[0], Purpose.EVALUATION, one[1])
        assert (int(keys.hi[k]), int(keys.lo[k])) == (int(key.hi[0]), int(key.lo[0]))
