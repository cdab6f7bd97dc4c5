"""Lives in Gymnasium environments are lived again from seed and actions, if they can be."""

import pytest

pytest.importorskip("gymnasium")

from primordia.errors import Trouble
from tests.ponds import CRASH, environments, lived


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
def test_a_life_must_end_in_the_same_observation_in_each_number(number: int) -> None:
    (one, a), (other, _) = environments(), environments()
    lived(one, a, 6, 3)
    saved = bytearray(one.save(0))
    saved[saved.index(b"\n") + 1 + 8 * number] ^= 1
    with pytest.raises(Trouble, match="of cell 1 did not repeat its life of 3 ticks"):
        other.load(1, bytes(saved))


def test_a_life_that_could_not_begin_fails_in_its_first_tick_also_after_a_resume() -> None:
    """The pond fails to reset with the seed 1, which is that of word 2. Its observation is then 0."""
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
def test_an_environment_that_failed_is_replaced_after_a_resume(saving: str) -> None:
    """A spoiled pond fails at each reset after an error. The test looks for a life with an error."""
    (one, a), (other, b) = (environments("Spoiled", saving=saving) for _ in "ab")
    word = 2
    while not a["fault"][0] and word < 2000:
        word += 2
        lived(one, a, word, CRASH)
    other.load(1, one.save(0))
    b["seed"][1] = word
    other.reset(1)
    other.step([1])
    assert b["fault"].tolist() == [False, False]
