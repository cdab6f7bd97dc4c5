"""Tasks made from Gymnasium environments: what is measured, settings, and facts."""

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from primordia.errors import InputError
from primordia.habitats.gymnasium import check, environment, probe, task
from primordia.habitats.gymnasium.check import Measured
from primordia.habitats.gymnasium.habitat import Gymnasium
from primordia.habitats.gymnasium.probe import LONGEST, PICTURES_S, _numbers
from primordia.settings.doors import settings
from tests.ponds import Pond, noted_seeds


def test_numbers_of_info_are_single_ones_and_short_lists() -> None:
    info = {
        "age": 3, "wage": 0.5, "wet": True, "one": np.float32(2), "none": None, "word": "no",
        "list": [1, 2], "point": np.array(3.0), "pair": np.zeros(2), "grid": np.zeros((2, 3)),
        "long": np.zeros(LONGEST), "longer": np.zeros(LONGEST + 1), "words": np.array(["a"]),
    }  # fmt: skip
    assert _numbers(info) == {"age": 0, "wage": 0, "wet": 0, "one": 0, "point": 0, "pair": 2,
                              "grid": 6, "long": LONGEST}  # fmt: skip


def test_random_play_has_the_options_and_notes_the_info_of_every_tick(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The edge is out of the fish's reach. The environment cuts each life at an age of 40."""
    reset, step = Pond.reset, Pond.step

    def begin(self: Pond, **given: Any) -> Any:
        return reset(self, **given)[0], {"born": 1}

    def go_on(self: Pond, action: Any) -> Any:
        seen, reward, terminated, _, info = step(self, action)
        odd = {"half": 0.5} if self.age == 7 else {}
        return seen, reward, terminated, self.age == 40, {**info, **odd}

    monkeypatch.setattr(Pond, "reset", begin)
    monkeypatch.setattr(Pond, "step", go_on)
    seeds = noted_seeds(monkeypatch)
    probe._info.cache_clear()
    found = probe.info_of("tests.ponds:Pond-v0", {"edge": 1e9})
    probe._info.cache_clear()
    assert found == {"born": 0, "age": 0, "half": 0}
    assert seeds == [0, 40, 80, 120, 160]


def test_an_error_ends_a_life_of_random_play() -> None:
    seen = probe.random_play("tests.ponds:Crashing-v0", {})
    ages = [info["age"] for _, info in seen]
    assert all(age in (0, before + 1) for before, age in pairwise(ages))
    assert len(seen) < probe.TICKS + ages.count(0)  # a step with an error is not noted


def test_a_picture_is_tried_with_the_options_of_the_environment(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made: list[tuple[Any, ...]] = []

    def make(*given: Any, watched: bool = False) -> Pond:
        made.append((*given, watched))
        return Pond()

    monkeypatch.setattr(environment, "make", make)
    assert probe.screen_shape("any", {"edge": 2.0}) == (30, 40, 3)
    assert made == [("any", {"edge": 2.0}, True)]


def test_an_environment_that_cannot_draw_is_an_error_that_says_why(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def render(_: Pond) -> None:
        raise RuntimeError("no\npaint")

    monkeypatch.setattr(Pond, "render", render)
    game = Gymnasium(env="tests.ponds:Pond-v0", workers=0)
    with pytest.raises(
        InputError, match=r"^habitat: tests.ponds:Pond-v0 cannot draw: .*: no paint$"
    ):
        game.open(1, watched=True)
    game.open(1)
    assert set(game.seen()) == {"obs", "reward"}
    game.close()


@pytest.mark.parametrize(
    ("metadata", "rate", "pictures"),
    [
        ({"render_modes": ["human", "rgb_array"], "render_fps": 25}, 25.0, True),
        ({"render_modes": ["rgb_array"]}, PICTURES_S, True),
        ({"render_modes": ["rgb_array"], "render_fps": 0}, PICTURES_S, True),
        ({"render_modes": ["human"], "render_fps": 12.5}, 12.5, False),
        ({"render_modes": None}, None, False),
        ({}, None, False),
    ],
)
def test_the_rate_is_that_of_the_environment_or_that_of_pictures(
    metadata: dict[str, Any], rate: float | None, pictures: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Pond, "metadata", metadata)
    probe._probe.cache_clear()
    found = probe.probe("tests.ponds:Pond-v0", {})
    probe._probe.cache_clear()
    assert (found.rate, found.pictures, found.limit) == (rate, pictures, 50)


@pytest.mark.parametrize(
    ("largest", "scale"),
    [
        ([5.0, 0.1, 900.0], []),
        ([5.1, 0.1, 900.0], [5.0, 1.0, 1.0]),
        ([4.9, 0.01, 900.0], []),
        ([1234.0, 5.6, 9.0], [1000.0, 6.0, 1.0]),
    ],
)
def test_only_large_numbers_without_bounds_are_scaled(
    largest: list[float], scale: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The third number has bounds. A scale is the largest absolute value, with one digit."""
    observation = SimpleNamespace(unbounded=lambda: np.array([True, True, False]))
    rows = [np.array(largest) * share for share in (0.5, -1.0, 0.0)]
    played = [(row, dict[str, Any]()) for row in rows]
    monkeypatch.setattr(probe, "probe", lambda *given: SimpleNamespace(observation=observation))
    monkeypatch.setattr(probe, "random_play", lambda *given: played)
    assert task._scale("any") == scale


@pytest.mark.parametrize("bounds", [True, False])
@pytest.mark.parametrize("fresh", [True, False])
def test_a_task_has_the_settings_that_were_measured(
    bounds: bool, fresh: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Numbers that have bounds, or are small, need no scale."""
    unbounded = np.array([False, not bounds])
    observation = SimpleNamespace(unbounded=lambda: unbounded)
    found = Measured(saving="replay", fresh=fresh, lifespan=100.0, faults=["a fault"])
    monkeypatch.setattr(probe, "probe", lambda *given: SimpleNamespace(observation=observation))
    monkeypatch.setattr(probe, "info_of", lambda *given: {"age": 0})
    monkeypatch.setattr(check, "measure", lambda *given: found)
    monkeypatch.setattr(task, "_scale", lambda env: [1.0, 50.0])
    monkeypatch.setattr(task, "_facts", lambda *given: [given[0], given[2], given[3]])
    table, facts, faults = task.task.__wrapped__("tests.ponds:ponds/Pond-v0")
    assert (facts, faults) == (["tests.ponds:ponds/Pond-v0", found, {"age": 0}], ["a fault"])
    assert (table["task"], table["replication"]) == ("ponds-Pond-v0", 0.01)
    assert table["about"] == "Gymnasium's tests.ponds:ponds/Pond-v0: live until it terminates"
    own = {"name": "gymnasium", "env": "tests.ponds:ponds/Pond-v0", "fatal": "terminated"}
    optional = ({"fresh": True} if fresh else {}) | ({} if bounds else {"scale": [1.0, 50.0]})
    assert table["habitat"] == {**own, "saving": "replay", **optional}


@pytest.mark.parametrize(
    ("lifespan", "expected"),
    [(0, 0.5), (1.0, 0.5), (2.0, 0.5), (3.0, 0.3333), (100, 0.01), (1000, 0.001), (1e6, 0.001)],
)
def test_an_organism_replicates_about_once_in_a_random_life(
    lifespan: float, expected: float
) -> None:
    assert settings("", lifespan, {"env": "Pond-v0"})["replication"] == expected


@pytest.mark.parametrize("ended", [0, 1])
@pytest.mark.parametrize("limit", [None, 50])
@pytest.mark.parametrize("why", ["", "it is closed"])
def test_the_facts_of_an_environment_have_its_figures(
    ended: int, limit: int | None, why: str
) -> None:
    about: Any = SimpleNamespace(observation=SimpleNamespace(width=7), limit=limit)
    found = Measured(saving="replay", lifespan=1234.4, ended=ended, why=why)
    facts = task._facts("tests.ponds:Pond-v0", about, found, {"age": 0, "pair": 2})
    assert facts == [
        "Observation: Box (2,) of float64, from -10 to 10; obs[0] to obs[6] in conditions.",
        "Action: Box (1,) of float32, from -1 to 1.",
        'Numbers in info: info["age"], info["pair"].',
        "The environment's limit of 50 steps is off; time_limit = 50 turns the limit on."
        if limit
        else "The environment has no time limit.",
        "After an interruption, lives are repeated exactly, from their seed and actions"
        + (" (it is closed)." if why else "."),
        "With random actions, a life has 1,234 ticks on average."
        if ended
        else "No life ended in random play: set `fatal` to a condition, or add a metabolism.",
    ]
    assert task._facts("tests.ponds:Pond-v0", about, found, {})[2] == "Numbers in info: none."
