"""Jobs. Each job begins or resumes an ordinary run."""

import os
import time
import traceback
from contextlib import suppress
from pathlib import Path

from primordia import device as devices
from primordia import files
from primordia.config import Config
from primordia.errors import InputError, InUseError, Trouble
from primordia.experiments.ledger import Entry, Ledger, WorldCounts
from primordia.experiments.plan import Ending, Job, Plan
from primordia.history.info import info
from primordia.live.census import Census, Speed
from primordia.runs import code, directory, loop
from primordia.runs.archive import Archive
from primordia.runs.code import Code
from primordia.runs.fork import fork
from primordia.runs.loop import Status

EVERY = 2.0
"""Seconds between two updates of a job's entry."""


def live(
    plan: Plan, job: Job, out: Path, checkpoint_every: float = 60.0, device: str = "cpu"
) -> None:
    """Run a job to its end, from its beginning or from its newest checkpoint.

    Args:
        plan: the experiment.
        job: one of its jobs.
        out: the experiment's directory.
        checkpoint_every: seconds from one checkpoint to the next.
        device: the device that computes the job, `cpu` or `gpu`.

    Raises:
        InputError: another process runs the job, or the job cannot go on with these versions or settings.
        Trouble: a file cannot be written.
        KeyboardInterrupt: on a signal, after a checkpoint.
    """
    ledger, entry = Ledger(out, [job]), Entry(job=job.number, arm=job.arm, state="running")
    ledger.write(job, entry)
    with devices.selected(device):
        _live(plan, job, out, checkpoint_every, _Watch(ledger, job, entry))
    worlds = _worlds(Archive(out / job.folder))
    ledger.write(job, Entry(job=job.number, arm=job.arm, state="done", worlds=worlds))


def _live(plan: Plan, job: Job, out: Path, checkpoint_every: float, watch: "_Watch") -> None:
    config, run = configuration(plan, job), out / job.folder
    files.own_folder(run.parent)
    files.check_own_folder(run)
    unbegun = directory.clear_unbegun(run)
    if unbegun and job.source is not None and plan.fork is not None:
        source = Archive(Path(os.path.normpath(out / job.source)))
        changes = source.config.on_copies(_changes(config))  # files that the source has copied
        try:
            fork(source, plan.fork.at, run, changes, watch)
        except InputError:  # another command has begun the job meanwhile
            if directory.is_written(run):
                raise InUseError(f"job {job.number} is being run by another process") from None
            if directory.clear_unbegun(run):
                raise
    if unbegun and job.source is None:
        loop.start(config, run, checkpoint_every=checkpoint_every, listen=watch)
    else:
        _go_on(run, config, checkpoint_every, watch)


def ending_of(
    plan: Plan, job: Job, out: Path, checkpoint_every: float = 60.0, device: str = "cpu"
) -> Ending:
    """Run a job and return its outcome; record a failure in the job's entry."""
    try:
        live(plan, job, out, checkpoint_every, device)
    except KeyboardInterrupt:
        return Ending(job.number, "stopped")
    except InUseError:
        return Ending(job.number, "elsewhere")
    except (InputError, Trouble, OSError) as error:
        note_failure(job, out, str(error))
        return Ending(job.number, "failed", str(error), again=not isinstance(error, InputError))
    except Exception as error:  # an error of the user's code or of ours: the other jobs go on
        traceback.print_exc()
        text = f"{type(error).__name__}: {error}".splitlines()[0]
        note_failure(job, out, text)
        return Ending(job.number, "failed", text)
    return Ending(job.number, "done")


def note_failure(job: Job, out: Path, error: str) -> None:
    """Record that a job has failed, and why, if the disk allows it."""
    ledger = Ledger(out, [job])
    entry = ledger.entry(job).model_copy(update={"state": "failed", "error": error})
    with suppress(Trouble, InputError):
        ledger.write(job, entry)


def configuration(plan: Plan, job: Job) -> Config:
    """Return the configuration of a job's run."""
    whole = plan.arm(job.arm).config
    return whole.model_copy(update={"seed": whole.seed + job.first, "seeds": job.worlds})


def _changes(config: Config) -> dict[str, object]:
    """Return the settings of a fork, changed and unchanged."""
    return config.model_dump(mode="json", exclude={"task", "about", "fork", "seeds", "ancestors"})


def _go_on(run: Path, config: Config, checkpoint_every: float, watch: "_Watch") -> None:
    archive = Archive(run)
    held = Code(archive.code().files)
    if held.marks <= code.found(config).marks:
        code.trust(held)  # these are the user's own files; a folder from elsewhere may hold others
    limits = config.stop.model_dump()
    loop.resume(run, limits, checkpoint_every=checkpoint_every, listen=watch)


def _worlds(run: Archive) -> list[WorldCounts]:
    names = WorldCounts.model_fields.keys() - {"saturated"}
    return [
        WorldCounts(
            **{name: world[name] for name in names},
            saturated=world["saturation"] and world["saturation"]["tick"],
        )
        for world in info(run)["worlds"]
    ]


class _Watch:
    """A listener that writes a job's counts into its entry at intervals."""

    def __init__(self, ledger: Ledger, job: Job, entry: Entry) -> None:
        self._ledger, self._job, self._entry = ledger, job, entry
        self._speed, self._due = Speed(), 0.0

    def __call__(self, status: Status) -> None:
        """Write the counts if the interval has passed."""
        now = time.perf_counter()
        if now < self._due:
            return
        self._due = now + EVERY
        census = Census.of(status.engine.state.world)
        self._speed.add(now, census)
        self._entry.rate = self._speed.organism_ticks_per_s()
        if status.limits is not None:
            self._entry.left_s = self._speed.seconds_left(status.limits)
        seeds = status.engine.config.world_seeds.tolist()
        self._entry.worlds = [_counts(census, world, seed) for world, seed in enumerate(seeds)]
        self._ledger.write(self._job, self._entry)


def _counts(census: Census, world: int, seed: int) -> WorldCounts:
    saturated = int(census.saturated[world])
    return WorldCounts(
        seed=seed,
        ticks=int(census.tick[world]),
        births=int(census.births[world]),
        deaths=int(census.deaths[world].sum()),
        organism_ticks=int(census.organism_ticks[world]),
        saturated=None if saturated < 0 else saturated,
    )
