"""Gymnasium environments as a habitat: info, errors, seeds, the time limit, and messages."""

from importlib.metadata import version
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

import gymnasium

from primordia import own_code
from primordia.errors import Trouble
from primordia.habitats.gymnasium import environment
from primordia.habitats.gymnasium.environment import line
from primordia.habitats.gymnasium.habitat import Gymnasium
from primordia.habitats.gymnasium.simulator import MESSAGE
from tests import ponds
from tests.ponds import Pond, environments, lived, noted_seeds


def pond(**settings: Any) -> Gymnasium:
    return Gymnasium(env="tests.ponds:Pond-v0", workers=0, **settings)


def with_arrays(game: Gymnasium, **arrays: Any) -> Gymnasium:
    """Return a habitat whose environments report these arrays."""
    stub: Any = SimpleNamespace(arrays=arrays, begin=lambda alive: None, finish=lambda: None)
    game._pool = stub
    return game


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
    """Errors of all ticks and cells are added. The message is that of the last cell that failed."""
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
    """The bodies are 1, 2, 3, 4 and 4 ticks old; the last one is dead."""
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


def test_numbers_of_info_are_stored_side_by_side_and_a_missing_one_is_zero() -> None:
    made, arrays = environments(a=1, pair=2, b=1)
    made._tell(1, np.zeros(2), {"b": 4, "pair": np.array([2, 3]), "a": 1.5, "c": 9})
    assert arrays["info"].tolist() == [[0, 0, 0, 0], [1.5, 2, 3, 4]]
    made._tell(1, np.array([5.0, 6.0]), {"pair": [7, 8]})
    assert arrays["info"].tolist() == [[0, 0, 0, 0], [0, 7, 8, 0]]
    assert arrays["obs"].tolist() == [[0, 0], [5, 6]]


def test_a_function_of_food_is_given_the_result_of_the_step(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    given: list[tuple[Any, ...]] = []
    step = (np.array([5.0, 6.0]), 0.5, False, True, {"age": 1})

    def food(*result: Any) -> float:
        given.append(result)
        return 2.5

    monkeypatch.setattr(ponds, "food", food)
    monkeypatch.setattr(Pond, "step", lambda *_: step)
    made, arrays = environments(food="tests.ponds:food")
    lived(made, arrays, 6, 1)
    assert given == [step]
    names = ("reward", "food", "terminated", "truncated")
    assert [arrays[name][0].item() for name in names] == [0.5, 2.5, False, True]
    made.reset(0)
    assert [arrays[name][0].item() for name in names] == [0, 0, False, False]


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


@pytest.mark.parametrize("setting", ["food", "effort", "fatal"])
def test_info_is_read_if_a_single_setting_names_it(setting: str) -> None:
    """After the first tick, the age is 1. The environment's registered limit is 50 ticks."""
    game = pond(**{setting: 'info["age"] > 0' if setting == "fatal" else '3 * info["age"]'})
    game.open(2)
    game.reset(np.arange(2), np.array([[1], [2]], np.uint32))
    _, outcome = game.step(np.zeros((2, 1), np.float32), np.ones(2, bool))
    expected: Any = {"food": [0, 0], "effort": [0, 0], "fatal": [False, False]}
    expected[setting] = [True, True] if setting == "fatal" else [3, 3]
    assert {name: getattr(outcome, name).tolist() for name in expected} == expected
    assert game.episode == 50
    game.close()


def test_a_fault_leaves_its_message_and_no_results() -> None:
    made, arrays = environments(a=1)
    for name in ("reward", "food", "terminated", "truncated", "info"):
        arrays[name][:] = 1
    made._fail(0, "x" * (MESSAGE + 9))
    assert arrays["message"].sum(axis=1).tolist() == [MESSAGE * ord("x"), 0]
    made._fail(0, "é" * MESSAGE)
    assert arrays["message"][0].tobytes().decode() == "é" * (MESSAGE // 2)
    made._fail(0, "short")
    assert arrays["message"][0].tobytes().rstrip(b"\0") == b"short"
    assert arrays["fault"].tolist() == [True, False]
    for name in ("reward", "food", "terminated", "truncated", "info"):
        assert arrays[name].ravel().tolist() == [0, 1]


def test_a_caption_shows_action_and_reward() -> None:
    body = {"obs": np.array([7.0, 8.0]), "reward": np.float64(-1.256)}
    assert pond().caption(body, np.array([0.25])) == "action [0.25]   reward -1.26"


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


def test_an_error_is_one_line_that_names_its_kind_unless_gymnasium_wrote_it() -> None:
    assert line(ValueError("two\n  lines")) == "ValueError: two lines"
    assert line(ValueError()) == "ValueError"
    assert line(gymnasium.error.NameNotFound("no such name")) == "no such name"
    assert line(gymnasium.error.NameNotFound("")) == "NameNotFound"


def test_the_module_of_a_name_is_imported(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    loaded: list[str] = []
    monkeypatch.setattr(own_code, "load", loaded.append)
    for name in ("tests.ponds:Pond-v0", "CartPole-v1"):
        environment.make(name, {}).close()
    assert loaded == ["tests.ponds"]


def test_an_environment_is_made_with_its_options_and_draws_if_it_is_watched() -> None:
    pond = environment.make("tests.ponds:Pond-v0", {"edge": 2.5}, watched=True).unwrapped
    assert isinstance(pond, Pond)
    assert (pond.edge, pond.render_mode) == (2.5, "rgb_array")


def test_the_versions_are_those_of_the_packages_that_compute_the_environment() -> None:
    pytest.importorskip("mujoco")
    environment.make("Hopper-v5", {}).close()
    assert {"gymnasium", "numpy", "mujoco"} == set(environment.versions("Hopper-v5"))
    assert {"gymnasium", "numpy"} == set(environment.versions("CartPole-v1"))
    pytest.importorskip("Box2D")
    environment.make("LunarLander-v3", {}).close()
    assert {"gymnasium", "numpy", "box2d"} == set(environment.versions("LunarLander-v3"))


def test_the_version_of_the_package_of_an_environment_is_known(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Nothing looks for the package of Gymnasium's own environments, which takes a second."""
    monkeypatch.setattr(own_code, "owners", lambda: {"ale_py": ["ale-py"]})
    monkeypatch.setattr(
        environment, "spec", lambda env: SimpleNamespace(entry_point="ale_py.env:Env")
    )
    assert environment.versions("any")["ale-py"] == version("ale-py")
    monkeypatch.undo()
    monkeypatch.setattr(own_code, "owners", pytest.fail)
    assert set(environment.versions("CartPole-v1")) == {"gymnasium", "numpy"}
