"""Games of an evaluation: which are played, under which rules, and how distinct games are counted."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.habitats.contract import Continuous, Discrete
from primordia.organism.playing import evaluation
from primordia.organism.playing.evaluation import Evaluation, Spread, changed, judged
from primordia.organism.playing.games import Games, Players, _marks, lifespans_in_games, play
from primordia.organism.playing.seats import Stretch
from primordia.random.wide import wide
from primordia.settings.base import Settings
from tests.toys import Meadow
from tests.worlds import MEADOW, config

NUMBERS = [(9, 1), (4, 0)]


@dataclass(frozen=True)
class Rules:
    """The parts of a law that an evaluation reads."""

    motor: Any
    metabolism: str | None = "hunger"
    senses: int = 3
    heredity: ClassVar[Any] = SimpleNamespace(layout=SimpleNamespace(genes=0))


def played(ticks: list[list[int]], course: list[list[int]] | None = None) -> Games:
    """Return games of some players: all are cut, and no food is eaten."""
    length = np.array(ticks)
    courses = np.array(course or ticks, np.uint64)
    return Games(length, np.zeros(length.shape, bool), 0.0 * length, courses, [length[:, 0]] * 2)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Replace `play`, and return the inputs of each call. Each player has games of other lengths."""
    noted: list[dict[str, Any]] = []

    def play(players: Players, games: int, ticks: int, **given: Any) -> Games:
        habitat, law = players.habitat, players.law
        noted.append({"habitat": habitat, "law": law, "games": games, "ticks": ticks, **given})
        return played([[10, 11], [20, 21]])

    monkeypatch.setattr(evaluation, "play", play)
    return noted


def evaluated(
    monkeypatch: pytest.MonkeyPatch, game: Any, words: int = 4, motor: str = "direct", **given: Any
) -> list[Evaluation]:
    """Evaluate two players in a changed habitat, whose original task is `game`."""
    habitat: Any = SimpleNamespace(name="changed", words=words, original=lambda: game)
    after = SimpleNamespace(build_habitat=lambda: habitat)
    monkeypatch.setattr(evaluation, "changed", lambda config, changes: after)
    habitat_before: Any = SimpleNamespace(name="unchanged")
    law: Any = Rules(SimpleNamespace(kind=motor))
    rates: Any = None
    keys = wide(np.arange(2))
    own = Players(law, habitat_before, np.zeros((2, 5), np.float32), keys, rates)
    asked: dict[str, Any] = {"games": 7, "ticks": 100, "senses": "live", "habitat": {}, **given}
    return judged(config(), own, NUMBERS, **asked)


@pytest.mark.parametrize(
    ("episode", "ticks", "cut"),
    [(None, 100, 100), (30, 100, 30), (300, 100, 100), (None, 10**6, 10**6), (2000, 10**6, 2000)],
)
def test_whole_games_have_no_metabolism_and_are_cut_at_the_habitats_episode_too(
    monkeypatch: pytest.MonkeyPatch,
    calls: list[dict[str, Any]],
    episode: int | None,
    ticks: int,
    cut: int,
) -> None:
    found = evaluated(monkeypatch, SimpleNamespace(name="game", episode=episode), ticks=ticks)
    assert [call["habitat"].name for call in calls] == ["changed", "game"]
    assert [call["law"].metabolism for call in calls] == ["hunger", None]
    assert [call["ticks"] for call in calls] == [ticks, cut]
    assert [call["games"] for call in calls] == [7, 7]
    assert [(each.organism, each.world) for each in found] == NUMBERS
    keys = "organism world games distinct senses lifespan alive_when_cut score length cut"
    assert list(found[0].to_dict()) == keys.split()
    for each, lengths in zip(found, ([10, 11], [20, 21]), strict=True):
        assert each.whole is not None
        assert each.lived.ticks.tolist() == each.whole.ticks.tolist() == lengths


