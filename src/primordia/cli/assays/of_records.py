"""Assays that only read records: no organism lives again."""

from pathlib import Path

from primordia.cli.assays.options import Found, after_option, arms_of, assay
from primordia.cli.flags import island_option, runs_argument


@assay(
    "Measure how strongly length of life is inherited.",
    runs_argument,
    after_option,
    island_option("Count only parents and children that were both born on this island"),
    trusted=False,
)
def heredity(runs: tuple[Path, ...], after: float, island: str | None) -> Found:
    """Measure from the records how strongly length of life is inherited.

    Several runs are measured as one arm. Each arm of an experiment is measured.
    """
    return {str(arm.path): arm.heredity(after, island) for arm in arms_of(runs)}


@assay(
    "Measure the error threshold of mutation.",
    runs_argument,
    after_option,
    island_option("Count only organisms, and their children, that were born on this island"),
    trusted=False,
)
def threshold(runs: tuple[Path, ...], after: float, island: str | None) -> Found:
    """Measure the error threshold s (1 - p (1 - v)), from the records.

    p is the share of children that mutate. v is the share of good parents' mutants that are as good
    as the parents. s is the mean life of good parents' copies, divided by the mean life of all
    organisms. If the result is above 1, a good line persists. Several runs are measured as one arm.
    Each arm of an experiment is measured.
    """
    return {str(arm.path): arm.threshold(after, island) for arm in arms_of(runs)}
