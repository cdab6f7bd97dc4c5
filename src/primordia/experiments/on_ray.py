"""Jobs as tasks of a Ray cluster (Moritz et al. 2018) whose nodes all see the experiment's folder.

Ray places the tasks. If a node dies, Ray begins its tasks again, and they go on from their newest
checkpoints.
"""

import logging
import os
import socket
import sys
import time
import uuid
from concurrent.futures import Future, wait
from contextlib import suppress
from pathlib import Path
from typing import Any

from primordia import cores
from primordia.errors import InputError
from primordia.experiments.plan import Ending, Job

PATIENCE = 30.0
"""Seconds that jobs have for their checkpoints when they must stop."""
RELEASE = 120.0
"""Seconds to wait for the lock of a run after its node has died."""
CONNECT = 5.0
"""Longest time for a cluster's answer, in seconds."""
ANSWER = 60.0
"""Longest time for a node's answer, in seconds."""


class OnRay:
    """Tasks on a Ray cluster; each has one core, and one GPU if the device is `gpu`."""

    def __init__(
        self, out: Path, checkpoint_every: float, device: str = "cpu", address: str | None = None
    ) -> None:
        """Connect to a cluster.

        Args:
            out: the experiment's directory.
            checkpoint_every: seconds from one checkpoint to the next.
            device: the device that computes the jobs, `cpu` or `gpu`.
            address: address of the cluster; None: this machine's cluster, or a new cluster on this
                machine alone.

        Raises:
            InputError: Ray is not installed, the cluster cannot be reached, or a node does not see `out`.
        """
        self._ray = _connected(address)
        self._arguments = str(out.resolve()), checkpoint_every, device
        _check_folder(self._ray, out.resolve())
        self._task = self._ray.remote(_live).options(
            num_cpus=1, num_gpus=int(device == "gpu"), max_retries=-1, scheduling_strategy="SPREAD"
        )
        self._refs: list[Any] = []
        self._futures: list[Future[Ending]] = []

    def submit(self, job: Job) -> Future[Ending]:
        """Run a job as soon as a node has a free core."""
        future: Future[Ending] = Future()
        ref = self._task.remote(job.number, *self._arguments)
        ref.future().add_done_callback(lambda done: future.set_result(_ending(job, done)))
        self._refs.append(ref)
        self._futures.append(future)
        return future

    def stop(self) -> None:
        """Stop all tasks, each after a checkpoint if there is time, and leave the cluster."""
        left = [
            ref for ref, future in zip(self._refs, self._futures, strict=True) if not future.done()
        ]
        for ref in left:
            self._ray.cancel(ref)
        wait(self._futures, PATIENCE)
        self._ray.shutdown()


def _connected(address: str | None) -> Any:
    try:
        import ray
    except ImportError:
        raise InputError("--ray needs Ray: pip install 'primordia[ray]'") from None
    _check_address(address)
    variables = {cores.VARIABLE: "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    try:
        ray.init(
            address,
            runtime_env={"env_vars": variables},
            log_to_driver=False,
            logging_level=logging.ERROR,
        )
    except (ConnectionError, RuntimeError, ValueError, TimeoutError) as error:
        first = str(error).strip().partition("\n")[0]
        what = "Ray cannot start" if address is None else f"no cluster can be reached at {address}"
        raise InputError(f"--ray: {what}: {first}") from None
    return ray


def _check_address(address: str | None) -> None:
    """Raise InputError unless a server answers at `host:port`, since Ray would try for minutes."""
    host, colon, port = (address or "").removeprefix("ray://").rpartition(":")
    if not colon:
        return
    try:
        socket.create_connection((host.strip("[]"), int(port)), CONNECT).close()
    except (OSError, ValueError, OverflowError) as error:
        raise InputError(f"--ray: no cluster answers at {address}: {error}") from None


def _check_folder(ray: Any, out: Path) -> None:
    """Raise InputError unless all nodes see the folder."""
    from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

    mark = out / f".seen-{uuid.uuid4().hex}"
    mark.touch()
    try:
        seen, nodes = ray.remote(_sees), [node for node in ray.nodes() if node["Alive"]]
        for node in nodes:
            there = NodeAffinitySchedulingStrategy(node["NodeID"], soft=False)
            answer = seen.options(num_cpus=0, scheduling_strategy=there).remote(str(mark))
            try:
                if ray.get(answer, timeout=ANSWER):
                    continue
                fault = "does not see"
            except ray.exceptions.RayError as error:
                first = str(error).strip().partition("\n")[0]
                fault = (
                    f"gave no answer ({type(error).__name__}: {first}) when asked whether it sees"
                )
            ray.shutdown()
            raise InputError(
                f"--ray: node {node['NodeManagerAddress']} {fault} {out}; choose an --out in a"
                " folder that all nodes share"
            )
    finally:
        mark.unlink()


def _sees(path: str) -> bool:
    return Path(path).exists()


def _live(number: int, out: str, checkpoint_every: float, device: str) -> Ending:
    """Run a job on a node; wait for a while if a dead node still holds the lock of the run."""
    from primordia.experiments.job import ending_of
    from primordia.experiments.plan import recorded

    plan, folder = recorded(Path(out)), Path(out)
    end = time.monotonic() + RELEASE
    while True:
        ending = ending_of(plan, plan.jobs()[number], folder, checkpoint_every, device)
        if ending.state != "elsewhere" or time.monotonic() > end:
            return ending
        time.sleep(1.0)


def _ending(job: Job, done: "Future[Any]") -> Ending:
    """Return the outcome of a task, also of a task that Ray gave up."""
    with suppress(Exception):
        return Ending(*done.result())
    error = done.exception()
    first = str(error).strip().partition("\n")[0]
    return Ending(job.number, "failed", f"{type(error).__name__}: {first}")
