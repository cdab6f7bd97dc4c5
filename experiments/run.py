"""Run experiments to their end and write what came out.

    python experiments/run.py experiments/cartpole/*.toml

An experiment is a TOML file: a `question`, the settings that all arms share, and `[[arms]]`, each
with a `name` and what is different in it; the first arm is the reference. Arms live in
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
    values = tomllib.loads(file.read_text(encoding="utf-8"))
    question, arms = values.pop("question"), values.pop("arms")
    runs = []
    for arm in arms:
        runs.append(files.folder(file) / arm.pop("name"))
        live(runs[-1], config.merged(values, arm))
        print(f"{runs[-1]} is done", flush=True)
    write(file.parent / "results" / file.stem, question, runs)


def live(run: Path, settings: dict[str, Any]) -> None:
    """Run an arm to its end, or go on with it."""
    task = settings.pop("task")
    if not run.exists():
        primordia.run(task, run, **settings)
        return
    wanted = tomllib.loads(config.load(task, settings).to_toml())
    if tomllib.loads((run / "config.toml").read_text()) != wanted:
        sys.exit(f"{run} was begun with other settings; remove it, and it is run again")
    primordia.Run(run).resume()


if __name__ == "__main__":
    files.each(experiment, __doc__)
