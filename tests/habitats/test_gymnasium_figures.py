"""What is counted and told of Gymnasium environments: info, faults, captions, bounds, and facts."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

import gymnasium
from gymnasium import spaces

from primordia.errors import Trouble
from primordia.habitats.gymnasium import check, environment, probe, task
from primordia.habitats.gymnasium.check import Measured
from primordia.habitats.gymnasium.environment import line
from primordia.habitats.gymnasium.habitat import Gymnasium
from primordia.habitats.gymnasium.probe import LONGEST, PICTURES_S, _numbers
from primordia.habitats.gymnasium.simulator import MESSAGE, Environments, fields
from primordia.habitats.gymnasium.spaces import Acting, Observation, described
from primordia.settings.doors import replication
from tests.ponds import Pond


def pond(**settings: Any) -> Gymnasium:
    return Gymnasium(env="tests.ponds:Pond-v0", workers=0, **settings)


def with_arrays(game: Gymnasium, **arrays: Any) -> Gymnasium:
    """Return a habitat whose environments report these arrays."""
    stub: Any = SimpleNamespace(arrays=arrays, step=lambda alive: None)
    game._pool = stub
    return game


def test_numbers_of_info_are_single_ones_and_short_lists() -> None:
    info = {
        "age": 3, "wage": 0.5, "wet": True, "one": np.float32(2), "none": None, "word": "no",
        "list": [1, 2], "point": np.array(3.0), "pair": np.zeros(2), "grid": np.zeros((2, 3)),
        "long": np.zeros(LONGEST), "longer": np.zeros(LONGEST + 1), "words": np.array(["a"]),
    }  # fmt: skip
    assert _numbers(info) == {"age": 0, "wage": 0, "wet": 0, "one": 0, "point": 0, "pair": 2,
                              "grid": 6, "long": LONGEST}  # fmt: skip


def test_each_value_of_info_has_columns_of_its_own() -> None:
    game = pond()
    game.__dict__["_info"] = {"a": 0, "pair": 2, "b": 0, "three": 3, "c": 0}
    columns = np.arange(16.0).reshape(2, 8)
    found = {name: values.tolist() for name, values in game._of_info(columns).items()}
    assert found == {
        "a": [0, 8], "pair": [[1, 2], [9, 10]], "b": [3, 11],
        "three": [[4, 5, 6], [12, 13, 14]], "c": [7, 15],
    }  # fmt: skip


def test_one_more_error_than_the_settings_allow_stops_the_run() -> None:
    """The errors of several ticks and cells add up; the message is that of the last cell."""
    text = np.zeros((3, MESSAGE), np.uint8)
    for cell, words in enumerate((b"first", b"second", b"third")):
        text[cell, : len(words)] = np.frombuffer(words, np.uint8)
    game = with_arrays(pond(faults=4), message=text, fault=np.array([True, True, False]))
    for fault in ([True, True, False], [False, False, True], [True, False, False]):
        game._count_faults(np.array(fault))
    with pytest.raises(Trouble, match=r"^6 organisms died of errors in .*, the last error: second"):
        game._count_faults(np.array([True, True, False]))
    assert [game.message(cell) for cell in range(3)] == ["first", "second", ""]
    with pytest.raises(Trouble, match=r"^1 organism"):
        with_arrays(pond(faults=0), message=text, fault=np.ones(3, bool))._count_faults(
            np.array([True, False, False])
        )


@pytest.mark.parametrize(
    ("limit", "expired"),
    [(None, [True, False, False, False, False]), (4, [True, False, True, True, True])],
)
def test_a_life_ends_at_the_time_limit_or_when_the_environment_cuts_it(
    limit: int | None, expired: list[bool]
) -> None:
    """The bodies are 1, 2, 3, 4 and 4 ticks old; the last one does not live."""
    none, numbers = np.zeros(5, bool), np.zeros(5)
    game = with_arrays(
        pond(time_limit=limit), action=np.zeros((5, 1)), obs=np.zeros((5, 2)), reward=numbers,
        food=numbers, terminated=none, truncated=np.arange(5) == 0, fault=none,
        info=np.zeros((5, 1)),
    )  # fmt: skip
    game._age = np.array([1, 2, 3, 4, 4])
    _, outcome = game.step(np.zeros((5, 1), np.float32), np.arange(5) < 4)
    assert np.asarray(outcome.expired).tolist() == expired
    assert game._age.tolist() == [2, 3, 4, 5, 4]


def environments(**info: int) -> tuple[Environments, dict[str, np.ndarray]]:
    """Return ponds in two cells of this process, and the arrays that they fill."""
    shared = fields(Observation(Pond.observation_space), Acting(Pond.action_space), info)
    arrays = {name: np.zeros((2, *shape), dtype) for name, (dtype, shape) in shared.items()}
    made = Environments(arrays, "tests.ponds:Pond-v0", {}, [], "replay", False, "", info)
    for cell in range(2):
        made.make(cell)
    return made, arrays


def test_numbers_of_info_are_stored_side_by_side_and_a_missing_one_is_zero() -> None:
    made, arrays = environments(a=1, pair=2, b=1)
    made._tell(1, np.zeros(2), {"b": 4, "pair": np.array([2, 3]), "a": 1.5, "c": 9})
    assert arrays["info"].tolist() == [[0, 0, 0, 0], [1.5, 2, 3, 4]]
    made._tell(1, np.array([5.0, 6.0]), {"pair": [7, 8]})
    assert arrays["info"].tolist() == [[0, 0, 0, 0], [0, 7, 8, 0]]
    assert arrays["obs"].tolist() == [[0, 0], [5, 6]]


def noted_seeds(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return the seeds with which ponds are reset from now on."""
    seeds, reset = list[int](), Pond.reset

    def noting(self: Pond, *, seed: int, options: Any = None) -> Any:
        seeds.append(seed)
        return reset(self, seed=seed, options=options)

    monkeypatch.setattr(Pond, "reset", noting)
    return seeds


