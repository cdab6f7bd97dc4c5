"""A life is lived again and compared with its record."""

from collections import deque
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from primordia.errors import InputError, Trouble
from primordia.law.world import Cause
from primordia.organism import video
from primordia.organism.reliving import diary, replay
from primordia.organism.reliving.course import Course, Value, recorded
from primordia.organism.reliving.relived import RelivedLife
from primordia.printable import often
from primordia.runs import checkpoint, directory
from primordia.runs.archive import Archive, run_of
from primordia.runs.arrays import Arrays, world_ticks
from primordia.runs.records import Records, on_its_device


@dataclass(frozen=True)
class Respect:
    """One value of a life beside its recorded value."""

    name: str
    recorded: Value
    relived: Value
    """None if the relived life has no such value, since its course was different"""

    @property
    def agrees(self) -> bool:
        """Whether both are the same."""
        return self.recorded == self.relived


@dataclass(frozen=True)
class Reliving:
    """The outcome of a life that was lived again."""

    organism: int
    """birth number"""
    world: int
    begin: str
    """where the relived life began: `birth`, `fork` or `checkpoint`"""
    begins: int
    """the tick after which the relived life began"""
    ends: int
    """the last tick that was lived again"""
    respects: tuple[Respect, ...]
    notes: tuple[str, ...]
    """notes on limits of the comparison"""
    files: tuple[Path, ...]
    """the files that were written"""

    @property
    def agrees(self) -> bool:
        """Whether life and record agree in all respects."""
        return all(each.agrees for each in self.respects)

    def to_dict(self) -> dict[str, Any]:
        """Return all values in JSON's types."""
        respects = [{**asdict(each), "agrees": each.agrees} for each in self.respects]
        own = {
            name: getattr(self, name) for name in ("organism", "world", "begin", "begins", "ends")
        }
        files = [str(each) for each in self.files]
        return {**own, "agrees": self.agrees, "respects": respects,
                "notes": list(self.notes), "files": files}  # fmt: skip


@on_its_device
def relive(
    run: Records,
    organism: int,
    world: int = 0,
    *,
    since: int | None = None,
    save: Path | None = None,
    film: Path | None = None,
) -> Reliving:
    """Live a life again, tick for tick, and compare it with its record.

    A living organism lives up to the run's newest checkpoint. There its memory is compared too. So
    is its body; in a habitat on the host, its senses are compared instead. A death by a neighbour's
    child agrees with its record if the organism is alive at its last tick, and the records have a
    birth in its cell in that tick. Other deaths happen again in the life itself.

    Args:
        run: the organism's run.
        organism: birth number.
        world: the organism's world.
        since: begin with the newest kept state that is not later than this tick. The kept states
            are the two newest checkpoints and the state of the fork. By default the life begins
            with the birth, or with the fork if the organism is older.
        save: an .npz, .parquet or .csv file to write the life to; see `diary.write`.
        film: an .mp4 or .gif file for a film of the life, made if the life agrees with its record.

    Raises:
        InputError: the life cannot be lived again; the message says why.
        Trouble: a file cannot be written.
    """
    if save is not None:
        diary.check_name(save)
    if film is not None:
        video.check_name(film)
    try:
        run.lives.row(organism, world)
        archive, own = run_of(run, world)
        life = RelivedLife.of(archive, organism, own, _stored(archive, organism, own, since))
        _refuse_restart(life)
        told = recorded(life)
    except Trouble as error:  # not status 1: no life was lived that could differ from the record
        raise InputError(f"organism {organism} cannot be relived: {error}") from None
    parts = replay.parts_of(life) if film is not None else []
    course = _lived(life, save)
    found, notes = course.found(), _notes(archive, course)
    respects = tuple(Respect(name, value, found.get(name)) for name, value in told.items())
    written = [] if save is None else [save]
    if film is not None and all(each.agrees for each in respects):
        replay.film(film, (life, parts))
        written.append(film)
    elif film is not None:
        notes.append(f"{film} was not made, since the life differs from its record")
    begin = "birth" if life.stored is None else "fork" if since is None else "checkpoint"
    place = organism, world, begin, life.begins, course.tick
    return Reliving(*place, respects, tuple(notes), tuple(written))


def _lived(life: RelivedLife, save: Path | None) -> Course:
    """Live a life and return its course; write the life to the file `save` if there is one."""
    course = Course(life)
    if save is None:
        deque(course.stretches(), 0)
    elif life.begins == life.ends:
        raise InputError(
            f"organism {life.record.id[0]} has not lived a tick yet, so nothing can be saved"
        )
    else:
        diary.write(save, course.stretches(), life.run.schema.tallies)
    return course


def _stored(run: Archive, organism: int, world: int, since: int | None) -> Arrays | None:
    """Return the newest kept state of a life at tick `since` or earlier."""
    if since is None:
        return None
    row, kept = run.lives.row(organism, world), []
    born, ended = int(run.lives.born[row]), int(run.lives.ended[row])
    for each in checkpoint.whole_checkpoints(run.path, run.fault_in):
        arrays = run.arrays_of(each)
        tick = int(world_ticks(arrays)[world])
        if born <= tick < ended:
            if tick <= since:
                return arrays
            kept.append(f"{tick:,}")
    life = f"organism {organism} lived from tick {born:,} to {ended:,}"
    if kept:
        raise InputError(
            f"--from {since}: {life}; {run.path} keeps only later checkpoints: {' and '.join(kept)}"
        )
    raise InputError(
        f"--from {since}: {life}, and {run.path} keeps no checkpoint of these ticks (a run keeps"
        " the newest two); without --from the life begins at birth"
    )


def _refuse_restart(life: RelivedLife) -> None:
    if life.cause is Cause.RESTART:
        raise InputError(
            f"organism {life.record.id[0]} ended when its run was resumed without its body, so its"
            " life cannot be lived again"
        )


def _notes(run: Archive, course: Course) -> list[str]:
    """Return notes on limits of a comparison, in sentences."""
    progress, (_, faults) = run.progress, run.newest
    notes = [f"{fault}; an older checkpoint was read" for fault in faults[:1]]
    if course.replaced:
        notes.append(
            "the record says that a child took the cell in the last tick; neighbours were not relived"
        )
    if directory.is_written(run.path):
        notes.append(f"the run goes on; the records end at tick {run.ends.max():,}")
    if run.other_versions:
        notes.append(f"exact repetition is not sure: {'; '.join(run.other_versions)}")
    elif not progress.exact:
        notes.append(
            "exact repetition is not sure: parts of this run cannot be repeated bit for bit"
        )
    if times := progress.restarts:
        notes.append(
            f"the living got new bodies {often(times)}, when the run was resumed; a life that was"
            " lived then does not repeat"
        )
    return notes
