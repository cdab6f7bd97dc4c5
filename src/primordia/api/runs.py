"""The Python interface to a run: a method for each command. Each call opens the run."""

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from primordia import device as devices
from primordia.assays.ablate import Ablation, ablate
from primordia.assays.controls import FOUNDERS, Standing, evolved, unevolved
from primordia.assays.shadow import ORGANISMS, Shadow, shadow
from primordia.assays.subjects import of_run
from primordia.errors import InputError, Trouble
from primordia.history.heredity import Inherited, heredity
from primordia.history.info import info
from primordia.history.islands import OnIsland, champions, oldest, on_islands
from primordia.history.summary import summary
from primordia.history.threshold import Threshold, threshold
from primordia.organism.export import export
from primordia.organism.organism import Organism, numbers_of
from primordia.organism.playing.evaluation import Evaluation, evaluate
from primordia.organism.policy import Policy
from primordia.phylogeny import formats
from primordia.phylogeny.descent import Ancestors, ancestors
from primordia.phylogeny.forks import whole_past
from primordia.phylogeny.lines import WorldLines, lines
from primordia.phylogeny.reduce import chosen
from primordia.phylogeny.table import table
from primordia.phylogeny.traits import with_traits
from primordia.printable import printable
from primordia.runs import bundle, directory, loop, opening
from primordia.runs.archive import Archive
from primordia.runs.fork import fork
from primordia.runs.lives import LATE, Lives
from primordia.runs.loop import Listener
from primordia.runs.records import Records
from primordia.runs.verify import verify
from primordia.tracking.track import Sources, track


