"""Jobs on the cores of this machine: one process for each core runs one job after another."""

import json
import os
import subprocess
import sys
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

from primordia import cores, files
from primordia.experiments.job import note_failure
from primordia.experiments.plan import LOG, Ending, Job

PATIENCE = 15.0
"""Seconds that a process has for a checkpoint when the process must stop."""


class Here:
    """Processes on this machine."""

    def __init__(
        self, out: Path, processes: int, checkpoint_every: float, device: str = "cpu"
    ) -> None:
        """Prepare to run jobs of the experiment in `out`, one at a time in each process."""
        self._out, self._arguments = out, (str(checkpoint_every), device)
        self._own = threading.local()
        self._workers: list[subprocess.Popen[str]] = []
        self._threads = ThreadPoolExecutor(processes)
        self._starting, self._stopping = threading.Lock(), False

    def submit(self, job: Job) -> Future[Ending]:
        """Run a job as soon as a process is free."""
        return self._threads.submit(self._live, job)

    def stop(self) -> None:
        """Stop all processes, each after a checkpoint; jobs that have not begun are dropped."""
        with self._starting:  # no process starts after this
            self._stopping = True
        self._threads.shutdown(wait=False, cancel_futures=True)
        for worker in self._workers:
            with suppress(OSError):
                worker.terminate()
        for worker in self._workers:
            try:
                worker.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                worker.kill()
        self._threads.shutdown()  # each thread has read its worker's last answer or end
        for worker in self._workers:
            with worker, suppress(BrokenPipeError):
                assert worker.stdin is not None
                worker.stdin.close()

    def _live(self, job: Job) -> Ending:
        worker = getattr(self._own, "worker", None)
        if worker is None or worker.poll() is not None:
            with self._starting:
                if self._stopping:
                    return Ending(job.number, "stopped")
                worker = self._own.worker = self._started()
        assert worker.stdin is not None
        assert worker.stdout is not None
        with suppress(BrokenPipeError):
            worker.stdin.write(f"{job.number}\n")
            worker.stdin.flush()
        if answer := worker.stdout.readline():
            return Ending(**json.loads(answer))
        if self._stopping:
            return Ending(job.number, "stopped")
        error = f"the job's process ended with status {worker.wait()}; see {self._out / LOG}"
        note_failure(job, self._out, error)
        return Ending(job.number, "failed", error)

    def _started(self) -> subprocess.Popen[str]:
        command = [sys.executable, "-P", "-m", "primordia.experiments.worker"]
        files.check_output(self._out / LOG)
        with (self._out / LOG).open("a", encoding="utf-8") as log:
            worker = subprocess.Popen(
                [*command, str(self._out), *self._arguments],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                process_group=0,  # Ctrl-C in a terminal goes to the experiment, which stops its workers
                env=environment(),
            )
        self._workers.append(worker)
        return worker


def environment() -> dict[str, str]:
    """Return the environment of a process that runs jobs: one core, and this process's modules."""
    return {**os.environ, cores.VARIABLE: "1", "PYTHONPATH": os.pathsep.join(sys.path)}
