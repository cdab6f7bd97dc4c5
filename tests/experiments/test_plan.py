"""Plans of experiments: what a file says, how arms are cut into jobs, and what is refused."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from primordia import files
from primordia.errors import InputError
from primordia.experiments import plan as plans
from primordia.experiments.campaign import begin, planned
from primordia.experiments.file import _of_runs, read
from primordia.experiments.job import configuration
from primordia.experiments.plan import Job
from tests.commands import complains, here
from tests.experiments.meadows import ARMS, write
from tests.worlds import MEADOW, MILL, config


def jobs(file: Path) -> list[Job]:
    return read(file, file.parent / "out").jobs()


@pytest.mark.parametrize(("seeds", "worlds"), [(7, 3), (12, 4)])
def test_each_world_of_an_arm_is_in_one_job(tmp_path: Path, seeds: int, worlds: int) -> None:
    plan = read(write(tmp_path, seeds=seeds, jobs={"worlds": worlds}), tmp_path / "out")
    for arm in ("mild", "harsh"):
        parts = [configuration(plan, job) for job in plan.jobs() if job.arm == arm]
        lived = [seed for part in parts for seed in part.world_seeds.tolist()]
        assert lived == list(range(3, 3 + seeds))
        assert max(part.seeds for part in parts) == min(worlds, seeds)
    folders = [job.folder for job in plan.jobs()]
    assert len(set(folders)) == len(folders)


@pytest.mark.parametrize(
    ("seeds", "names"),
    [(10, ["0-4", "5-9"]), (11, ["00-04", "05-09", "10"]), (5, ["0-4"])],
)
def test_numbers_in_folders_of_jobs_have_as_many_digits_as_the_last_world(
    tmp_path: Path, seeds: int, names: list[str]
) -> None:
    got = jobs(write(tmp_path, seeds=seeds, jobs={"worlds": 5}, arms=ARMS[:1]))
    assert [job.folder for job in got] == [f"mild/{name}" for name in names]


def test_arms_of_different_sizes_take_turns_until_one_has_no_more(
    tmp_path: Path,
) -> None:
    arms = [{"name": "few", "seeds": 1}, {"name": "many", "seeds": 5}, {"name": "some"}]
    chosen = begin(write(tmp_path, arms=arms), tmp_path / "out")
    assert [(job.number, job.folder, job.first, job.worlds) for job in chosen.left()] == [
        (0, "few/0", 0, 1), (1, "many/0-1", 0, 2), (4, "some/0-1", 0, 2), (2, "many/2-3", 2, 2),
        (5, "some/2", 2, 1), (3, "many/4", 4, 1),
    ]  # fmt: skip
    assert [job.number for job in chosen.jobs] == [*range(6)]


def test_a_job_has_ten_worlds_in_jax_and_one_on_the_host(tmp_path: Path) -> None:
    assert read(write(tmp_path, jobs=None), tmp_path / "out").worlds == 10
    arms = [{"name": "a", "habitat": {"name": "tests.toys:Mirror", "inner": "mill"}}]
    assert read(write(tmp_path, jobs=None, arms=arms), tmp_path / "out").worlds == 1


def test_the_largest_number_of_jobs_is_allowed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two arms of 3 worlds are 4 jobs of up to 2 worlds."""
    monkeypatch.setattr(plans, "LARGEST", 4)
    begin(write(tmp_path), tmp_path / "out")
    monkeypatch.setattr(plans, "LARGEST", 3)
    with pytest.raises(InputError, match="4 jobs are more than 3"):
        plans.recorded(tmp_path / "out")


def test_a_plan_is_read_as_it_was_written(tmp_path: Path) -> None:
    """An empty folder may become that of an experiment."""
    (tmp_path / "out").mkdir()
    plan = begin(write(tmp_path), tmp_path / "out").plan
    assert plans.recorded(tmp_path / "out") == plan
    assert begin(tmp_path / "out").plan == plan


