"""Verification: a run is repeated from its beginning and compared with its records."""

import time

from primordia.engine.engine import Engine
from primordia.errors import InputError
from primordia.progress import tell
from primordia.random.wide import to_host
from primordia.runs import checkpoint
from primordia.runs.archive import Archive
from primordia.runs.arrays import world_ticks
from primordia.runs.digest import digests
from primordia.runs.loop import Listener, Status, recorder_for, restore


def verify(run: Archive, listen: Listener | None = None) -> list[str]:
    """Repeat a run from its beginning, without writing. Return the differences from its records.

    Raises:
        InputError: the run has no checkpoint yet, or the run is not exact, so it cannot be verified.
    """
    config = run.config
    last, faults = run.newest
    if faults:
        return faults
    if last is None:
        raise InputError(f"{run.path} has no checkpoint yet, so there is nothing to verify")
    if not last.manifest.progress.exact:
        raise InputError(
            f"{run.path} is not exact (see `primordia info`), so it cannot be verified"
        )
    run.admit()
    engine = Engine(config)
    lived = world_ticks(run.state)
    limits = engine.limits({}, lived)
    recorder = recorder_for(engine, None)
    if (origin := checkpoint.origin(run.path, run.fault_in)) is not None:
        restore(engine, recorder, origin, run.arrays_of(origin))
    began = time.perf_counter()
    while engine.any_running(limits):
        recorder.append(engine.advance(limits))
        tell("living again", to_host(engine.state.world.worlds.tick).sum() / lived.sum())
        if listen is not None:
            listen(Status(engine, time.perf_counter() - began))
    recorded = digests(last.digests, run.state, config.seeds, config.islands)
    now = digests(recorder.digests(), engine.arrays(), config.seeds, config.islands)
    other_versions = "".join(f"; {each}" for each in run.other_versions)
    return [
        f"world {world} (seed {config.seed + world}) differs: {old[:16]}... recorded,"
        f" {new[:16]}... now{other_versions}"
        for world, (old, new) in enumerate(zip(recorded, now, strict=True))
        if old != new
    ]
