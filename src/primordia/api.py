"""The Python interface; the command line uses nothing else.

import primordia

run = primordia.run("CartPole-survival", out="runs/first", seed=1)
print(run.info()["saturation"])
run.resume(ticks=200_000)
genome = run.rebuild(organism=17)
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from primordia import config, lineage, loop, report
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

    def resume(self, inexact: bool = False, **options: Any) -> list[str]:
        """Go on, with new `ticks`, `births` or `until` if given; see `loop.resume`."""
        limits: dict[str, Any] = {
            name: options.pop(name) for name in ("ticks", "births", "until") if name in options
        }
        return loop.resume(self.path, limits, inexact=inexact, **options)

    def verify(self, listen: Listener | None = None) -> list[str]:
        """Do it again and compare -> what differs."""
        return verify(self.path, listen)


def run(
    task: str,
    out: str | Path | None = None,
    *,
    checkpoint_every: float = 60.0,
    listen: Listener | None = None,
    **settings: Any,
) -> Run:
    """Run a task until its worlds stop.

    Args:
        task: name of a built-in task, or a TOML file.
        out: directory to make; by default a new one under `runs/`.
        checkpoint_every: seconds from one checkpoint to the next.
        listen: called after each chunk.
        settings: changed settings, tables as dicts: `cells=64, mutation={"scale": 0.02}`.

    Raises:
        InputError: a name or setting is wrong, or `out` is taken.
        Trouble: something cannot be written; what was checkpointed stays good.
        KeyboardInterrupt: on Ctrl-C, after a checkpoint.
    """
    chosen = config.load(task, settings)
    path = Path(out) if out is not None else fresh_directory(chosen)
    loop.start(chosen, path, checkpoint_every=checkpoint_every, listen=listen)
    return Run(path)


def fresh_directory(chosen: config.Config) -> Path:
    """A path under `runs/` that is not taken, named after task and seed."""
    name = f"{chosen.task}-seed{chosen.seed}"
    candidates = [Path("runs", name), *(Path("runs", f"{name}-{i}") for i in range(2, 100_000))]
    return next(path for path in candidates if not path.exists())