def test_processes_may_begin_an_experiment_at_the_same_moment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While one has written its plan under a temporary name, another begins and ends."""
    out, plan, sync = tmp_path / "out", read(write(tmp_path), tmp_path / "out"), files.sync

    def meanwhile(path: Path) -> None:
        if path.name.startswith(files.TEMPORARY):
            monkeypatch.setattr(files, "sync", sync)
            monkeypatch.setattr("os.getpid", lambda: 7)
            begin(write(tmp_path), out)
        sync(path)

    monkeypatch.setattr(files, "sync", meanwhile)
    plans.write(plan, out)
    assert plans.recorded(out) == plan
    assert [each.name for each in out.iterdir()] == ["experiment.toml"]


def test_words_of_a_question_may_change_and_settings_may_not(tmp_path: Path) -> None:
    out = tmp_path / "out"
    begin(write(tmp_path), out)
    begin(write(tmp_path, question="Another one?", jobs=None), out)
    begin(write(tmp_path, about="a mill, in other words"), out)
    kept = plans.recorded(out)
    assert (kept.question, kept.arms[0].settings["about"]) == ("Is it mild?", ""), "the first ones"
    other: list[dict[str, Any]] = [{"name": "mild"}, {"name": "harsh", "hazard": 0.5}]
    for changes, words in [
        ({"arms": other}, "arms.harsh.hazard is 0.05 there, and 0.5 here"),
        ({"jobs": {"worlds": 3}}, "worlds is 2 there, and 3 here"),
        ({"stop": {"ticks": 400}}, "stop.ticks is 300 there, and 400 here"),
    ]:
        with pytest.raises(InputError, match=f"holds another experiment: .*{words}"):
            begin(write(tmp_path, **changes), out)


def test_further_arms_come_last_and_change_nothing_else(tmp_path: Path) -> None:
    out, third = tmp_path / "out", {"name": "third", "hazard": 0.2}
    before = begin(write(tmp_path), out)
    planned(file := write(tmp_path, question="And this?", arms=[*ARMS, third]), out)
    assert plans.recorded(out) == before.plan, "a look changes nothing"
    after = begin(file, out)
    kept = plans.recorded(out)
    assert (kept.arms[:2], kept.question) == (before.plan.arms, before.plan.question)
    assert kept.arms[2].config.hazard == 0.2
    assert (after.jobs[:4], [job.arm for job in after.jobs[4:]]) == (before.jobs, ["third"] * 2)
    complains(
        here("experiment", write(tmp_path), "--out", out),
        2,
        "the arms mild, harsh, third; write them first",
    )
    for arms in (ARMS[::-1], [third, *ARMS, {"name": "x"}], [*ARMS, {"name": "x"}, third]):
        words = "the arms mild, harsh, third; write them first in this order"
        with pytest.raises(InputError, match=words):
            begin(write(tmp_path, arms=arms), out)
    changed = [{**ARMS[0], "hazard": 0.3}, ARMS[1], third, {"name": "x"}]
    with pytest.raises(InputError, match=r"arms\.mild\.hazard is 0\.01 there, and 0.3 here"):
        begin(write(tmp_path, arms=changed), out)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"arms": [{"name": "a"}, {"name": "a"}]}, "'a' cannot name an arm, or names two arms"),
        ({"arms": [{"name": "experiment.toml"}]}, "'experiment.toml' cannot name an arm"),
        ({"arms": [{"name": "a/b"}]}, "arm 'a/b': name"),
        ({"arms": [{"name": ".."}]}, "arm '..': name"),
        ({"arms": [{"hazard": 0.1}]}, "table has no `name`"),
        ({"arms": []}, "arms: list should have at least 1 item"),
        ({"arms": "heredity"}, "arms: input should be a valid list, not 'heredity'"),
        ({"questions": "?"}, "there is no setting 'questions'; did you mean 'question'?"),
        ({"sees": 3}, "there is no setting 'sees'; did you mean 'seeds'?"),
        ({"question": 3}, "question: input should be a valid string, not 3"),
        ({"jobs": {"world": 3}}, "there is no setting 'jobs.world'; did you mean 'jobs.worlds'?"),
        ({"jobs": {"worlds": 0}}, "jobs.worlds: "),
        ({"jobs": {"worlds": 1}, "seeds": 60_000}, "120,000 jobs are more than 100,000"),
        ({"task": None}, "`task` is missing"),
        ({"task": "CartPole-survivl"}, "did you mean 'CartPole-survival'?"),
        ({"arms": [{"name": "a", "task": "Pong-survival"}]}, "arm 'a' has another task"),
        ({"arms": [{"name": "a", "hazrd": 0.1}]}, "arm 'a': .*did you mean 'hazard'?"),
        ({"arms": [{"name": "a", "hazard": 2.0}]}, "arm 'a': .*hazard"),
        ({"fork": {"of": "none", "at": 5}}, "none is not a run"),
        ({"fork": {"at": 5}}, "fork.of is missing"),
        ({"fork": {"of": "mills/mild", "at": 0}}, "fork.at: "),
        ({"fork": 0}, "fork: input should be a valid"),
        ({"jobs": 0}, "jobs: input should be a valid"),
    ],
)  # fmt: skip
def test_a_wrong_file_is_one_clear_line(
    tmp_path: Path, changes: dict[str, Any], words: str
) -> None:
    done = here("experiment", write(tmp_path, **changes), "--out", tmp_path / "out")
    complains(done, 2, str(tmp_path), *words.split(".*"))
    assert not (tmp_path / "out").exists()


def test_a_wrong_request_is_one_clear_line(tmp_path: Path) -> None:
    file, out = write(tmp_path), tmp_path / "out"

    def asked(*words: object) -> Any:
        return here("experiment", file, "--out", out, *words)

    assert "0 of 4 jobs done" in asked("--status").stdout
    assert not out.exists()
    several = "--jobs", 2, "--only", "mild", "--ray"
    complains(asked("--job", 1, *several), 2, "leave out --jobs and --only and --ray")
    complains(asked("--job", "4"), 2, f"{out} has no job 4; the jobs are 0 to 3")
    complains(asked("--only", "mlid"), 2, "there is no arm 'mlid'; the arms are mild, harsh")
    complains(asked("--json"), 2, "--json needs --status")
    complains(here("experiment", tmp_path / "none.toml"), 2, "none.toml cannot be read")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "a").touch()
    complains(here("experiment", file, "--out", tmp_path / "full"), 2, "is not an experiment")
    assert (tmp_path / "full" / "a").exists()


def test_a_fork_of_runs_has_all_their_worlds_and_their_own_ancestors(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run keeps its ancestors in its directory; the runs have different numbers of worlds.

    Worlds after a gap between the seeds would go on with other seeds than they had.
    """
    worlds = {tmp_path / "a": (5, 2), tmp_path / "b": (7, 3)}
    ancestors = {"ancestors": ("a.safetensors", "b.safetensors")}
    configs = {
        path: config(MEADOW, seed=seed, seeds=seeds).model_copy(update=ancestors)
        for path, (seed, seeds) in worlds.items()
    }
    arm = SimpleNamespace(paths=tuple(worlds))
    monkeypatch.setattr("primordia.experiments.file.opening.opened", lambda places: arm)
    archives = {path: SimpleNamespace(config=each) for path, each in configs.items()}
    monkeypatch.setattr("primordia.experiments.file.Archive", archives.get)
    settings, runs = _of_runs(tmp_path)
    assert (settings["seed"], settings["seeds"]) == (5, 5)
    assert settings["ancestors"] == [str(tmp_path / "a" / f"{name}.safetensors") for name in "ab"]
    assert runs == [(tmp_path / "a", 2), (tmp_path / "b", 3)]
    archives[tmp_path / "b"].config = config(MEADOW, seed=8)
    with pytest.raises(InputError, match="no world of seed 7, but one of 8; an arm has successive"):
        _of_runs(tmp_path)
    sent = {tmp_path / "a": Path("sent.zip"), tmp_path / "b": tmp_path / "b"}
    monkeypatch.setattr("primordia.experiments.file.bundle.origin_of", sent.get)
    with pytest.raises(InputError, match=r"sent.zip is a bundle; make it a run again"):
        _of_runs(tmp_path)


