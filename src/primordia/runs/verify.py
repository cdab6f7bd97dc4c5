"""Verification: a run is lived again from its beginning, and must come out the same."""

import time

from primordia.engine.engine import Engine
from primordia.errors import InputError
from primordia.runs import checkpoint
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import world_ticks
from primordia.runs.digest import digests
from primordia.runs.loop import Listener, Status, recorder_for, stand_at


def verify(run: Archive, listen: Listener | None = None) -> list[str]:
    """Do a run again from its beginning, without writing, and compare -> what differs (empty: nothing).

    Raises:
        InputError: this is no run, or there is nothing in it that must come out the same.
    """
    config = run.config
    last, faults = run.newest
    if faults:
        return faults
    if last is None:
        raise InputError(f"{run.path} has no checkpoint yet, so there is nothing to verify")
    if not last.progress.exact:
        raise InputError(f"{run.path} is not exact (see `primordia info`): nothing can be verified")
    engine = Engine(config)
    limits = engine.limits({}, world_ticks(run.state))
    again = recorder_for(engine, None)
    if (beginning := checkpoint.origin(run.path, run.fault_in)) is not None:
        stand_at(engine, again, beginning)
    began = time.perf_counter()
    while engine.any_running(limits):
        again.append(engine.advance(limits))
        if listen is not None:
            listen(Status(engine, time.perf_counter() - began))
    old = digests(last.digests, run.state, config.seeds)
    new = digests(again.digests(), engine.arrays(), config.seeds)
    other = "".join(f"; {each}" for each in run.other_versions)
    return [
        f"world {world} (seed {config.seed + world}) differs: {a[:16]}... recorded, {b[:16]}... now"
        + other
        for world, (a, b) in enumerate(zip(old, new, strict=True))
        if a != b
    ]
