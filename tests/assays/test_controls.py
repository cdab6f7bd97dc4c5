"""Evaluation with controls: who is chosen among how many, and by which games they are judged."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest

import primordia
from primordia.assays import controls
from primordia.assays.controls import Group, Standing, evolved, unevolved
from primordia.brains import genomes
from primordia.errors import InputError
from primordia.history.founders import founders
from primordia.organism.playing.games import lifespans, play
from primordia.organism.playing.players import founders_of
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.synthetic import worlds_of

LONG = 50
"""Ticks up to which founders live when the best is chosen."""


def test_no_game_that_chose_an_organism_judges_it(poles: primordia.Run) -> None:
    run = poles.opened()
    run.config = run.config.model_copy(update={"saturation_ticks": LONG})
    best, _ = unevolved(run, 30)
    world, _, everyone = founders_of(run, np.arange(2), np.full(2, 30))
    numbers = np.array([number for number, _ in best.numbers])
    chosen_ones = everyone.take(np.searchsorted(world, np.arange(2)) + numbers)
    np.testing.assert_array_equal(chosen_ones.genomes, best.players.genomes)
    choosing = play(chosen_ones, 1, LONG)
    judging = best.evaluate(games=5, ticks=LONG).evaluations
    for chosen, each in zip(choosing.course[:, 0], judging, strict=True):
        assert chosen not in each.lived.course


def test_founders_of_given_genomes_take_these(poles: primordia.Run, tmp_path: Path) -> None:
    file, run = str(tmp_path / "two.safetensors"), Archive(poles.path / "0")
    poles.export(file, 0, 3)
    run.config = run.config.model_copy(update={"ancestors": (file,)})
    given = genomes.read([file], run.layout)
    made = founders(run, 0, 4)
    assert {each.tobytes() for each in made} == {each.tobytes() for each in given}


def test_the_command_prints_what_python_gives(
    poles: primordia.Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(controls, "lifespans", lambda players, _: lifespans(players, LONG))
    words = ["evaluate", poles.path, "--founders", 10, "--games", 2, "--ticks", 60]
    told = [each.to_dict() for each in poles.standings(10, games=2, ticks=60)]
    done = here(*words, "--json")
    assert json.loads(done.stdout) == {"rows": told}
    assert [each["games"] for each in told] == [2, 1, 2, 1]
    complains(here(*words[:2], "--founders", 0), 2, "--founders")
    with pytest.raises(InputError, match="at least one founder"):
        poles.standings(0, games=1, ticks=60)
    complains(here(*words[:2], "--world", 2), 2, "there is no world 2")


class Seats(NamedTuple):
    """A stand-in for players: their rows, and their keys."""

    rows: np.ndarray
    keys: Any = None

    def take(self, rows: slice | np.ndarray) -> "Seats":
        return Seats(self.rows[rows], None if self.keys is None else self.keys[rows])


@pytest.fixture
def invented(monkeypatch: pytest.MonkeyPatch) -> Any:
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
    monkeypatch.setattr(controls, "players_of", lambda run, rows: Seats(rows))

    def founders_of(
        _: Any, worlds: np.ndarray, counts: np.ndarray, island: str | None = None
    ) -> tuple:
        world = np.repeat(worlds, counts)
        number = np.concatenate([np.arange(count) for count in counts])
        return world, number, Seats(np.arange(len(world)))

    def lifespans(players: Seats, limit: int) -> np.ndarray:
        """Return lives of which those of founders 2, 9, 16 and so on are the longest."""
        assert limit == 77
        return np.where(players.rows % 7 == 2, 60, players.rows % 5)

    monkeypatch.setattr(controls, "founders_of", founders_of)
    monkeypatch.setattr(controls, "lifespans", lifespans)
    monkeypatch.setattr(
        controls, "evaluation_keys", lambda run, world, number: 1000 * world + number
    )
    config = SimpleNamespace(saturation_ticks=77)
    return SimpleNamespace(lives=lives, config=config, path=Path("runs/a"))


def test_champions_and_the_living_are_those_of_worlds_with_births(invented: Any) -> None:
    groups: Any = evolved(invented)
    champion, alive = groups
    assert (champion.name, champion.chosen_from, alive.name, alive.chosen_from) == (
        "champion", 30, "all alive", 1,
    )  # fmt: skip
    assert champion.numbers == [(18, 0), (3, 2)]
    assert alive.numbers == [(30, 0), (31, 0), (0, 2), (4, 2)]
    for group in (champion, alive):
        rows = group.players.rows
        own = zip(invented.lives.id[rows], invented.lives.world[rows], strict=True)
        assert list(own) == group.numbers
    champion, alive = evolved(invented, 2)
    assert (champion.numbers, champion.chosen_from) == ([(3, 2)], 4)
    assert alive.numbers == [(0, 2), (4, 2)]
    best, some = unevolved(invented, 3, 2)
    assert (best.chosen_from, {world for _, world in best.numbers + some.numbers}) == (3, {2})
    invented.lives.cause[:] = 0
    assert [group.name for group in evolved(invented)] == ["champion"]


@pytest.mark.parametrize(("most", "counts"), [(None, (30, 4)), (21, (21, 4)), (3, (3, 3))])
def test_the_number_of_founders_is_that_of_births_up_to_the_limit(
    invented: Any, most: int | None, counts: tuple[int, int]
) -> None:
    """The best is the last of the longest-lived of its world. Up to 20 of a world are typical."""
    groups: Any = unevolved(invented, most)
    best, some = groups
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


def test_a_fork_has_no_champion_before_a_birth(invented: Any) -> None:
    invented.lives.inherited[:] = True
    with pytest.raises(InputError, match="nothing has been born since the fork"):
        evolved(invented)


def test_the_number_of_candidates_is_the_largest_of_all_worlds(invented: Any) -> None:
    """The world with the most births is neither the first nor the last. The usual limit is 500."""
    invented.lives = worlds_of(*([(k, 1, True) for k in range(n)] for n in (4, 601, 6)), until=700)
    assert evolved(invented)[0].chosen_from == 601
    found = [unevolved(invented, most)[0].chosen_from for most in (None, 600, 5, 3)]
    assert found == [601, 600, 5, 3]
    assert unevolved(invented)[0].chosen_from == 500


@pytest.mark.parametrize(("chosen_from", "games", "played"), [(1, 9, 1), (2, 9, 9), (1, 0, 0)])
def test_an_evaluation_has_the_given_options_or_the_usual_ones(
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
    options = {
        "games": played, "ticks": 70, "senses": "ignored", "habitat": {"angle_limit": 3.0},
        "there": None,
    }  # fmt: skip
    assert asked == [("settings", "players", [(3, 1)], options)]
    group.evaluate()
    usual: dict[str, Any] = {
        "games": 30 if chosen_from > 1 else 1,
        "ticks": 100_000,
        "senses": "live",
        "habitat": {},
    }
    assert asked[1][-1] == {**usual, "there": None}


def results(*rows: tuple[int, float, float | None]) -> Standing:
    """Return the standing of organisms: world, median lifespan, and median score or none."""

    def plain(lifespan: float, score: float | None) -> dict[str, Any]:
        spread = {"minimum": -1.0, "q1": 0.0, "median": lifespan, "q3": 1e6, "maximum": 1e7}
        return {"lifespan": spread} if score is None else {
            "lifespan": spread, "score": {**spread, "median": score},
        }  # fmt: skip

    return Standing("some", 40, [
        SimpleNamespace(world=world, games=6, to_dict=lambda of=of: plain(*of))  # type: ignore[misc]
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
    none = results((3, 7.0, 0.0), (5, 0.0, 0.0))
    assert none.by_world("score") == {3: 0, 5: 0}
    assert none.to_dict()["score"] == {"median": 0, "q1": 0, "q3": 0}, "0 is a result"
