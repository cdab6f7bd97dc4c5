"""The place for an experiment's jobs: this machine, or a Ray cluster."""

from pathlib import Path

from primordia import cores
from primordia.errors import InputError
from primordia.experiments.dispatch import Place
from primordia.experiments.here import Here
from primordia.experiments.on_ray import OnRay


def place_for(
    out: Path,
    left: int,
    jobs: int | None,
    ray: str | None,
    checkpoint_every: float = 60.0,
    device: str = "cpu",
) -> Place:
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
