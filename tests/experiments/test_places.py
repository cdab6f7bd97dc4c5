"""Jobs in processes of this machine or in tasks of a cluster: their options, and how they end."""

import json
import socket
import subprocess
import sys
import threading
from concurrent.futures import Future
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock, call, patch

import pytest

import primordia
from primordia import api
from primordia.errors import InputError, Trouble
from primordia.experiments import dispatch, on_ray
from primordia.experiments import job as jobs
from primordia.experiments import plan as plans
from primordia.experiments.campaign import Campaign
from primordia.experiments.dispatch import live_all
from primordia.experiments.here import PATIENCE, Here
from primordia.experiments.plan import Ending, Job
from tests.experiments.meadows import write

JOB = Job(3, "a", 0, 1, "a/0")


def fail(job: int, again: bool = False) -> Ending:
    return Ending(job, "failed", f"reason {job}", again)


class Place:
    """A place in which each job ends as foretold, try by try."""

    def __init__(self, *fates: list[Ending]) -> None:
        self.fates = fates

    def submit(self, job: Job) -> Future[Ending]:
        future: Future[Ending] = Future()
        future.set_result(self.fates[job.number].pop(0))
        return future

    def stop(self) -> None: ...


def test_each_job_that_might_succeed_is_tried_three_times() -> None:
    """Neither failures of other jobs count, nor signals to the job's own process. A job of another
    process is neither done nor failed."""
    told, looks, signal = list[tuple[int, bool]](), list[int](), Ending(0, "stopped")
    done, elsewhere = (lambda job: Ending(job, "done")), Ending(4, "elsewhere")
    place = Place(
        [signal, signal, *[fail(0, again=True)] * 4],
        [fail(1)] * 2,
        [fail(2, again=True), fail(2, again=True), done(2)],
        [fail(3, again=True), done(3)],
        [elsewhere] * 2,
    )
    result = live_all(
        [Job(number, "a", number, 1, f"a/{number}") for number in range(5)],
        place,
        lambda: looks.append(len(told)),
        lambda job, _, again: told.append((job.number, again)),
    )
    assert (result.done, result.elsewhere, result.stopped) == (2, 1, False)
    assert [ending.job for ending in result.failed] == [1, 0]
    assert [len(fates) for fates in place.fates] == [1, 1, 0, 0, 1]
    assert sorted(told) == [
        (0, False), (0, True), (0, True), (1, False), (2, True), (2, True), (3, True)
    ]  # fmt: skip
    assert looks[-1] == len(told), "also after the last job has ended"