def test_the_seed_of_a_life_has_the_31_upper_bits_of_its_word(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Many environments take no larger seed."""
    made, arrays = environments()
    seeds = noted_seeds(monkeypatch)
    for cell, word in ((0, 2**32 - 1), (1, 7), (0, 1), (1, 2**31)):
        arrays["seed"][cell] = word
        made.reset(cell)
    assert seeds == [2**31 - 1, 3, 0, 2**30]


def test_each_life_of_random_play_has_another_seed(monkeypatch: pytest.MonkeyPatch) -> None:
    seeds = noted_seeds(monkeypatch)
    seen = probe.random_play("tests.ponds:Pond-v0", {"edge": 1.5}, ())
    assert len(seen) == probe.TICKS + len(seeds)
    begins = [k for k, (_, info) in enumerate(seen) if info["age"] == 0]
    assert seeds == [k - number for number, k in enumerate(begins)]
    assert len(seeds) > 5


def test_there_are_at_most_as_many_workers_as_cells() -> None:
    crowd = Gymnasium(env="tests.ponds:Pond-v0", workers=3)
    crowd.check(3)
    with pytest.raises(ValueError, match="3 workers are more than the 2 cells; use at most 2"):
        crowd.check(2)


def test_a_fault_leaves_its_message_and_no_results() -> None:
    made, arrays = environments(a=1)
    for name in ("reward", "food", "terminated", "truncated", "info"):
        arrays[name][:] = 1
    made._fail(0, "x" * (MESSAGE + 9))
    assert arrays["message"].sum(axis=1).tolist() == [MESSAGE * ord("x"), 0]
    made._fail(0, "short")
    assert arrays["message"][0].tobytes().rstrip(b"\0") == b"short"
    assert arrays["fault"].tolist() == [True, False]
    for name in ("reward", "food", "terminated", "truncated", "info"):
        assert arrays[name].ravel().tolist() == [0, 1]


def test_a_caption_tells_action_and_reward() -> None:
    body = {"obs": np.array([7.0, 8.0]), "reward": np.float64(-1.256)}
    assert pond().caption(body, np.array([0.25])) == "action [0.25]   reward -1.26"


@pytest.mark.parametrize(
    ("low", "high", "senses"),
    [
        (-1e6, 1e6, [-3, 5]),
        (-0.99e6, 0.99e6, [-3 / 0.99e6, 5 / 0.99e6]),
        (-8.0, np.inf, [-3, 5]),
        (-np.inf, 8.0, [-3, 5]),
        (-8.0, 8.0, [-0.375, 0.625]),
    ],
)
def test_a_bound_of_a_million_is_no_bound(low: float, high: float, senses: list[float]) -> None:
    """A number is scaled only if it has both bounds; an output fills the range in the same way."""
    box = spaces.Box(low, high, (2,), np.float64)
    observation, acting = Observation(box), Acting(box)
    found = observation.senses(np.ones(2), squash=False)(np.array([[-3.0, 5.0]]))
    np.testing.assert_allclose(found, [senses], rtol=1e-6)
    free = senses == [-3, 5]
    assert observation.unbounded().tolist() == [free] * 2
    rows = acting.rows(np.array([[-0.5, 20.0]], np.float32))
    most = min(high, 20.0) if free else high
    np.testing.assert_allclose(rows, [[-0.5 if free else low / 2, most]])


def test_a_number_with_a_single_value_is_divided_by_its_scale() -> None:
    observation = Observation(spaces.Box(8.0, 8.0, (2,), np.float64))
    senses = observation.senses(np.array([4.0, 2.0]), squash=False)
    assert senses(np.array([[8.0, 8.0]])).tolist() == [[2.0, 4.0]]


def test_a_box_is_described_by_its_least_and_largest_number() -> None:
    low, high = np.float32([-1, -5]), np.float32([2, 3])
    assert described(spaces.Box(low, high)) == "Box (2,) of float32, from -5 to 3"
    assert described(spaces.Discrete(3)) == "Discrete(3)"


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
    found = probe.probe("tests.ponds:Pond-v0", {}, ())
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


@pytest.mark.parametrize(
    ("food", "function"),
    [
        ("tests.ponds:food", "tests.ponds:food"),
        ("ponds:food", "ponds:food"),
        ("reward", ""),
        ("sum(obs[0:2])", ""),
        ("sum(obs[:2])", ""),
        ("tests.ponds:", ""),
        ("1.5:food", ""),
    ],
)
def test_food_is_a_function_if_it_names_a_module_and_a_function(food: str, function: str) -> None:
    named: Any = Gymnasium.__dict__["_food_function"]
    assert named.fget(SimpleNamespace(food=food)) == function


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
    table, facts, faults = task._measured.__wrapped__("tests.ponds:ponds/Pond-v0")
    assert (facts, faults) == (["tests.ponds:ponds/Pond-v0", found, {"age": 0}], ["a fault"])
    assert (table["task"], table["replication"]) == ("ponds-Pond-v0", replication(100.0))
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
    assert replication(lifespan) == expected


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


def test_an_error_is_told_in_one_line_with_its_kind_unless_it_is_gymnasiums() -> None:
    assert line(ValueError("two\n  lines")) == "ValueError: two lines"
    assert line(ValueError()) == "ValueError"
    assert line(gymnasium.error.NameNotFound("no such name")) == "no such name"
    assert line(gymnasium.error.NameNotFound("")) == "NameNotFound"


def test_the_versions_are_those_of_the_packages_that_compute_the_environment() -> None:
    pytest.importorskip("mujoco")
    environment.make("Hopper-v5", {}, ()).close()
    assert {"gymnasium", "numpy", "mujoco"} == set(environment.versions("Hopper-v5"))
    assert {"gymnasium", "numpy"} == set(environment.versions("CartPole-v1"))