def test_a_fork_has_the_jobs_and_settings_of_its_source(tmp_path: Path) -> None:
    """The source has its settings from its file, or, once it has begun, from its plan."""
    source = write(tmp_path, "one")
    fork = {"of": "one/harsh", "at": 150}
    other = {"question": "And then?", "arms": [{"name": "same"}, {"name": "safe", "hazard": 0.0}]}
    names = ("task", "seed", "seeds", "replication", "saturation_ticks", "hazard", "brain", "jobs")
    longer = {**dict.fromkeys(names), "stop": {"ticks": 400}}
    file = write(tmp_path, "two", fork=fork, **other, **longer)
    plan = read(file, tmp_path / "runs" / "two")
    assert [arm.config.hazard for arm in plan.arms] == [0.05, 0.0]
    assert [arm.config.stop.ticks for arm in plan.arms] == [400, 400], "of the fork's file"
    assert [(job.folder, job.source) for job in plan.jobs()][:2] == [
        ("same/0-1", "../one/harsh/0-1"),
        ("same/2", "../one/harsh/2"),
    ]
    begin(source, tmp_path / "runs" / "one")
    arms = [{"name": "harsh"}, {"name": "harsher", "hazard": 0.5}]
    write(tmp_path, "one", hazard=0.25, jobs={"worlds": 1}, arms=arms)
    assert read(file, tmp_path / "runs" / "two") == plan
    changed = read(file, tmp_path / "elsewhere" / "two")
    assert changed.arms[0].config.hazard == 0.25
    assert [job.source for job in changed.jobs()][:3] == [f"../one/harsh/{n}" for n in range(3)]
    for name, value in {"task": "mill.toml", "seeds": 3, "cells": 24}.items():
        arm = {"arms": [{"name": "same"}, {"name": "safe", name: value}]}
        for place in ({**other, name: value}, arm):
            file = write(tmp_path, "two", fork=fork, **{**dict.fromkeys(names), **place})
            with pytest.raises(InputError, match="takes task, seeds and cells from one/harsh"):
                read(file, tmp_path / "runs" / "two")


