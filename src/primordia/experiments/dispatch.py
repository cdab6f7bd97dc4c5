"""The loop over jobs: a free process takes the next job, and a job that fails is tried again."""

import queue
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path

from primordia import cores, interrupts
from primordia.errors import InputError
from primordia.experiments.here import Here
from primordia.experiments.on_ray import OnRay
from primordia.experiments.plan import Ending, Job

ATTEMPTS = 3
"""Number of times that a job is tried."""
MOMENT = 0.5
"""Seconds between two readings of the jobs' states."""


def place_for(
    out: Path,
    left: int,
    jobs: int | None,
    ray: str | None,
    checkpoint_every: float = 60.0,
    device: str = "cpu",
) -> Here | OnRay:
    """Return a place for jobs.

    Args:
        out: the experiment's directory.
        left: number of jobs still to run.
        jobs: number of jobs that run at once on this machine; None: one for each core, or a single
            job on `gpu`, where each job takes all GPUs.
        ray: address of a Ray cluster; "": this machine's cluster, or a new cluster; None: the jobs
            run without a cluster.
        checkpoint_every: seconds from one checkpoint to the next.
        device: the device that computes the jobs, `cpu` or `gpu`.

    Raises:
        InputError: the cluster cannot be used.
    """
    if ray is None:
        at_a_time = jobs or (cores.count() if device == "cpu" else 1)
        return Here(out, min(at_a_time, left), checkpoint_every, device)
    if jobs is not None:
        raise InputError(
            "--jobs is for jobs on this machine; with --ray each core of the cluster runs a job, so"
            " leave out --jobs"
        )
    return OnRay(out, checkpoint_every, device, ray or None)


@dataclass
class Result:
    """The outcomes of all jobs."""

    done: int = 0
    failed: list[Ending] = field(default_factory=list)
    elsewhere: int = 0
    """number of jobs that another process runs"""
    stopped: bool = False
    """whether a signal came before the end"""


def live_all(
    jobs: list[Job],
    place: Here | OnRay,
    look: Callable[[], object],
    failed: Callable[[Job, Ending, bool], object],
) -> Result:
    """Run jobs, and stop early if a signal comes.

    Args:
        jobs: the jobs to run, in this order.
        place: where the jobs run.
        look: a function that is called about twice a second.
        failed: a function that is called with each job that fails, its ending, and whether the job
            will be tried again.
    """
    ended: queue.SimpleQueue[tuple[Job, Future[Ending]]] = queue.SimpleQueue()
    result, failures = Result(), Counter[int]()

    def submit(job: Job) -> None:
        place.submit(job).add_done_callback(lambda future: ended.put((job, future)))

    with interrupts.noting() as noted, interrupts.deferred():
        try:
            for job in jobs:
                submit(job)
            while len(jobs) > result.done + len(result.failed) + result.elsewhere and not noted:
                look()
                for job, ending in _ended(ended):
                    if ending.state == "failed":
                        failures[job.number] += 1
                        again = ending.again and failures[job.number] < ATTEMPTS
                        failed(job, ending, again)
                        if again:
                            submit(job)
                        else:
                            result.failed.append(ending)
                    if ending.state == "stopped" and not noted:
                        submit(job)  # only the job's process got a signal
                    result.done += ending.state == "done"
                    result.elsewhere += ending.state == "elsewhere"
        finally:
            place.stop()
        result.stopped = bool(noted)
    look()
    return result


def _ended(ended: queue.SimpleQueue) -> list[tuple[Job, Ending]]:
    """Return the jobs that have ended; wait up to MOMENT for the first."""
    found = []
    try:
        found.append(ended.get(timeout=MOMENT))
        while True:
            found.append(ended.get_nowait())
    except queue.Empty:
        return [(job, future.result()) for job, future in found]
