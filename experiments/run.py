"""Run experiments to their end and write their results.

    python experiments/run.py experiments/cartpole/*.toml

An experiment is a TOML file: a `question`, the settings that all arms share, and `[[arms]]`. Each arm
has a `name` and the settings that differ in it; the first arm is the reference. With a `[fork]`, all
arms continue `of` an arm of another file of the folder, `at` a tick. Runs are written to
`runs/experiments/` in the current folder. A run that is done is not run again; a run that was cut off
continues. The table, the figure and a row for each world go to `results/` beside the file.
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
    """Run every arm of an experiment, then write the results."""
    values, arms = tomllib.loads(file.read_text(encoding="utf-8")), files.arms(file)
    runs = [files.folder(file) / name for name in arms]
    for run, settings in zip(runs, arms.values(), strict=True):
        live(run, settings, values.get("fork"))
        print(f"{run} is done", flush=True)
    write(file.parent / "results" / file.stem, values["question"], runs)


def live(run: Path, settings: dict[str, Any], fork: dict[str, Any] | None) -> None:
    """Run an arm to its end, or resume it."""
    task = settings.pop("task")
    if run.exists():
        refuse_other(run, tomllib.loads(config.load(task, settings).to_toml()))
        primordia.Run(run).resume()
    elif fork is None:
        primordia.run(task, run, **settings)
    else:
        primordia.load(run.parent.parent / fork["of"]).fork(fork["at"], run, **settings)


def refuse_other(run: Path, wanted: dict[str, Any]) -> None:
    """Exit if a run has other settings than those wanted."""
    present = tomllib.loads((run / "config.toml").read_text(encoding="utf-8"))
    if {**present, "fork": wanted["fork"]} != wanted:
        sys.exit(f"{run} was started with other settings; remove it to run it again")


if __name__ == "__main__":
    files.for_each_named(experiment, __doc__)
