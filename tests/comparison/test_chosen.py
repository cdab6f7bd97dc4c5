"""Who is chosen among invented lives and founders, and how their results are put together."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest

from primordia.comparison import controls
from primordia.comparison.controls import Group, Standing, evolved, unevolved
from tests.synthetic import worlds_of


class Seats(NamedTuple):
    """Stand-ins for players, by their rows, with their keys."""

    rows: np.ndarray
    keys: Any = None

    def take(self, rows: np.ndarray) -> "Seats":
        return Seats(self.rows[rows], None if self.keys is None else self.keys[rows])


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a stand-in for a fork of three worlds, of which the second has no birth since the fork.

    World 0 has two inherited organisms and 30 births, of which two live longest and two are alive;
    world 2 has one inherited organism, which is alive, and four births, of which one is alive.
    """
    first = [(0, 90, True), (1, 80, True), *[(k, 5, True) for k in range(2, 17)]]
    first += [(20, 30, True), (21, 30, True), *[(k, 4, True) for k in range(22, 33)]]
    first += [(40, 0, False), (45, 0, False)]
    third = [(0, 0, False), (2, 3, True), (3, 8, True), (4, 9, True), (48, 0, False)]
    lives = worlds_of(first, [(5, 2, True)], third, until=50)
    lives.inherited[[0, 1, 32, 33]] = True
    monkeypatch.setattr(controls, "players_of", lambda run, numbers: numbers)

    def founders_of(_: Any, worlds: np.ndarray, counts: np.ndarray) -> tuple[np.ndarray, Seats]:
        world = np.repeat(worlds, counts)
        return world, Seats(np.arange(len(world)))

    def lifespans(players: Seats, limit: int) -> np.ndarray:
        """The third of the founders, and each seventh after it, lives longest."""
        assert limit == 77
        return np.where(players.rows % 7 == 2, 60, players.rows % 5)

    monkeypatch.setattr(controls, "founders_of", founders_of)
    monkeypatch.setattr(controls, "lifespans", lifespans)
    monkeypatch.setattr(
        controls, "evaluation_keys", lambda run, world, number: 1000 * world + number
    )
    config = SimpleNamespace(saturation_ticks=77)
    return SimpleNamespace(lives=lives, config=config, path=Path("runs/a"))


def test_champions_and_the_living_are_those_of_worlds_with_births(run: Any) -> None:
    champion, alive = evolved(run)
    assert (champion.name, champion.chosen_from, alive.name, alive.chosen_from) == (
        "champion", 30, "all alive", 1,
    )  # fmt: skip
    assert champion.numbers == champion.players == [(18, 0), (3, 2)]
    assert alive.numbers == alive.players == [(30, 0), (31, 0), (0, 2), (4, 2)]
    champion, alive = evolved(run, 2)
    assert (champion.numbers, champion.chosen_from) == ([(3, 2)], 4)
    assert alive.numbers == [(0, 2), (4, 2)]
    run.lives.cause[:] = 0
    assert [group.name for group in evolved(run)] == ["champion"]


def chosen(run: Any, most: int | None) -> tuple[Any, Any]:
    """Return the best founders and some founders, whose players are `Seats`."""
    best, some = unevolved(run, most)
    return best, some


@pytest.mark.parametrize(
    ("most", "counts"), [(500, (30, 4)), (None, (30, 4)), (29, (29, 4)), (21, (21, 4)), (3, (3, 3))]
)
def test_founders_are_as_many_as_births_up_to_the_limit(
    run: Any, most: int | None, counts: tuple[int, int]
) -> None:
    """The best is the last of the longest-lived of its world; 20 founders of a world are typical."""
    best, some = chosen(run, most)
    first, third = counts
    last = [max(row for row in range(first) if row % 7 == 2)]
    rows = range(first, first + third)
    last += [max(rows, key=lambda row: (60 if row % 7 == 2 else row % 5, row))]
    assert best.numbers == [(last[0], 0), (last[1] - first, 2)]
    assert best.players.rows.tolist() == last
    assert best.players.keys.tolist() == [last[0], 2000 + last[1] - first]
    assert (best.name, best.chosen_from, some.name, some.chosen_from) == (
        "best founder", first, "founder", 1,
    )  # fmt: skip
    typical = [(k, 0) for k in range(min(20, first))] + [(k, 2) for k in range(third)]
    assert some.numbers == typical
    assert some.players.keys.tolist() == [1000 * world + number for number, world in typical]


