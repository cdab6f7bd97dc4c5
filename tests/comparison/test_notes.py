"""The notes below the tables of a comparison: each is printed only if it applies."""

from typing import Any

import numpy as np
import pytest

from primordia.comparison.measured import Measured
from primordia.comparison.tables import comparison_tables, evidence_notes
from tests.comparison.arms import arm, side_by_side


def notes(*arms: Any, **changed: Any) -> str:
    """Return the notes as one text."""
    return comparison_tables(side_by_side(*arms, **changed)).partition("Medians and intervals ")[2]


def some(name: str, worlds: int, seed: int = 0, **counts: Any) -> Any:
    return arm(name, [*range(1, worlds + 1)], seed=seed, **counts)


@pytest.mark.parametrize(
    ("worlds", "expected"),
    [
        ((5, 5), ""),
        ((6, 4), "Intervals, and words for sizes, need 5 worlds of each run (--seeds 5): b has 4."),
        ((6, 5, 6), "Intervals need 6 worlds of each run (--seeds 6): b has 5."),
        (
            (6, 6, 4),
            "Intervals need 6 worlds of each run (--seeds 6): c has 4; words for sizes need 5.",
        ),
        ((6, 6, 6), ""),
    ],
)
def test_a_note_names_the_run_with_too_few_worlds(worlds: tuple[int, ...], expected: str) -> None:
    arms = [
        some(name, count, 100 * k)
        for k, (name, count) in enumerate(zip("abc", worlds, strict=False))
    ]
    lines = [line for line in notes(*arms).splitlines() if "worlds of each run" in line]
    assert lines == ([expected] if expected else [])


def test_evidence_is_explained_where_there_is_some() -> None:
    def of(*arms: Any) -> list[str]:
        return [note.partition(":")[0] for note in evidence_notes(side_by_side(*arms))]

    together = "All intervals of an outcome hold simultaneously in 95 % of cases, each alone in "
    two = evidence_notes(side_by_side(some("a", 6), some("b", 6, 50), some("c", 6, 90)))
    assert two == [
        f"{together}97.5 % (Bonferroni, for 2 contrasts).",
        "Needs: the number of worlds in each arm at which 80 % of experiments find an effect of this"
        " size, at a level of 2.5 % (Noether 1987).",
    ]
    four = evidence_notes(side_by_side(*(some(name, 8, 50 * k) for k, name in enumerate("abcde"))))
    assert four[0] == f"{together}98.75 % (Bonferroni, for 4 contrasts)."
    assert "at a level of 1.25 % (" in four[1]
    assert of(some("a", 5), some("b", 5, 50)) == ["Needs"]
    assert of(some("a", 4), some("b", 9, 50)) == []
    assert of(some("a", 4), some("b", 4)) == ["Within seeds"]
    assert of(some("a", 5), some("b", 5, 50), some("c", 5)) == ["Within seeds", "Needs"]


def test_evidence_of_one_run_is_explained_where_another_has_too_few_worlds() -> None:
    """Only one of two runs has intervals and needed worlds."""
    for second, third in ((6, 4), (4, 6)):
        compared = side_by_side(some("a", 6), some("b", second, 50), some("c", third, 90))
        together, needs = evidence_notes(compared)
        assert together.startswith("All intervals of an outcome hold simultaneously in 95 %")
        assert needs.startswith("Needs: ")
        assert "ratio of medians (95 % for all)" in comparison_tables(compared)


def test_crashes_forks_and_late_numbers_are_explained_where_there_are_any() -> None:
    plain = some("a", 5), some("b", 5)
    assert "A long life: 12,000 ticks. Mean lifespan:" in notes(*plain)
    assert "A long life: 50 ticks. Mean lifespan:" in notes(*plain, age=50)
    assert "Crashes:" not in notes(*plain)
    assert "Crashes:" not in notes(plain[0], some("b", 5, total=[0, 3, 0, 0, 1]))
    assert "Crashes:" in notes(plain[0], some("b", 5, crashes=[0, 0, 0, 0, 1]))
    assert "count from" not in notes(*plain)
    assert "Births, ticks and lives count from tick 1,500, the tick" in notes(*plain, begin=1500)
    assert "Late: the last quarter" in notes(*plain), "food is compared"
    nothing = Measured(np.zeros(5), np.zeros(5, bool))
    for each in plain:
        each.measured["food"] = nothing
    assert "Late:" not in notes(*plain), "many worlds saturate"
    for each in plain:
        each.measured["births"] = nothing
    assert "Late: the last quarter" in notes(*plain), "the pace is compared"
