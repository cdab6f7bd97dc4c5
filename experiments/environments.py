"""Which environments of other libraries can be lived in, how fast, how exactly, and does anything evolve?

    python experiments/environments.py [ENV ...]

Nothing has to be run before. ENV is a name that `primordia new` takes, such as gym:Hopper-v5. By default
all classic-control, toy-text, Box2D and MuJoCo environments of Gymnasium are tried, in their newest
version, and those IN_JAX. Each gets a task file (`primordia new`), which is not edited. A run of it is
killed and resumed, and must end as one that was not killed; the life of its champion is filmed. Then
WORLDS worlds live with heredity, and as many without: for TICKS, or for LONGER if the ratio of both may
be 1 after that. If it still may, the table says how far length of life is inherited. The table goes to
`results/` of the folder `environments` beside this file, as CSV and Markdown; rows of other environments
stay.
"""

import json
import re
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pandas as pd
from games import write_rows

from primordia.api import Run
from primordia.comparison.pace import pace
from primordia.comparison.resample import interval, resamples
from primordia.experiments.results import table

RESULTS = Path(__file__).parent / "environments" / "results" / "environments"
WORLDS, CELLS, TICKS, LONGER = 10, 16, 2_000, 10_000
SMALL = ["--cells", "8", "--ticks", "600", "--quiet"]
PATIENCE = 3_600
"""Seconds that one command may take; an environment that needs more is reported as too slow."""
FAMILIES = ("classic_control", "toy_text", "box2d", "mujoco")
IN_JAX = (
    "CartPole-v1",
    "Acrobot-v1",
    "MountainCar-v0",
    "MountainCarContinuous-v0",
    "Pendulum-v1",
    "Catch-bsuite",
    *(
        f"{name}-MinAtar"
        for name in ("Asterix", "Breakout", "Freeway", "Seaquest", "SpaceInvaders")
    ),
    "Craftax-Classic-Symbolic-v1",
)
COLUMNS = {
    "env": "environment",
    "saving": "goes on by",
    "resumed": "killed and resumed",
    "filmed": "filmed",
    "rate": "ticks a second",
    "ticks": "ticks",
    "late": "late, ticks for each death",
    "without": "without heredity",
    "ratio": "ratio (95 %)",
    "why": "if the ratio may be 1",
    "note": "note",
}


def environments() -> list[str]:
    """Return the environments of FAMILIES, each in its newest version, and those IN_JAX."""
    newest: dict[str, Any] = {}
    for spec in gymnasium.registry.values():
        family = str(spec.entry_point).removeprefix("gymnasium.envs.").partition(".")[0]
        of_older = newest.get(spec.name)
        if family in FAMILIES and (of_older is None or spec.version > of_older.version):
            newest[spec.name] = spec
    return [*(f"gym:{spec.id}" for spec in newest.values()), *(f"gymnax:{name}" for name in IN_JAX)]


def report(env: str, folder: Path) -> dict[str, Any]:
    """Try an environment -> its row of the table."""
    row: dict[str, Any] = dict.fromkeys(COLUMNS, "") | {"env": env}
    file = folder / "task.toml"
    done = command("new", file, "--env", env)
    if done.returncode:
        return row | {"note": done.stderr.strip().removeprefix("primordia: ")}
    text = file.read_text(encoding="utf-8")
    faults = re.findall("^# Found: (.*)[.]$", text.replace("\n#   ", " "), re.MULTILINE)
    saving = tomllib.loads(text)["habitat"].get("saving", "snapshot")
    row |= {"saving": saving, "note": "; ".join(faults)}
    try:
        row["resumed"] = "equal" if same_after_a_kill(file, folder) else "NOT EQUAL"
        filmed = command("replay", folder / "whole", "--out", folder / "life.mp4", "--to", 100)
        row["filmed"] = "yes" if filmed.returncode == 0 else filmed.stderr.strip()
        if "Random actions live" not in text:
            return row | {"note": "no life ends in random play, so its task needs another `fatal`"}
        row |= evolved(file, folder, TICKS)
        if row["why"].startswith("every life"):
            return row
        return row | evolved(file, folder, LONGER) if row["why"] else row
    except subprocess.TimeoutExpired:
        return row | {"note": f"a command takes more than {PATIENCE} s"}


def command(*words: object) -> "subprocess.CompletedProcess[str]":
    """Run a command of primordia."""
    line = [sys.executable, "-m", "primordia", *map(str, words)]
    return subprocess.run(line, capture_output=True, text=True, timeout=PATIENCE, check=False)


