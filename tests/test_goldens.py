"""Golden digests: small runs of all tasks and of all parts of the law live as they did once."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from primordia import Run, device
from tests import plays
from tests.goldens import CASES, FILE, entries, live, others, placements, tasks

GOLDENS: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
PLAYS: dict[str, Any] = json.loads(plays.FILE.read_text(encoding="utf-8"))

SHOWN = {"few-poles"}
"""A task in JAX. Many tests share its compiled code. The others are slow; one of them, on the host, is
lived in `habitats/test_atari_lives.py`, where much is drawn at random and organisms feed.

Every simulator but the Atari games is played below, and laws have seasons.
"""


def marked(cases: Iterable[tuple[str, Any]], shown: set[str]) -> list[Any]:
    """Return the names of cases as parameters; those that are not in `shown` are slow."""
    slow = pytest.mark.slow
    return [pytest.param(name, marks=() if name in shown else slow) for name, _ in cases]


def test_each_case_has_its_golden() -> None:
    assert set(GOLDENS["cases"]) == set(CASES)


def test_much_happens_in_the_worlds_of_each_golden() -> None:
    for name, golden in GOLDENS["cases"].items():
        counts = golden["counts"]
        assert counts["births"] >= 20
        assert counts["deaths"] >= 5
        assert counts.get("born mutant", 0) >= 1 or "founder" in name
        assert counts["samples"] >= 3


LAWS = marked([*placements(), *others()], set())
"""The law's parts. `tests/engine/test_strange.py` has one of them that is not slow."""


@pytest.mark.parametrize("name", [*marked(tasks(), SHOWN), *LAWS])
def test_each_case_lives_as_it_did(name: str, tmp_path: Path) -> None:
    assert_lives_as_it_did(name, tmp_path)


def test_each_task_has_the_settings_with_which_it_was_played() -> None:
    assert {file: play["settings"] for file, play in PLAYS["plays"].items()} == {
        file: plays.settings_hash(file) for file in plays.NAMES
    }


PLAYED = {f"{name}.toml" for name in (
    "cartpole_survival_hidden", "lunarlander_survival", "mountaincar_forager",
    "reacher_forager_costly",
)}  # fmt: skip
"""Tasks of each simulator, with food and effort. Others are slow; those of gymnax compile for long."""


@pytest.mark.parametrize("file", marked(((file, None) for file in plays.NAMES), PLAYED))
def test_each_task_is_played_as_it_was(file: str) -> None:
    packages = {"atari": "ale_py", "mujoco": "mujoco", "gymnasium": "Box2D", "gymnax": "craftax"}
    package = packages.get(plays.settings_of(file)["habitat"]["name"])
    if package is not None:
        pytest.importorskip(package)
    if device.instruction_set() != PLAYS["instruction_set"]:
        pytest.skip(f"the plays are exact on {PLAYS['instruction_set']} only")
    assert plays.played(file) == PLAYS["plays"][file]


def assert_lives_as_it_did(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    if case.needs is not None:
        pytest.importorskip(case.needs)
    assert_lived_as_it_did(name, live(case, tmp_path))


def assert_lived_as_it_did(name: str, run: Run) -> None:
    case, golden = CASES[name], GOLDENS["cases"][name]
    if run.info()["versions"]["instruction_set"] != GOLDENS["instruction_set"]:
        pytest.skip(f"the goldens are exact on {GOLDENS['instruction_set']} only")
    actual = entries(case, run)
    differ = [each for each in golden | actual if actual.get(each) != golden.get(each)]
    assert not differ, description(name, differ, golden, actual)


def description(
    name: str, differ: list[str], golden: dict[str, Any], actual: dict[str, Any]
) -> str:
    """Describe which entries of a case differ, and how."""
    lines = [f"{each}: golden {golden.get(each)}, found {actual.get(each)}" for each in differ]
    return "\n  ".join([f"{name} differs in {', '.join(differ)}", *lines])
