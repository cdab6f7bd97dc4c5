"""Forks: a run goes on from one of its ticks in a new run, with another seed or other settings.

A fork is a run with its own directory. Its `origin` holds the whole state at that tick, in the form of a
checkpoint. Its records begin with the births of the organisms alive at that tick.
"""

import time
from operator import index
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np

from primordia.config import Config, validated
from primordia.engine.engine import Engine
from primordia.engine.state import State
from primordia.errors import InputError, Trouble
from primordia.law.events import births_of
from primordia.law.genesis import initial_looks
from primordia.law.metabolism import to_fixed_point
from primordia.law.world import Climate, Looks, World, Worlds
from primordia.random.wide import Wide, never, wide
from primordia.runs import bundle, checkpoint, directory
from primordia.runs.archive import Archive
from primordia.runs.arrays import world_ticks
from primordia.runs.lives import Lives
from primordia.runs.loop import Listener, Status, recorder_for
from primordia.runs.manifest import Progress
from primordia.settings.limits import ForkedFrom
from primordia.settings.tables import from_toml, merged

HARMLESS = {"stop", "fork", "about", "sample_every"}
"""Settings that do not change the course of a world."""
OF_ANY_LENGTH = ".states"
"""The array of saved states; all its rows are as long as the longest of these states
(`habitats.states`)."""
OF_MUTATION = (".notes", ".moments.")
"""Arrays with these parts in their names begin empty if the kind of mutation changes."""
RENEWED = (*OF_MUTATION, ".looks.", ".climate.")
"""A fork may differ from its source in arrays with these parts in their names."""


def fork(
    source: Archive,
    at: int,
    out: Path,
    settings: dict[str, Any],
    listen: Listener | None = None,
) -> None:
    """Make a run that begins with another run's state at the end of tick `at`. The new run is not
    advanced.

    Args:
        source: the run to fork.
        at: a tick that all worlds have lived through.
        out: directory of the new run.
        settings: changed settings, as nested tables; a changed `seed` gives different random draws.
        listen: called after each repeated chunk on the way to the tick.

    Raises:
        InputError: no such tick, a setting that cannot change in a living world, or `out` is taken.
        Trouble: a file cannot be written, or the source does not repeat as recorded.
    """
    at = index(at)
    _check_tick(source, at)
    source.admit()
    changed = _fork_config(source, settings, at)
    directory.refuse_if_taken(out)
    before = _engine_at(source, at, listen)
    living = _living(source.lives, before, source.config, at)
    after = _transplant(before, source.config, changed, at)
    recorder = recorder_for(after, out)
    recorder.add("births", _birth_rows(source, living, after))
    progress = Progress(limits=changed.stop, wall_s=0.0, exact=after.chunks.exact)

    def save_origin() -> None:
        checkpoint.write(out, out / checkpoint.ORIGIN, after.arrays(), recorder, progress)

    with directory.create(out, changed, save_origin):
        pass


def _check_tick(source: Archive, at: int) -> None:
    """Raise InputError unless a run can be forked at this tick."""
    first, last = max(source.config.begins, 1), int(source.ends.min())
    if not first <= at <= last:
        of = source.config.fork
        before = "" if of is None or at > last else f"; for an earlier tick, fork {of.run}"
        raise InputError(
            f"--at {at}: {source.path} can be forked at any tick from {first} to {last}{before}"
        )


def _fork_config(source: Archive, settings: dict[str, Any], at: int) -> Config:
    """Return the configuration of the fork."""
    if "task" in settings:
        raise InputError("a fork keeps the task of its source; remove the setting 'task'")
    values = from_toml(source.path / "config.toml")
    values = merged(source.config.on_copies(values), settings)
    values["fork"] = ForkedFrom(run=str(bundle.origin_of(source.path)), tick=at).model_dump()
    return validated(values, source=str(source.path))


def _engine_at(source: Archive, at: int, listen: Listener | None) -> Engine:
    """Return an engine at the end of a tick, advanced from the newest checkpoint before it."""
    engine = Engine(source.config)
    limits = engine.limits({"ticks": at})
    checkpoints = checkpoint.whole_checkpoints(source.path, source.fault_in)
    stored = (source.arrays_of(each) for each in checkpoints)
    if before := next((each for each in stored if (world_ticks(each) <= at).all()), None):
        engine.load(dict(before))
    if not engine.any_running(limits):
        return engine
    again = f"lived again up to tick {at}"
    if source.other_versions:
        raise InputError(f"{source.path} cannot be {again}: {'; '.join(source.other_versions)}")
    if not engine.chunks.exact:
        raise InputError(f"{source.path} is not exact, so it cannot be {again}")
    began = time.perf_counter()
    while engine.any_running(limits):
        engine.advance(limits)
        if listen is not None:
            listen(Status(engine, time.perf_counter() - began, limits))
    return engine


