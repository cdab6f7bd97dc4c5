"""Run experiments to their end and write what came out.

    python experiments/run.py experiments/cartpole/*.toml

An experiment is a TOML file: a `question`, the settings that all arms share, and `[[arms]]`, each
with a `name` and what is different in it; the first arm is the reference. With a `[fork]`, `of` the
arm of another file of the folder, `at` a tick, all arms go on from there. Arms live in
`runs/experiments/` of the current folder. One that is done is not run again, one that was cut off
goes on. Table, figure and the figures of every world go to `results/` beside the file.
"""

import sys
import tomllib
from pathlib import Path
from typing import Any

import files

import primordia
from primordia import config
from results import write


def experiment(file: Path) -> None:
    """Every arm, then the results."""
    told, arms = tomllib.loads(file.read_text(encoding="utf-8")), files.arms(file)
    runs = [files.folder(file) / name for name in arms]
    for run, settings in zip(runs, arms.values(), strict=True):
        live(run, settings, told.get("fork"))
        print(f"{run} is done", flush=True)
    write(file.parent / "results" / file.stem, told["question"], runs)


def live(run: Path, settings: dict[str, Any], fork: dict[str, Any] | None) -> None:
    """Run an arm to its end, or go on with it."""
    task = settings.pop("task")
    if run.exists():
        refuse_other(run, tomllib.loads(config.load(task, settings).to_toml()))
        primordia.Run(run).resume()
    elif fork is None:
        primordia.run(task, run, **settings)
    else:
        primordia.load(run.parent.parent / fork["of"]).fork(fork["at"], run, **settings)


def refuse_other(run: Path, wanted: dict[str, Any]) -> None:
    """Not to go on with a run of other settings."""
    found = tomllib.loads((run / "config.toml").read_text(encoding="utf-8"))
    if {**found, "origin": wanted["origin"]} != wanted:
        sys.exit(f"{run} was begun with other settings; remove it, and it is run again")


if __name__ == "__main__":
    files.each(experiment, __doc__)