def test_only_a_limit_that_is_given_is_a_limit(run: Any) -> None:
    """Without a limit there are as many founders as births, also where these are more than 500."""
    run.lives = worlds_of([(k, 1, True) for k in range(601)], until=700)
    best = {most: unevolved(run, most)[0] for most in (None, 500, 600)}
    assert {most: each.chosen_from for most, each in best.items()} == {
        None: 601,
        500: 500,
        600: 600,
    }
    assert unevolved(run)[0].chosen_from == 500


@pytest.mark.parametrize(("chosen_from", "games", "played"), [(1, 9, 1), (2, 9, 9), (1, 0, 0)])
def test_options_of_an_evaluation_are_used(
    chosen_from: int, games: int, played: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []

    def judged(*given: Any, **options: Any) -> list[Any]:
        asked.append((*given, options))
        return ["an evaluation"]

    monkeypatch.setattr(controls, "judged", judged)
    run: Any = SimpleNamespace(config="settings")
    group = Group(run, "some", chosen_from, [(3, 1)], "players")
    found = group.evaluate(games, 70, "ignored", {"angle_limit": 3.0})
    assert (found.name, found.chosen_from, found.evaluations) == (
        "some",
        chosen_from,
        ["an evaluation"],
    )
    options = {"games": played, "ticks": 70, "senses": "ignored", "habitat": {"angle_limit": 3.0}}
    assert asked == [("settings", "players", [(3, 1)], options)]
    group.evaluate()
    usual: dict[str, Any] = {
        "games": 30 if chosen_from > 1 else 1,
        "ticks": 100_000,
        "senses": "live",
        "habitat": {},
    }
    assert asked[1][-1] == usual


def results(*rows: tuple[int, float, float | None]) -> Standing:
    """Return the standing of organisms: world, median lifespan, and median score or none."""

    def told(lifespan: float, score: float | None) -> dict[str, Any]:
        spread = {"minimum": -1.0, "q1": 0.0, "median": lifespan, "q3": 1e6, "maximum": 1e7}
        return {"lifespan": spread} if score is None else {
            "lifespan": spread, "score": {**spread, "median": score},
        }  # fmt: skip

    return Standing("some", 40, [
        SimpleNamespace(world=world, games=6, to_dict=lambda of=of: told(*of))  # type: ignore[misc]
        for world, *of in rows
    ])  # fmt: skip


def test_results_of_worlds_are_medians_over_their_organisms() -> None:
    """World 4 has four organisms, world 0 three, and worlds 2, 7 and 9 one each."""
    lifespans = {4: [10, 1, 2, 40], 7: [9], 0: [5, 1, 100], 2: [70], 9: [8]}
    rows = [
        (world, float(value), 2.0 * value) for world, each in lifespans.items() for value in each
    ]
    found = results(*rows)
    medians = {0: 5, 2: 70, 4: 6, 7: 9, 9: 8}
    assert list(found.by_world("lifespan").items()) == list(medians.items())
    assert found.by_world("score") == {world: 2 * value for world, value in medians.items()}
    assert found.to_dict() == {
        "who": "some", "chosen_from": 40, "organisms": 10, "worlds": 5, "games": 6,
        "lifespan": {"median": 8, "q1": 6, "q3": 9}, "score": {"median": 16, "q1": 12, "q3": 18},
    }  # fmt: skip
    alone = results((3, 7.0, None)).to_dict()
    assert alone["lifespan"] == {"median": 7, "q1": 7, "q3": 7}
    assert not {"score", "length"} & alone.keys()