@pytest.mark.parametrize(
    ("asked", "device", "left", "at_once"),
    [
        (None, "cpu", 9, 3),
        (None, "cpu", 2, 2),
        (None, "gpu", 9, 1),
        (5, "gpu", 9, 5),
    ],
)
def test_jobs_run_at_once_on_each_core_unless_a_number_is_given(
    asked: int | None, device: str, left: int, at_once: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PRIMORDIA_CORES", "3")
    made = MagicMock()
    monkeypatch.setattr(dispatch, "Here", made)
    dispatch.place_for(Path("out"), left, asked, None, 7.0, device)
    made.assert_called_once_with(Path("out"), at_once, 7.0, device)


def test_a_cluster_has_an_address_or_is_that_of_this_machine() -> None:
    with patch.object(dispatch, "OnRay") as made:
        for given, address in (("", None), ("host:1", "host:1")):
            dispatch.place_for(Path("out"), 4, None, given, 7.0, "gpu")
            assert made.call_args == call(Path("out"), 7.0, "gpu", address)
    with pytest.raises(InputError, match="--jobs is for jobs on this machine"):
        dispatch.place_for(Path("out"), 4, 1, "")


def test_a_process_gets_the_interval_of_checkpoints_and_the_device(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each process has one core. The log of an earlier command is kept."""
    opened = MagicMock()
    monkeypatch.setattr("primordia.experiments.here.subprocess.Popen", opened)
    (tmp_path / "workers.log").write_text("before\n")
    Here(tmp_path, 1, 7.5, "gpu")._started()
    (words,), options = opened.call_args
    assert words[-3:] == [str(tmp_path), "7.5", "gpu"]
    assert options["env"]["PRIMORDIA_CORES"] == "1"
    assert (tmp_path / "workers.log").read_text() == "before\n"


def test_each_process_is_stopped_and_those_that_take_too_long_are_killed(tmp_path: Path) -> None:
    """A process may have ended already. No process starts after the stop."""
    place = Here(tmp_path, 2, 7.0)
    gone, slow, _ = processes = [MagicMock() for _ in range(3)]
    gone.terminate.side_effect = ProcessLookupError
    slow.wait.side_effect = subprocess.TimeoutExpired("a job", PATIENCE)
    place._workers += processes
    place.stop()
    for each in processes:
        each.terminate.assert_called_once_with()
        each.wait.assert_called_once_with(PATIENCE)
        each.stdin.close.assert_called_once_with()
    assert [each.kill.called for each in processes] == [False, True, False]
    assert place._live(JOB) == Ending(3, "stopped")
    assert place._workers == processes


def test_two_jobs_run_at_once_each_in_a_process_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two processes live four jobs. A process answers when both were asked."""
    both, begun = threading.Barrier(2, timeout=30), list[list[int]]()

    def started(_: Here) -> Any:
        begun.append(asked := [])
        worker = MagicMock()
        worker.poll.return_value = None
        worker.stdin.write.side_effect = lambda text: asked.append(int(text))

        def answer() -> str:
            both.wait()
            return json.dumps({"job": asked[-1], "state": "done"})

        worker.stdout.readline.side_effect = answer
        return worker

    monkeypatch.setattr(Here, "_started", started)
    place = Here(tmp_path, 2, 7.0)
    endings = [place.submit(Job(number, "a", number, 1, f"a/{number}")) for number in range(4)]
    assert [each.result() for each in endings] == [Ending(n, "done") for n in range(4)]
    assert [len(asked) for asked in begun] == [2, 2]
    place.stop()


@pytest.fixture
def ray(monkeypatch: pytest.MonkeyPatch) -> MagicMock:
    """Return a Ray that is connected to a cluster whose nodes see all folders."""
    made = MagicMock()
    monkeypatch.setattr(on_ray, "_connected", lambda address: made)
    monkeypatch.setattr(on_ray, "_check_folder", lambda *_: None)
    return made


@pytest.mark.parametrize(("device", "gpus"), [("cpu", 0), ("gpu", 1)])
def test_a_task_of_a_cluster_has_one_core_and_a_gpu_if_asked(
    device: str, gpus: int, ray: MagicMock, tmp_path: Path
) -> None:
    place = on_ray.OnRay(tmp_path, 7.0, device)
    options = ray.remote.return_value.options
    assert (options.call_args[1]["num_cpus"], options.call_args[1]["num_gpus"]) == (1, gpus)
    place.submit(JOB)
    options.return_value.remote.assert_called_once_with(3, str(tmp_path), 7.0, device)


def test_only_tasks_that_have_not_ended_are_stopped(
    ray: MagicMock, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = Future[Any]()
    ended.set_result((3, "done"))
    refs = [MagicMock() for _ in range(3)]
    for ref, future in zip(refs, (Future(), ended, Future()), strict=True):
        ref.future.return_value = future
    monkeypatch.setattr(on_ray, "PATIENCE", 0.0)
    place = on_ray.OnRay(tmp_path, 7.0)
    ray.remote.return_value.options.return_value.remote.side_effect = refs
    assert [place.submit(JOB).done() for _ in refs] == [False, True, False]
    place.stop()
    assert ray.cancel.call_args_list == [call(refs[0]), call(refs[2])]
    ray.shutdown.assert_called_once_with()


@pytest.mark.parametrize(
    ("one", "last", "says"),
    [
        (True, True, ""),
        (False, True, "node 10.0.0.1 does not see OUT; choose an --out in a folder"),
        (True, ValueError("lost\nin space"),
         r"10.0.0.3 gave no answer \(ValueError: lost\) when asked whether it sees OUT; choose"),
    ],
    ids=["both", "one", "no answer"],
)  # fmt: skip
def test_each_node_that_is_alive_is_asked_whether_it_sees_the_folder(
    one: Any, last: Any, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The node looks for a file in the folder, and this file is removed in any case."""
    answers, ray = {"1": one, "3": last}, MagicMock()
    ray.nodes.return_value = [
        {"NodeID": each, "Alive": each != "2", "NodeManagerAddress": f"10.0.0.{each}"}
        for each in "123"
    ]

    def get(answer: Any, timeout: float) -> bool:
        if isinstance(answer, Exception):
            raise answer
        return bool(answer)

    def options(num_cpus: int, scheduling_strategy: str) -> Any:
        node = scheduling_strategy
        return SimpleNamespace(remote=lambda path: on_ray._sees(path) and answers.pop(node))

    ray.get, ray.remote.return_value.options, ray.exceptions.RayError = get, options, ValueError
    strategies = SimpleNamespace(NodeAffinitySchedulingStrategy=lambda node, soft: node)
    monkeypatch.setitem(sys.modules, "ray.util.scheduling_strategies", strategies)
    if says:
        with pytest.raises(InputError, match=says.replace("OUT", str(tmp_path))):
            on_ray._check_folder(ray, tmp_path)
    else:
        on_ray._check_folder(ray, tmp_path)
        assert not answers
    assert ray.shutdown.called == bool(says)
    assert not list(tmp_path.iterdir())


def test_an_address_with_a_port_is_tried_before_ray_tries_it() -> None:
    """`auto` and no address are left to Ray."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        there = f"127.0.0.1:{server.getsockname()[1]}"
        for address in (there, f"ray://{there}", "auto", "", None):
            on_ray._check_address(address)
    for address in (there, f"ray://{there}", "host:", "host:99999999999"):
        with pytest.raises(InputError, match=f"no cluster answers at {address}: "):
            on_ray._check_address(address)
    with patch("primordia.experiments.on_ray.socket.create_connection") as connected:
        on_ray._check_address("ray://[2001:db8::1]:10001")
    connected.assert_called_once_with(("2001:db8::1", 10001), on_ray.CONNECT)


@pytest.mark.parametrize(
    ("address", "what"),
    [("auto", "no cluster can be reached at auto"), (None, "Ray cannot start")],
)
def test_a_ray_that_does_not_answer_or_start_is_one_line(
    address: str | None, what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    ray = MagicMock()
    ray.init.side_effect = ConnectionError("\nno reason\nmore")
    monkeypatch.setitem(sys.modules, "ray", ray)
    with pytest.raises(InputError, match=f"^--ray: {what}: no reason$"):
        on_ray._connected(address)


@pytest.mark.parametrize(
    ("held", "state", "seconds"),
    [(2, "failed", 2), (200, "elsewhere", on_ray.RELEASE + 1)],
)
def test_a_task_waits_for_the_lock_of_a_dead_node_for_a_while(
    held: int, state: Any, seconds: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now, tries = [0.0], list[Any]()

    def ending_of(plan: Any, job: Job, *words: Any) -> Ending:
        tries.append(words)
        return Ending(job.number, "elsewhere" if len(tries) <= held else state)

    def sleep(length: float) -> None:
        now[0] += length

    monkeypatch.setattr(on_ray, "time", SimpleNamespace(monotonic=lambda: now[0], sleep=sleep))
    monkeypatch.setattr(jobs, "ending_of", ending_of)
    monkeypatch.setattr(
        plans, "recorded", lambda out: SimpleNamespace(jobs=lambda: [None, None, None, JOB])
    )
    assert on_ray._live(3, str(tmp_path), 7.0, "gpu") == Ending(3, state)
    assert now == [seconds]
    assert set(tries) == {(tmp_path, 7.0, "gpu")}


def test_a_task_that_a_cluster_loses_is_a_failure_of_its_job() -> None:
    done: Future[Any] = Future()
    done.set_result((3, "failed", "full", False))
    assert on_ray._ending(JOB, done) == Ending(3, "failed", "full", again=False)
    lost: Future[Any] = Future()
    lost.set_exception(RuntimeError("the node died\nand more"))
    assert on_ray._ending(JOB, lost) == Ending(3, "failed", "RuntimeError: the node died")


def test_python_raises_the_first_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = Place([Ending(0, "done")], [fail(1)], [Ending(2, "elsewhere")], [fail(3)])
    monkeypatch.setattr(api, "place_for", lambda *_: place)
    with pytest.raises(Trouble, match="failed jobs: 2; job 1: reason 1"):
        primordia.experiment(write(tmp_path), tmp_path / "out")


def test_python_passes_its_options_to_the_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only jobs of the named arm run. Jobs of the other arm are left, so no results are written."""
    place = Place(*[[Ending(number, "done")] for number in range(4)])
    asked, looks = MagicMock(return_value=place), list[dict[str, int]]()
    gathered = MagicMock()
    monkeypatch.setattr(api, "place_for", asked)
    monkeypatch.setattr(Campaign, "gather", gathered)
    out = tmp_path / "out"
    primordia.experiment(
        write(tmp_path), out, jobs=5, only=["harsh"], ray="r", checkpoint_every=7.0, device="gpu",
        look=lambda status: looks.append(status.jobs),
    )  # fmt: skip
    asked.assert_called_once_with(out, 2, 5, "r", 7.0, "gpu")
    assert looks[-1] == {"done": 0, "running": 0, "failed": 0, "waiting": 4}
    gathered.assert_not_called()