def _living(lives: Lives, engine: Engine, config: Config, at: int) -> Lives:
    """Return the lives of the living at the end of a tick, after comparing them with the engine's
    world."""
    alive = (lives.born <= at) & ((lives.ended > at) | ~lives.died)
    living = lives.take(np.flatnonzero(alive))
    organisms = engine.state.world.organisms
    cells = np.flatnonzero(organisms.alive)
    number = np.asarray(organisms.number.lo)[cells]
    order = np.lexsort((living.cell, living.world))
    recorded = living.world[order] * config.cells + living.cell[order]
    if not np.array_equal(recorded, cells) or not np.array_equal(
        living.id[order].astype(np.uint32), number
    ):
        raise Trouble(f"tick {at} did not repeat as recorded; `primordia verify` tells more")
    return living


def _birth_rows(source: Archive, living: Lives, engine: Engine) -> np.ndarray:
    """Return the births of the living in the law's form, uint32 (n, words), in order of events."""
    living = living.take(np.lexsort((living.cell, living.world, living.born)))
    cell = living.world.astype(np.int64) * engine.law.cells + living.cell
    heredity, notes = engine.law.heredity, engine.state.world.organisms.notes
    own = {"mate": np.full(len(living), -1)} if heredity.recombination is not None else {}
    if engine.law.act is not None:
        own["endowment"] = source.endowments_of(living)
    return births_of(engine.law).rows(
        cell=cell,
        id=living.id,
        parent=living.parent,
        tick=living.born,
        cause=living.birth_cause,
        **own,  # organisms alive at the fork are the roots of later lines
        **dict(zip(heredity.mutation.notes, np.asarray(notes)[cell].T, strict=True)),
    )


def _transplant(before: Engine, old: Config, new: Config, at: int) -> Engine:
    """Return an engine of the new configuration with the organisms and bodies of another engine."""
    after = Engine(new)
    arrays, own = before.arrays(), after.arrays()
    fitting = {name for name in own if _form(name, arrays) == _form(name, own)}
    lasting = {name for name in own if not any(part in name for part in RENEWED)}
    if new.brain != old.brain or not lasting <= fitting:
        raise InputError(
            "a fork cannot change cells, seeds, senses, the brain or its outputs, or the habitat"
        )
    if new.mutation["kind"] != old.mutation["kind"]:
        fitting = {name for name in fitting if not any(part in name for part in OF_MUTATION)}
    after.load(own | {name: arrays[name] for name in fitting})
    world, bodies = after.state
    after.state = State(_adapt(world, before, after, old, new, at), bodies)
    return after


def _form(name: str, arrays: dict[str, np.ndarray]) -> tuple[int, ...]:
    """Return the part of an array's shape that settings determine; () if there is no such array."""
    shape = np.shape(arrays.get(name, 0))
    return shape[:1] if name.endswith(OF_ANY_LENGTH) else shape


def _adapt(world: World, before: Engine, after: Engine, old: Config, new: Config, at: int) -> World:
    """Return a world with new settings; unchanged settings keep the value that seasons gave them."""
    organisms, worlds = world
    worlds = worlds._replace(
        seed=wide(new.world_seeds),
        sample_wait=jnp.full_like(worlds.sample_wait, new.sample_every - at % new.sample_every),
        climate=_climate(worlds.climate, before, after),
        looks=worlds.looks if new.seasons == old.seasons else _looks(worlds, after, at),
    )
    if new.metabolism is not None and old.metabolism is None:
        store = after.law.in_cells(worlds.climate)["metabolism.store"]
        organisms = organisms._replace(energy=to_fixed_point(store))
    if _matters(new) != _matters(old):
        worlds = worlds._replace(  # the fork must saturate again
            calm=jnp.zeros_like(worlds.calm),
            saturated=never(worlds.calm.shape),
            saturated_births=never(worlds.calm.shape),
        )
    return World(organisms, worlds)


def _matters(config: Config) -> dict[str, Any]:
    """Return the settings that lives depend on. A file is named by its copy, which a fork has of it."""
    return {**config.model_dump(exclude=HARMLESS), "habitat": config.on_copies(config.habitat)}


def _looks(worlds: Worlds, after: Engine, at: int) -> Looks:
    """Return the counts of new ratchets, which start at the fork."""
    fresh = initial_looks(after.law, len(worlds.calm), at)

    def now(count: Wide) -> Wide:
        return count.map(lambda words: jnp.tile(words[:, None], (1, fresh.wait.shape[1])))

    return Looks(fresh.wait, now(worlds.food), now(worlds.organism_ticks))


def _climate(now: Climate, before: Engine, after: Engine) -> Climate:
    """Return the new value of each changed setting, and the present value of each other setting."""
    old = dict(before.law.beginning)
    return {
        name: now[name] if old.get(name) == value else jnp.full_like(now[name], value)
        for name, value in after.law.beginning
    }