def same_after_a_kill(file: Path, folder: Path) -> bool:
    """Return whether a run that is killed and resumed ends with the digest of one that is not."""
    command("run", file, "--out", folder / "whole", *SMALL)
    killed = folder / "killed"
    words = ["run", file, "--out", killed, "--checkpoint-every", "0.1", *SMALL]
    process = subprocess.Popen([sys.executable, "-m", "primordia", *map(str, words)])
    while process.poll() is None and not list(killed.glob("checkpoints/*/manifest.json")):
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    command("resume", killed, "--ticks", "600", "--quiet")
    digests = [
        json.loads(command("info", each, "--json").stdout)["digest"]
        for each in (folder / "whole", killed)
    ]
    return digests[0] == digests[1]


def evolved(file: Path, folder: Path, ticks: int) -> dict[str, Any]:
    """Return the rate of a run, and late life with heredity beside that without, over worlds."""
    runs = {arm: folder / f"{arm}-{ticks}" for arm in ("parent", "founder")}
    late, rates = {}, []
    for arm, run in runs.items():
        words = ["--seed", 1000, "--seeds", WORLDS, "--cells", CELLS, "--ticks", ticks, "--quiet"]
        command("run", file, "--out", run, "--inheritance", arm, *words, "--until", "none")
        info = json.loads(command("info", run, "--json").stdout)
        lived = sum(world["organism_ticks"] for world in info["worlds"])
        rates.append(lived / info["wall_s"])
        lives = Run(run).opened().lives
        worlds = [lives.of_world(number) for number in range(WORLDS)]
        late[arm] = pace(worlds, 0, ticks).late.value
    one, other = late["parent"], late["founder"]
    ratios = np.concatenate(
        [
            np.median(one[rows], axis=-1) / np.median(other[rows], axis=-1)
            for rows in resamples(WORLDS)
        ]
    )
    low, high = interval(ratios)
    return {
        "rate": f"{np.mean(rates):,.0f}",
        "ticks": f"{ticks:,}",
        "late": f"{np.median(one):,.0f}",
        "without": f"{np.median(other):,.0f}",
        "ratio": f"{np.median(one) / np.median(other):.2f} ({low:.2f} to {high:.2f})",
        "why": reason(Run(runs["parent"]), one, other, ticks) if low <= 1 <= high else "",
    }


def reason(run: Run, late: np.ndarray, without: np.ndarray, ticks: int) -> str:
    """Say why late life with heredity, (W,), may be as long as late life without."""
    whole_quarter = CELLS * ticks / 4
    if np.median(late) == np.median(without) == whole_quarter:
        return "with heredity and without, nothing dies in the last quarter of most worlds"
    return inherited(run)


def inherited(run: Run) -> str:
    """Say how far length of life is inherited in a run."""
    lives = run.lives()
    lifespans = np.unique(lives.lifespan[lives.died])
    if len(lifespans) == 1:
        return f"every life has {lifespans[0]} tick{'s' if lifespans[0] > 1 else ''}"
    slopes = [world.both.slope for world in run.heredity() if world.both.slope is not None]
    if not slopes:
        return "too few children died to say how far length of life is inherited"
    return f"a child's log lifespan on its parent's: slope {np.median(slopes):.2f}"


def main() -> None:
    """Try the environments that the command line names, or all, and write the table."""
    rows: dict[str, dict[str, Any]] = {}
    if RESULTS.with_suffix(".csv").exists():
        before = pd.read_csv(RESULTS.with_suffix(".csv"), keep_default_na=False, dtype=str)
        rows = {row["env"]: row for row in before.to_dict("records")}
    for env in sys.argv[1:] or environments():
        with tempfile.TemporaryDirectory() as folder:
            rows[env] = report(env, Path(folder))
        lines = [[row.get(name, "") for name in COLUMNS] for row in rows.values()]
        note = (
            f"{WORLDS} worlds of {CELLS} cells, seeds from 1,000 on. Medians over worlds of the last"
            " quarter; the ratio of medians with its interval over resampled worlds. Where the interval"
            f" includes 1 after {TICKS:,} ticks, {LONGER:,} were lived. Slopes are medians over worlds."
            " Rates were measured beside other work."
        )
        text = f"{table(list(COLUMNS.values()), lines)}\n\n{note}"
        write_rows(RESULTS, list(rows.values()), text)
        print(rows[env], flush=True)


if __name__ == "__main__":
    main()