@pytest.mark.parametrize(
    ("first", "then", "says"),
    [
        ("fork", "later", "fork.at is 150 there, and 160 here"),
        ("fork", "none", "fork.at is 150 there, and missing here"),
        ("none", "fork", "fork.at is missing there, and 150 here"),
    ],
)
def test_a_fork_may_not_be_changed_added_or_removed(
    first: str, then: str, says: str, tmp_path: Path
) -> None:
    """All settings and the numbers of worlds are equal with and without the fork."""
    write(tmp_path, "one")
    own = dict.fromkeys(("task", "seeds"))
    kinds: dict[str, dict[str, Any]] = {
        "fork": {"fork": {"of": "one/mild", "at": 150}, **own},
        "later": {"fork": {"of": "one/mild", "at": 160}, **own},
        "none": {},
    }
    out = tmp_path / "runs" / "two"
    begin(write(tmp_path, "two", **kinds[first]), out)
    with pytest.raises(InputError, match=f"holds another experiment: {says}"):
        begin(write(tmp_path, "two", **kinds[then]), out)


@pytest.mark.parametrize("names", [["one"], ["one", "two", "three"]])
def test_experiments_do_not_fork_each_other_in_a_circle(names: list[str], tmp_path: Path) -> None:
    for name, other in zip(names, [*names[1:], names[0]], strict=True):
        (tmp_path / f"{name}.toml").write_text(
            f"fork = {{ of = '{other}/a', at = 3 }}\nstop = {{ ticks = 9 }}\narms = [{{ name = 'a' }}]"
        )
    done = here("experiment", tmp_path / "one.toml", "--out", tmp_path / "out")
    complains(done, 2, "one.toml is a fork of itself")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("task", "name"),
    [("mill.toml", MILL["task"]), ("CartPole-survival", "CartPole-survival")],
)
def test_all_arms_have_the_name_of_their_task(task: str, name: str, tmp_path: Path) -> None:
    """A task in a file is named in this file."""
    for arms in (ARMS, [{**arm, "task": task} for arm in ARMS]):
        plan = read(write(tmp_path, brain=None, task=task, arms=arms), tmp_path / "out")
        assert [arm.config.task for arm in plan.arms] == [name] * 2
