"""The figures of arms so far and the time left, from the states and counts of jobs alone."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

from primordia.errors import InputError
from primordia.experiments.ledger import Entry, Ledger, WorldCounts
from primordia.experiments.plan import ArmPlan, Job, Plan, recorded
from primordia.experiments.status import ArmStatus, _interval, status


@pytest.mark.parametrize("worlds", [5, 9, 100])
def test_the_interval_of_a_median_holds_it_as_often_as_promised(worlds: int) -> None:
    """Counted over samples of a law whose median is known."""
    draws = np.random.default_rng(worlds).exponential(size=(4000, worlds))
    intervals = [_interval(sample) or (np.nan, np.nan) for sample in draws]
    held = [low <= np.log(2) <= high for low, high in intervals]
    assert np.mean(held) > 0.93


def test_the_bounds_of_the_interval_are_equally_far_from_both_ends() -> None:
    """Of 20, 50 and 100 worlds, n / 2 - 0.98 sqrt(n) = 5.6, 18.1 and 40.2 lie outside."""
    assert _interval(np.arange(4.0)) is None
    for worlds, outside in ((5, 0), (20, 5), (50, 18), (100, 40)):
        lives = np.random.default_rng(worlds).permutation(worlds).astype(float)
        assert _interval(lives) == (outside, worlds - 1 - outside)


def test_each_arm_has_the_worlds_of_its_own_jobs() -> None:
    """Worlds of a failed job count too. The arms have different numbers of worlds."""

    def counts(deaths: int, lived: int, saturated: int | None) -> WorldCounts:
        return WorldCounts(
            seed=1, ticks=9, births=9, deaths=deaths, organism_ticks=lived, saturated=saturated
        )

    arms = tuple(
        ArmPlan(name=name, settings={"seeds": seeds})
        for name, seeds in (("one", 4), ("two", 7), ("none", 2))
    )
    failed = [counts(0, 70, None)]
    entries = [
        Entry(job=0, arm="one", state="done", worlds=[counts(2, 20, 5), counts(4, 400, None)]),
        Entry(job=1, arm="two", state="running", worlds=[counts(10, 30, 8)]),
        Entry(job=2, arm="none"),
        Entry(job=3, arm="one", state="failed", worlds=failed, error="full"),
        Entry(job=4, arm="two", state="done", worlds=[counts(1, number, 1) for number in range(5)]),
    ]
    plan = Plan(question="?", worlds=2, arms=arms)
    found = status(plan, entries, ("one", "two", "none"))
    assert found.jobs == {"done": 2, "running": 1, "failed": 1, "waiting": 1}
    assert found.arms == (
        ArmStatus("one", 4, 3, 1, 70.0, None),
        ArmStatus("two", 7, 6, 6, 2.5, (0.0, 4.0)),
        ArmStatus("none", 2, 0, 0, None, None),
    )
    assert status(plan, entries[1:2], ["two"]).arms == (ArmStatus("two", 7, 1, 1, 3.0, None),)
    assert [entry.job for entry in found.running] == [1]
    assert [(entry.job, entry.error) for entry in found.failed] == [(3, "full")]


ARM = {"name": "a", "settings": {"seeds": 2}}
DAMAGED: dict[str, list[dict[str, Any]]] = {
    "'a' cannot name an arm": [ARM, {**ARM, "name": "b"}, {**ARM, "name": "A"}],
    "'jobs' cannot name an arm": [{**ARM, "name": "jobs"}],
    "'results.csv' cannot name an arm": [ARM, {**ARM, "name": "Results.csv"}],
    "seeds of arm a must be a whole number": [{**ARM, "settings": {}}],
    "from 1 to 65536": [{**ARM, "settings": {"seeds": 2**16 + 1}}],
    "must be a whole number from 1": [{**ARM, "settings": {"seeds": 0}}],
    "seeds of arm b must be a whole number": [ARM, {"name": "b", "settings": {"seeds": True}}],
    "jobs are more than 100,000": [
        {"name": name, "settings": {"seeds": 2**16}} for name in ("a", "b")
    ],
}


def forked(seeds: int, *worlds: int) -> dict[str, Any]:
    """Return a plan of two arms that fork runs with these numbers of worlds."""
    sources = [{"run": f"run{number}", "worlds": each} for number, each in enumerate(worlds)]
    arms = [{"name": name, "settings": {"seeds": seeds}} for name in "ab"]
    return {"question": "?", "worlds": 1, "fork": {"at": 9, "sources": sources}, "arms": arms}


def test_a_fork_has_a_job_for_each_run_and_all_their_worlds(tmp_path: Path) -> None:
    """Two arms of the most worlds have 8 jobs, though jobs of one world would be too many."""
    file = tmp_path / "experiment.toml"
    file.write_text(tomli_w.dumps(forked(2**16, *[2**14] * 4)))
    assert len(recorded(tmp_path).jobs()) == 8
    for arm, seeds in (("a", 7), ("a", 9), ("b", 9)):
        plan = forked(8 if arm == "b" else seeds, 3, 5)
        plan["arms"][-1]["settings"] = {"seeds": seeds}
        file.write_text(tomli_w.dumps(plan))
        says = f"arm {arm} has {seeds} worlds, and the runs that it forks have 8"
        with pytest.raises(InputError, match=says):
            recorded(tmp_path)


@pytest.mark.parametrize("fault", DAMAGED)
def test_a_damaged_plan_is_one_line(fault: str, tmp_path: Path) -> None:
    plan = {"question": "?", "worlds": 1, "arms": DAMAGED[fault]}
    (tmp_path / "experiment.toml").write_text(tomli_w.dumps(plan))
    with pytest.raises(InputError, match=f"experiment.toml is damaged: .*{fault}"):
        recorded(tmp_path)


@pytest.mark.parametrize(
    "forged",
    [
        {"arm": "zzz"},
        {"job": 7},
        {"process": 2**70},
        {"rate": float("nan")},
        {"left_s": float("inf")},
        {"worlds": [{**dict.fromkeys(WorldCounts.model_fields, 1), "organism_ticks": 10**400}]},
    ],
    ids=lambda forged: next(iter(forged)),
)
def test_a_forged_entry_counts_as_none(forged: dict[str, Any], tmp_path: Path) -> None:
    job = Job(0, "a", 0, 1, "a/0")
    entry = {"job": 0, "arm": "a", "state": "failed", **forged}
    (tmp_path / "jobs").mkdir()
    (tmp_path / "jobs" / "000000.json").write_text(json.dumps(entry))
    assert Ledger(tmp_path, [job]).entry(job) == Entry(job=0, arm="a")