@dataclass(frozen=True)
class Run:
    """A run, or several runs as one arm. All worlds are in the order of their seeds.

    Each call opens the runs again. An `Organism` keeps the records from which it was made.
    """

    path: Path
    """a run's directory or bundle, a folder that holds runs, or a pattern such as `runs/h*`"""
    others: tuple[Path, ...] = ()
    """further runs of the same arm"""

    def __post_init__(self) -> None:
        object.__setattr__(self, "path", Path(self.path))

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        """Print what `primordia info` prints, as notebooks and IPython show it."""
        try:
            text = self._summary()
        except (InputError, Trouble) as error:
            text = str(error)
        printer.text(printable(text))

    def _summary(self) -> str:
        return summary(self.info())

    def opened(self) -> Records:
        """Open the present records for reading."""
        return opening.opened([self.path, *self.others])

    def only(self) -> Archive:
        """Open the run for reading; raise InputError if there are several runs."""
        return opening.only([self.path, *self.others])

    def directories(self) -> tuple[Path, ...]:
        """Return the directories of the runs; raise InputError if a directory is not a run."""
        return self.opened().paths

    def info(self) -> dict[str, Any]:
        """Return the main numbers of the run and of its worlds; see `info.info`."""
        return info(self.opened())

    def table(self, name: str) -> pa.Table:
        """Return `births`, `deaths` or `metrics` as an Arrow table."""
        return self.opened().table(name)

    def arrays(self, name: str) -> dict[str, np.ndarray]:
        """Return the columns of a table by name, as NumPy arrays."""
        table = self.table(name)
        return {each: table[each].to_numpy(zero_copy_only=False) for each in table.column_names}

    def lives(self) -> Lives:
        """Return births and deaths joined: one row for each organism of the run."""
        return self.opened().lives

    def organism(self, organism: int, world: int = 0) -> Organism:
        """Return an organism by its birth number."""
        run = self.opened()
        return Organism(run, run.lives.row(organism, world))

    def oldest(
        self, world: int | None = None, after: float = LATE, island: str | None = None
    ) -> Organism:
        """Return the organism that lived longest, in one world or in all worlds.

        `after` is a share of each world's births; organisms born earlier than that do not count.
        In a fork, only births after the fork count. By default, the founders with which a world
        begins count only if few others were born. If several organisms lived longest, the last-born
        of them is returned. With the name of an `island`, only organisms that were born on it count.
        """
        run = self.opened()
        return Organism(run, oldest(run, world, after, island))

    def champions(self, island: str | None = None) -> list[Organism]:
        """Return the `oldest` organism of each world in which anything was born since the run began.

        With the name of an island, only organisms that were born on it count.
        """
        run = self.opened()
        return [Organism(run, row) for row in champions(run, island).tolist()]

    def islands(self) -> list[OnIsland]:
        """Return the numbers of each island of each world; see `islands.on_islands`. A run without
        islands gives []."""
        return on_islands(self.opened())

    def evaluate(self, organisms: Iterable[Organism | int], **options: Any) -> list[Evaluation]:
        """Let organisms play games side by side; see `evaluation.evaluate`.

        A birth number stands for an organism of world 0.
        """
        run = self.opened()
        return evaluate(run, numbers_of(run, organisms), **options)

    def standings(
        self,
        founders: int | None = FOUNDERS,
        world: int | None = None,
        island: str | None = None,
        **options: Any,
    ) -> list[Standing]:
        """Evaluate the champions, the living, some founders, and the best of many founders.

        `founders`, `world` and `island` are those of `controls.unevolved`; `options` are those of
        `Group.evaluate`.
        """
        run = self.opened()
        with devices.selected(None, run.made_on):
            # The champions come first, so that a wrong option fails before many founders have lived.
            found = [group.evaluate(**options) for group in evolved(run, world, island)]
            others = unevolved(run, founders, world, island)
            return found + [group.evaluate(**options) for group in others]

    def shadow(
        self, organisms: int = ORGANISMS, ticks: int | None = None, island: str | None = None
    ) -> Shadow:
        """Let organisms and their unselected shadows live again; see `shadow.shadow`."""
        return shadow(self.opened(), organisms, ticks, island)

    def ablate(self, organisms: Iterable[Organism | int] = (), **options: Any) -> list[Ablation]:
        """Let organisms, by default the champions, play games without their learning, their memory,
        their senses or some of their weights; see `ablate.ablate`."""
        run = self.opened()
        own = numbers_of(run, organisms)
        with devices.selected(None, run.made_on):
            return ablate(of_run(run, own), **options)

    def heredity(self, after: float = LATE, island: str | None = None) -> list[Inherited]:
        """Measure how length of life is inherited in each world; see `history.heredity`."""
        return heredity(self.opened(), after, island)

    def threshold(self, after: float = LATE, island: str | None = None) -> list[Threshold]:
        """Measure in each world whether a good line can persist; see `history.threshold`."""
        return threshold(self.opened(), after, island)

    def ancestors(
        self,
        organism: int | None = None,
        world: int | None = None,
        say: Callable[[str], object] = warnings.warn,
    ) -> Ancestors:
        """Follow the line of descent of an organism, by default the `oldest`; see `descent.ancestors`.

        `say` is called with a message if the line ends at a fork because the forked run is missing.
        """
        run = self.opened()
        if organism is not None:
            return ancestors(run, organism, world or 0, say)
        champion = Organism(run, run.lives.oldest(world))
        return ancestors(run, champion.id, champion.world, say)

    def lineages(self, world: int | None = None, at: int | None = None) -> list[WorldLines]:
        """Measure how lines replace each other, in one world or in all; see `phylogeny.lines`."""
        return lines(self.opened(), world, at)

    def policy(self) -> Policy:
        """Return the brain of the run's `oldest` organism as a function `policy(senses) -> action`."""
        return self.oldest().policy()

    def export(
        self, out: str | Path, *organisms: Organism | int, world: int = 0
    ) -> tuple[int, ...]:
        """Write the genomes of some organisms of one world to a safetensors file; see `export.export`."""
        chosen = numbers_of(self.opened(), organisms, world)
        worlds = {own for _, own in chosen} or {world}
        if len(worlds) > 1 or (world and worlds != {world}):
            raise InputError("export takes organisms of one world; call it once for each world")
        return export(self.opened(), Path(out), tuple(number for number, _ in chosen), worlds.pop())

    def phylogeny(
        self,
        organism: int | None = None,
        *,
        out: str | Path | None = None,
        traits: bool = False,
        say: Callable[[str], object] = warnings.warn,
        **choice: Any,
    ) -> pa.Table | None:
        """Return the phylogeny as a table, or write it to a file; see docs/how-to/phylogeny.md.

        `say` is called with a message about anything that is missing. `world`, `extant` and
        `collapse` are those of `reduce.chosen`. With `organism`, a birth number, the table is that
        organism's line of descent. With `traits`, it has the traits of bodies.
        """
        if out is not None:
            formats.check_suffix(Path(out))
        past = whole_past(self.only(), say)
        part = chosen(past.whole, organism, **choice)
        if traits:
            part = with_traits(part, past.runs)
        if out is None:
            return table(part)
        formats.save(part, Path(out), say)
        return None

    def plot(
        self, out: str | Path | None = None, world: int = 0, figures: Sequence[str] = ()
    ) -> list[Path]:
        """Draw figures, by default into the run's folder `figures`. Return the files; see `plot.plot`."""
        from primordia.figures.plot import plot  # Matplotlib takes a second to load

        return plot(self.opened(), Path(out) if out is not None else None, world, figures)

    def film(self, out: str | Path | None = None, world: int = 0, **options: Any) -> Path:
        """Film a world, by default into the run's folder `videos`. Return the file; see `film.film`."""
        from primordia.film.film import film

        return film(self.opened(), Path(out) if out is not None else None, world, **options)

    def report(self, out: str | Path | None = None) -> Path:
        """Write a page about the run, by default `report.html` in its directory; see `report.report`."""
        from primordia.report.report import report  # Matplotlib takes a second to load

        return report(self.opened(), Path(out) if out is not None else None)

    def watch(self, port: int | None = None, begun: Callable[[str], object] = print) -> None:
        """Serve a live page about the run on this machine until Ctrl-C is pressed; see `server.watch`."""
        from primordia.report.server import PORT, watch  # Matplotlib takes a second to load

        watch(self.opened, PORT if port is None else port, begun)

    def track(
        self, tensorboard: str | Path | None = None, wandb: str | Path | None = None, **options: Any
    ) -> None:
        """Write the metrics for TensorBoard or Weights & Biases; see `tracking.track`."""
        track(self.sources, self.path.resolve().name, tensorboard, wandb, **options)

    def sources(self) -> Sources:
        """Return the directories of the runs, and whether a process is running one of them."""
        paths = self.directories()
        return Sources({"": paths}, any(map(directory.is_written, paths)))

    def fork(
        self,
        at: int,
        out: str | Path | None = None,
        settings: Mapping[str, Any] | None = None,
        *,
        checkpoint_every: float = 60.0,
        device: str | None = None,
        listen: Listener | None = None,
        **more: Any,
    ) -> "Run":
        """Make a run that goes on, with changed settings, from the end of a tick; see `runs.fork`.

        `device` is `cpu` or `gpu`; by default the kind of device that made the run.
        """
        path = Path(out) if out is not None else fresh_directory(f"{self.path.name}-at{at}")
        with devices.selected(device, self.only().made_on):
            fork(self.only(), at, path, {**(settings or {}), **more}, listen)
            loop.resume(path, checkpoint_every=checkpoint_every, listen=listen)
        return Run(path)

    def resume(
        self,
        *,
        inexact: bool = False,
        checkpoint_every: float = 60.0,
        device: str | None = None,
        listen: Listener | None = None,
        **limits: Any,
    ) -> list[str]:
        """Go on with the run; `limits` may change `ticks`, `births` or `until`. See `loop.resume`.

        `device` is `cpu` or `gpu`; by default the kind of device that made the run.
        """
        every, run = checkpoint_every, self.only().path
        bundle.refuse_changes(run)
        with devices.selected(device, self.only().made_on):
            return loop.resume(run, limits, inexact=inexact, checkpoint_every=every, listen=listen)

    def bundle(self, file: str | Path) -> Path:
        """Write the run into one file, which `load` reads. Return the file; see `bundle.write`."""
        bundle.write(self.only().path, Path(file))
        return Path(file)

    def verify(self, device: str | None = None, listen: Listener | None = None) -> list[str]:
        """Repeat the run and return the differences; see `verify.verify` and, for `device`, `resume`."""
        with devices.selected(device, self.only().made_on):
            return verify(self.only(), listen)


def fresh_directory(name: str) -> Path:
    """Return a path under `runs/` that does not exist yet."""
    others = (Path("runs", f"{name}-{i}") for i in count(2))
    return next(path for path in chain([Path("runs", name)], others) if not path.exists())
