"""The Python interface, which the command line is made of.

import primordia

run = primordia.run("CartPole-survival", out="runs/first", seed=1)
print(run.info()["saturation"])
run.resume(ticks=200_000)
genome = run.rebuild(organism=17)
"""

from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from primordia import comparison, config, lineage, loop, report
from primordia import device as devices
from primordia.loop import Listener
from primordia.verify import verify


@dataclass(frozen=True)
class Run:
    """A run directory."""

    path: Path

    def __post_init__(self) -> None:
        object.__setattr__(self, "path", Path(self.path))

    def info(self) -> dict[str, Any]:
        """The run in one object; see `report.info`."""
        return report.info(self.path)

    def table(self, name: str) -> pa.Table:
        """`births`, `deaths` or `metrics`, as an Arrow table."""
        return report.table(self.path, name)

    def rebuild(self, organism: int, world: int = 0) -> np.ndarray:
        """An organism's genome, float32 (P,), from the birth records alone."""
        return lineage.rebuild(self.path, organism, world)

    def plot(self, out: str | Path | None = None, world: int = 0) -> list[Path]:
        """Draw its figures into a folder, by default its own -> the files; see `figures.plot`."""
        from primordia import figures  # Matplotlib takes a second to load

        return figures.plot(self.path, Path(out) if out is not None else None, world)

    def resume(
        self,
        *,
        inexact: bool = False,
        checkpoint_every: float = 60.0,
        device: str = "cpu",
        listen: Listener | None = None,
        **limits: Any,
    ) -> list[str]:
        """Go on, with new `ticks`, `births` or `until` if given; see `loop.resume`."""
        devices.select(device)
        return loop.resume(
            self.path, limits, inexact=inexact, checkpoint_every=checkpoint_every, listen=listen
        )

    def verify(self, device: str = "cpu", listen: Listener | None = None) -> list[str]:
        """Do it again and compare -> what differs."""
        devices.select(device)
        return verify(self.path, listen)


def run(
    task: str,
    out: str | Path | None = None,
    *,
    checkpoint_every: float = 60.0,
    device: str = "cpu",
    listen: Listener | None = None,
    **settings: Any,
) -> Run:
    """Run a task until its worlds stop.

    Args:
        task: name of a built-in task, or a TOML file.
        out: directory to make; by default a new one under `runs/`.
        checkpoint_every: seconds from one checkpoint to the next.
        device: what JAX computes on, `cpu` or `gpu`.
        listen: called after each chunk.
        settings: changed settings, tables as dicts: `cells=64, mutation={"scale": 0.02}`.

    Raises:
        InputError: a name or setting is wrong, or `out` is taken.
        Trouble: something cannot be written; what was checkpointed stays good.
        KeyboardInterrupt: on Ctrl-C, after a checkpoint.
    """
    devices.select(device)
    chosen = config.load(task, settings)
    path = Path(out) if out is not None else fresh_directory(chosen)
    loop.start(chosen, path, checkpoint_every=checkpoint_every, listen=listen)
    return Run(path)


def compare(
    *runs: Run | str | Path, births: int | None = None, ticks: int | None = None
) -> comparison.Comparison:
    """Put runs of one task side by side, the first as the reference; see `comparison.compare`.

    `figures.comparison.save` draws what comes back.
    """
    paths = [each.path if isinstance(each, Run) else Path(each) for each in runs]
    return comparison.compare(paths, births, ticks)


def fresh_directory(chosen: config.Config) -> Path:
    """A path under `runs/` that is not taken, named after task and seed."""
    name = f"{chosen.task.replace('/', '-')}-seed{chosen.seed}"
    others = (Path("runs", f"{name}-{i}") for i in count(2))
    return next(path for path in chain([Path("runs", name)], others) if not path.exists())
