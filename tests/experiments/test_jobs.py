"""Jobs: wherever, in whatever order and however often cut off they are lived, each world is the same."""

import csv
import os
import shutil
import signal
from pathlib import Path

import pytest

import primordia
from primordia.experiments import here as on_cores
from primordia.experiments import job as jobs
from primordia.experiments.campaign import Campaign, begin
from primordia.experiments.plan import Ending
from primordia.runs import directory, loop
from tests.commands import complains, here
from tests.experiments.meadows import write
from tests.worlds import digests_of


def digests_of_arms(experiment: Campaign) -> dict[str, list[str]]:
    """Return the digests of the worlds of each arm."""
    told = primordia.load(experiment.path).info()
    assert told["jobs"] == {"done": len(experiment.jobs), "running": 0, "failed": 0, "waiting": 0}
    return {arm["name"]: [world["digest"] for world in arm["worlds"]] for arm in told["arms"]}


@pytest.fixture(scope="module")
def apart(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[str]]:
    """Return the digests of each arm's worlds, each lived beside another one than in its job.

    Jobs have two worlds. Here runs have two worlds too, and the first begins one world earlier.
    """
    folder = tmp_path_factory.mktemp("apart")
    found: dict[str, list[str]] = {}
    for arm in begin(write(folder, seeds=4), folder / "out").plan.arms:
        for first in (-1, 1, 3):
            own = {"seed": arm.config.seed + first, "seeds": 2}
            run = folder / f"{arm.name}-{first}"
            loop.start(arm.config.model_copy(update=own), run)
            found.setdefault(arm.name, []).extend(digests_of(run))
        found[arm.name] = found[arm.name][1:-1]
    return found


def test_what_a_kill_leaves_is_taken_up(tmp_path: Path, apart: dict[str, list[str]]) -> None:
    """A folder in which a run was about to begin, and a run in the middle of its life.

    The processes of the next test find the code of these jobs.
    """
    chosen = begin(write(tmp_path, seeds=4), tmp_path / "out")
    half = chosen.path / chosen.jobs[0].folder
    (half / "births").mkdir(parents=True)
    (half / "config.toml").write_text("begun")
    (half / directory.UNBEGUN).touch()
    config = jobs.configuration(chosen.plan, chosen.jobs[1])
    part = config.model_copy(update={"stop": config.stop.model_copy(update={"ticks": 77})})
    loop.start(part, chosen.path / chosen.jobs[1].folder)
    for job in chosen.jobs:
        assert jobs.ending_of(chosen.plan, job, chosen.path) == Ending(job.number, "done")
    assert digests_of_arms(begin(chosen.path)) == apart


