"""Lives in Gymnasium environments that are lived again from their seed and actions, or cannot be."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from primordia.errors import Trouble
from tests import ponds
from tests.habitats.test_gymnasium_simulator import environments
from tests.ponds import CRASH, Pond


def lived(made: Any, arrays: dict[str, np.ndarray], word: int, ticks: int) -> None:
    """Live some ticks in the first cell."""
    arrays["seed"][0] = word
    made.reset(0)
    for tick in range(ticks):
        arrays["action"][0] = tick / 8
        made.step([0])


def test_only_the_present_life_of_a_cell_is_lived_again() -> None:
    (one, a), (other, b) = environments(), environments()
    lived(one, a, 6, 7)
    lived(one, a, 8, 3)
    other.load(1, one.save(0))
    assert b["obs"][1].tolist() == a["obs"][0].tolist()
    for arrays, made, cell in ((a, one, 0), (b, other, 1)):
        arrays["action"][cell] = 0.5
        made.step([cell])
    assert b["obs"][1].tolist() == a["obs"][0].tolist()
    assert one.save(0) == other.save(1)


@pytest.mark.parametrize("number", [0, 1])
def test_a_life_must_end_in_all_numbers_of_its_observation(number: int) -> None:
    (one, a), (other, _) = environments(), environments()
    lived(one, a, 6, 3)
    saved = bytearray(one.save(0))
    saved[saved.index(b"\n") + 1 + 8 * number] ^= 1
    with pytest.raises(Trouble, match="of cell 1 did not repeat its life of 3 ticks"):
        other.load(1, bytes(saved))


def test_a_life_that_could_not_begin_fails_in_its_first_tick_also_after_a_resume() -> None:
    """The pond has no water at the seeds 1 and 5. The observation is not that of the life before."""
    (one, a), (other, b) = environments("Unborn"), environments("Unborn")
    lived(one, a, 4, 3)
    assert a["obs"][0].all()
    lived(one, a, 2, 0)
    assert (a["obs"][0].tolist(), a["fault"].tolist()) == ([0, 0], [False, False])
    other.load(1, one.save(0))
    for arrays, made, cell in ((a, one, 0), (b, other, 1)):
        made.step([cell])
        assert arrays["fault"][cell]
        assert arrays["message"][cell].tobytes().rstrip(b"\0") == b"RuntimeError: no water"
    lived(one, a, 4, 1)
    assert not a["fault"].any()


@pytest.mark.parametrize("saving", ["replay", "snapshot"])
def test_an_environment_that_failed_is_not_used_after_a_resume(saving: str) -> None:
    """A spoiled pond fails at each reset after an error."""
    (one, a), (other, b) = (environments("Spoiled", saving=saving) for _ in "ab")
    word = 2
    while not a["fault"][0]:
        word += 2
        lived(one, a, word, CRASH)
    other.load(1, one.save(0))
    b["seed"][1] = word
    other.reset(1)
    other.step([1])
    assert b["fault"].tolist() == [False, False]


def test_a_function_of_food_is_given_the_result_of_the_step(monkeypatch: Any) -> None:
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