@pytest.mark.parametrize(
    ("words", "motor", "games"),
    [(0, "direct", 1), (4, "direct", 7), (0, "gaussian", 7), (4, "gaussian", 7)],
)
def test_one_game_is_enough_only_if_neither_body_nor_motor_is_random(
    monkeypatch: pytest.MonkeyPatch,
    calls: list[dict[str, Any]],
    words: int,
    motor: str,
    games: int,
) -> None:
    found = evaluated(monkeypatch, None, words, motor)
    assert [call["games"] for call in calls] == [games]
    assert [each.deterministic for each in found] == [games == 1] * 2
    assert [each.whole for each in found] == [None, None]


def test_frozen_senses_are_all_senses_and_no_memory(
    monkeypatch: pytest.MonkeyPatch, calls: list[dict[str, Any]]
) -> None:
    game = SimpleNamespace(name="game", episode=None)
    evaluated(monkeypatch, game)
    assert [(call["frozen"], call["script"]) for call in calls] == [(None, None)] * 2
    calls.clear()
    evaluated(monkeypatch, game, senses="frozen")
    for call in calls:
        assert call["frozen"].senses.tolist() == [[True] * 3] * 2
        assert call["frozen"].memory.tolist() == [[False]] * 2
        assert call["script"] is None


def test_ignored_senses_repeat_one_game_in_the_habitat_of_the_task(
    monkeypatch: pytest.MonkeyPatch, calls: list[dict[str, Any]]
) -> None:
    evaluated(monkeypatch, SimpleNamespace(name="game", episode=5), senses="ignored")
    assert [call["habitat"].name for call in calls] == ["unchanged", "changed", "game"]
    assert [call["games"] for call in calls] == [1, 7, 7]
    assert [call["ticks"] for call in calls] == [100, 100, 5]
    assert [call.get("frozen") for call in calls] == [None] * 3
    assert "script" not in calls[0]
    for call in calls[1:]:
        assert call["script"].ticks.tolist() == [[10, 11], [20, 21]]


@pytest.mark.parametrize(
    ("course", "fixed", "repeats"),
    [([3], True, True), ([3], False, False), ([3, 3], False, True), ([3, 4], False, False)],
)
def test_games_repeat_if_several_are_the_same_or_nothing_is_random(
    course: list[int], fixed: bool, repeats: bool
) -> None:
    games = played([[9] * len(course)], [course]).of_player(0)
    assert Evaluation(0, 0, "live", games, None, deterministic=fixed).repeats == repeats


def test_quartiles_lie_between_values_if_no_value_is_a_quartile() -> None:
    """Of four values, the lower quartile is three quarters of the way from the first to the second."""
    assert Spread.of(np.array([10, 2, 0, 1])) == (0, 0.75, 1.5, 4, 10)
    assert Spread.of(np.array([3])) == (3, 3, 3, 3, 3)


def test_a_script_begins_again_when_its_game_has_ended() -> None:
    """Each player repeats the actions of its own game."""
    games = played([[3], [2]])._replace(actions=[np.array([1, 2, 3]), np.array([8, 9])])
    assert [games.actions_at(tick).tolist() for tick in range(1, 8)] == [
        [1, 8], [2, 9], [3, 8], [1, 9], [2, 8], [3, 9], [1, 8],
    ]  # fmt: skip


def test_games_differ_in_course_if_senses_or_food_of_a_tick_differ() -> None:
    def marked(high: int, low: int, food: float | None) -> int:
        marks = np.uint32([[[high, low]]])
        given: Any = None
        eaten = None if food is None else np.full((1, 1), food, np.float32)
        return int(_marks(Stretch(given, given, eaten, marks, given))[0, 0])

    assert marked(3, 7, None) == marked(3, 7, 0.0) == 3 * 2**32 + 7
    different = (
        (3, 7, 0.0),
        (4, 7, 0.0),
        (3, 8, 0.0),
        (7, 3, 0.0),
        (3, 7, 1.0),
        (3, 7, 0.5),
        (3, 7, -1.0),
    )
    assert len({marked(*each) for each in different}) == len(different)


