"""Progress of work: steps within steps count as parts of the whole."""

import pytest

from primordia.progress import shown, steps, tell


def told(work: str, share: float) -> None:
    TOLD.append((work, pytest.approx(share)))


TOLD: list = []


def test_work_in_a_step_is_a_part_of_the_step() -> None:
    TOLD.clear()
    with shown(told):
        for _ in steps("ab", "outer"):
            for _ in steps(range(2), "inner"):
                tell("innermost", 0.5)
        tell("after", 1)
    tell("without a display", 0.5)
    halves = [[("outer", at), ("inner", at), ("innermost", at + 0.125), ("inner", at + 0.25),
               ("innermost", at + 0.375)] for at in (0, 0.5)]  # fmt: skip
    assert [*halves[0], *halves[1], ("after", 1)] == TOLD


def test_steps_that_are_left_early_leave_the_whole_as_it_was() -> None:
    TOLD.clear()
    with shown(told):
        left = steps(range(4), "left")
        next(left), next(left)
        left.close()
        tell("after", 0.5)
    assert TOLD == [("left", 0), ("left", 0.25), ("after", 0.5)]