def test_an_experiment_is_run_once_though_processes_die(
    tmp_path: Path, apart: dict[str, list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each of the first two processes is killed as soon as it is there, before it compiles anything.
    The third one lives both jobs."""
    started, begun = on_cores.Here._started, []

    def dying(self: on_cores.Here) -> object:
        worker = started(self)
        begun.append(worker)
        if len(begun) <= 2:
            os.kill(worker.pid, signal.SIGKILL)
        return worker

    monkeypatch.setattr(on_cores.Here, "_started", dying)
    file, out = write(tmp_path, seeds=2), tmp_path / "out"
    done = here("experiment", file, "--out", out, "--jobs", 1)
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("the job's process ended with status -9") == 2
    assert done.stderr.count("the job is tried again") == 2
    assert len(begun) == 3
    assert done.stdout.splitlines()[-3:] == [f"{out}/results.{end}" for end in ("md", "csv", "png")]
    assert digests_of_arms(begin(out)) == {name: digests[:2] for name, digests in apart.items()}
    rows = list(csv.DictReader((out / "results.csv").read_text().splitlines()))
    assert [(row["arm"], row["seed"]) for row in rows] == [
        (arm, str(seed)) for arm in ("mild", "harsh") for seed in (3, 4)
    ]
    assert (out / "results.md").read_text().startswith("# Is it mild?")
    before = {
        path: path.stat().st_mtime_ns for path in out.rglob("*") if "results" not in path.name
    }
    results = (out / "results.md").read_bytes()
    assert here("experiment", file, "--out", out).returncode == 0
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert (out / "results.md").read_bytes() == results


@pytest.mark.slow
def test_a_fork_goes_on_from_the_worlds_of_an_arm(tmp_path: Path) -> None:
    """Unchanged, it lives on as the arm would have."""
    folder, runs = tmp_path / "files", tmp_path / "runs"
    one = begin(write(folder, "one"), runs / "one")
    for job in one.jobs:
        jobs.live(one.plan, job, one.path)
    names = ("task", "seed", "seeds", "replication", "saturation_ticks", "hazard", "brain", "jobs")
    arms = [{"name": "same"}, {"name": "other", "seed": 40}, {"name": "safe", "hazard": 0.0}]
    fork = {"of": "one/harsh", "at": 150}
    file = write(folder, "two", fork=fork, arms=arms, **dict.fromkeys(names))
    two = begin(file, runs / "two")
    for job in two.jobs:
        jobs.live(two.plan, job, two.path)
    once, same, other, safe = (
        primordia.load(place)
        .table("deaths")
        .sort_by([("world", "ascending"), ("tick", "ascending")])
        for place in (runs / "one" / "harsh", *(runs / "two" / arm["name"] for arm in arms))
    )
    later = [row for row in once.to_pylist() if row["tick"] > 150]
    assert later
    assert sorted(map(str, same.to_pylist())) == sorted(map(str, later))
    assert "hazard" in same["cause"].to_pylist()
    assert "hazard" not in safe["cause"].to_pylist()
    assert len(other)
    assert other.to_pylist() != same.to_pylist()
    seeds = [world["seed"] for world in primordia.load(runs / "two" / "other").info()["worlds"]]
    assert seeds == [40, 41, 42]
    place = {"of": str(runs / "one" / "harsh"), "at": 150}
    by_place = begin(
        write(folder, "three", fork=place, arms=arms, **dict.fromkeys(names)), runs / "3"
    )
    assert by_place.plan.arms == two.plan.arms
    assert [job.worlds for job in by_place.jobs] == [job.worlds for job in two.jobs]


def test_the_status_tells_what_is_done_without_opening_a_run(tmp_path: Path) -> None:
    chosen = begin(write(tmp_path, seeds=4), tmp_path / "out")
    for job in chosen.jobs[:3]:
        jobs.live(chosen.plan, job, chosen.path)
    arms = {arm["name"]: arm["worlds"] for arm in primordia.load(chosen.path).info()["arms"]}
    for path in chosen.path.glob("*/*/checkpoints"):
        shutil.rmtree(path)
    told = begin(chosen.path).status()
    assert told.jobs == {"done": 3, "running": 0, "failed": 0, "waiting": 1}
    assert [(arm.begun, arm.worlds) for arm in told.arms] == [(4, 4), (2, 4)]
    for arm in told.arms:
        lives = sorted(world["organism_ticks"] / world["deaths"] for world in arms[arm.name])
        assert arm.life == (lives[(len(lives) - 1) // 2] + lives[len(lives) // 2]) / 2
        assert arm.life_interval is None
        assert arm.saturated == sum(world["saturation"] is not None for world in arms[arm.name])
    text = here("experiment", chosen.path, "--status").stdout
    assert "3 of 4 jobs done" in text
    shutil.rmtree(chosen.path / chosen.jobs[0].folder)
    assert begin(chosen.path).status().jobs["waiting"] == 2, "a run that was removed is not done"


def test_a_job_that_another_process_lives_is_left_to_it(tmp_path: Path) -> None:
    chosen = begin(write(tmp_path), tmp_path / "out")
    run = chosen.path / chosen.jobs[0].folder
    loop.start(jobs.configuration(chosen.plan, chosen.jobs[0]), run)
    with directory.locked(run):
        assert jobs.ending_of(chosen.plan, chosen.jobs[0], chosen.path).state == "elsewhere"
        complains(here("experiment", chosen.path, "--job", 0), 2, "run by another process")