def test_settings_are_given_in_a_table_or_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """A table may have names that are arguments too, such as `senses`. A keyword outweighs the table."""
    asked: list[Any] = []
    monkeypatch.setattr(evaluation, "players_of", lambda run, rows: f"players {rows}")
    monkeypatch.setattr(evaluation, "judged", lambda *given, **named: asked.append((given, named)))
    lives = SimpleNamespace(row=lambda *each: {(9, 1): 6}[each])
    run: Any = SimpleNamespace(config="a config", lives=lives, made_on="cpu")
    table = {"senses": [49], "sticky": 0.25}
    evaluation.evaluate(run, [(9, 1)], games=3, senses="frozen", habitat=table, sticky=0.5, noops=0)
    evaluation.evaluate(run, [(9, 1)])
    plain = {"games": 30, "ticks": 100_000, "senses": "live", "habitat": {}, "there": None}
    wanted = {"senses": [49], "sticky": 0.5, "noops": 0}
    players = ("a config", "players [6]", [(9, 1)])
    assert asked == [
        (players, {**plain, "games": 3, "senses": "frozen", "habitat": wanted}),
        (players, plain),
    ]
    assert evaluation.evaluate(run, []) == []
    assert len(asked) == 2


class Walls(Settings):
    height: int = 1
    length: int = 5


class Walled(Meadow):
    """A habitat with a group of settings."""

    walls: Walls = Walls()
    speed: float | None = 2.0


def test_a_setting_in_a_group_is_changed_by_the_name_of_the_group() -> None:
    before = config(MEADOW, habitat={"name": f"{__name__}:Walled", "walls": {"length": 7}})
    after: Any = changed(before, {"walls": {"height": 0}, "speed": "none"}).build_habitat()
    assert (after.walls, after.speed) == (Walls(height=0, length=7), None)
    with pytest.raises(InputError, match="habitat has no setting 'height'"):
        changed(before, {"speed": 1.0, "height": 0})


def test_what_an_island_sets_for_itself_is_changed_too() -> None:
    islands = [{"name": "a"}, {"name": "b", "habitat": {"lifespan": 5}}]
    before = config(MEADOW, habitat={"name": "tests.toys:Meadow", "islands": islands})
    after = changed(before, {"lifespan": 9})
    assert [each.build_habitat().lifespan for each in after.by_island] == [9, 9]
    assert before.habitat["islands"][1] == islands[1]


@pytest.mark.parametrize(("games", "ticks"), [(0, 9), (9, 0)])
def test_no_game_and_no_tick_are_refused(games: int, ticks: int) -> None:
    players: Any = SimpleNamespace(genomes=np.zeros((1, 1)))
    for played in (play, lifespans_in_games):
        with pytest.raises(InputError, match="at least one game of at least one tick"):
            played(players, games, ticks)


def test_senses_of_an_unknown_kind_are_refused() -> None:
    asked: Any = {"games": 1, "ticks": 1, "senses": "freeze", "habitat": {}}
    players: Any = None
    with pytest.raises(InputError, match="'freeze' is not one of live, frozen, ignored"):
        judged(config(MEADOW), players, [], **asked)


def test_a_habitat_without_declared_settings_may_have_any() -> None:
    """This habitat is no model of settings; its options are those of the habitat inside."""
    before = config(MEADOW, habitat={"name": "tests.toys:Mirror", "inner": "meadow"})
    after: Any = changed(before, {"lifespan": 9}).build_habitat()
    assert after.inner.lifespan == 9


@pytest.mark.parametrize(
    ("changes", "has"),
    [
        ({"lifespan": 9, "senses_size": 1}, r"\(lifespan, senses_size\) .* 1 senses and 2 actions"),
        ({"senses_size": 3}, r"\(senses_size\) give the habitat 3 senses and 2 actions"),
        ({"action": Discrete(3)}, r"\(action\) give the habitat 2 senses and 3 actions"),
        ({"action": Continuous(2)}, r"\(action\) give the habitat 2 senses and 2 actions"),
    ],
)
def test_settings_that_change_the_senses_or_the_actions_are_refused(
    changes: dict[str, Any], has: str
) -> None:
    says = f"{has}; the brain is made for 2 senses and 2 actions$"
    with pytest.raises(InputError, match=says):
        changed(config(MEADOW), changes)
