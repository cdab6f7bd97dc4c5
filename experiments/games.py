"""Let the champion of every world of an experiment play, in its own game and in others.

    python experiments/games.py experiments/atari/*.toml experiments/robots/*.toml

The experiments must have been run (`primordia experiment`). An Atari player plays in four ways: the game
of its task; games with sticky buttons and no-ops at the start; the game of its task with frozen senses;
and the games with sticky buttons blindly, with the buttons that it pressed in the game of its task. The
games of robots all begin differently. A robot plays fresh games in three ways: seeing, with frozen
senses, and blindly. The first founder of each world of the reference plays too, as a control without
selection.

The longest-lived of many may be as good by luck as by descent. Therefore all organisms that are alive at
the end play one unknown game. The best of them in each world then play as the longest-lived did; their
unknown games are that one, and others. The table goes to `results/` beside the file, as Markdown and
CSV.
"""

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import named
import numpy as np

import primordia
from primordia.api import Run
from primordia.comparison.tables import number_text
from primordia.experiments.results import table
from primordia.organism.organism import Organism
from primordia.runs.directory import read_config

GAMES = 5
TICKS = 20_000
NOISE = {"sticky": 0.25, "noops": 30}
WAYS: dict[str, dict[str, dict[str, Any]]] = {
    "atari": {
        "own game": {},
        "sticky, no-ops": NOISE,
        "senses frozen": {"senses": "frozen"},
        "blindly, sticky, no-ops": {"senses": "ignored", **NOISE},
    },
    "mujoco": {
        "fresh starts": {},
        "senses frozen": {"senses": "frozen"},
        "blindly": {"senses": "ignored"},
    },
}
UNKNOWN = {"atari": "sticky, no-ops", "mujoco": "fresh starts"}
"""the way in which all organisms that are alive play"""
BEST = "{}, best of these"
"""label of the rows of the organisms that scored most among all that are alive"""
COLUMNS = ("lifespan", "score", "length")


def report(file: Path) -> None:
    """Let the organisms of an experiment play and write the table."""
    runs = named.arms(file)
    habitat = str(primordia.load(runs[0]).opened().config.habitat["name"])
    ways, unknown = WAYS[habitat], UNKNOWN[habitat]
    first = unforked([runs[0]])
    rows = played("a founder", first, founders(first), ways, GAMES)
    for run in runs:
        arm = primordia.load(run)
        rows += played(run.name, arm, longest_lived(run), ways, GAMES)
        one_game = played(f"{run.name}, all alive", arm, alive(run), {unknown: ways[unknown]}, 1)
        rows += one_game
        rows += played(BEST.format(run.name), arm, best(run, one_game), ways, GAMES)
        write_rows(file.parent / "results" / f"{file.stem}-games", rows, summary(rows))


def write_rows(stem: Path, rows: list[dict[str, Any]], summary_text: str) -> None:
    """Write all rows to STEM.csv and their summary to STEM.md."""
    stem.parent.mkdir(exist_ok=True)
    with stem.with_suffix(".csv").open("w", newline="", encoding="utf-8") as out:
        sheet = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
        sheet.writeheader()
        sheet.writerows(rows)
    stem.with_suffix(".md").write_text(summary_text + "\n", encoding="utf-8")
    print(f"{stem}: .md .csv")


def longest_lived(run: Path) -> list[Organism]:
    """Return the champion of each world in which anything was born since the run began."""
    opened = primordia.load(run).opened()
    lives = opened.lives
    worlds = np.unique(lives.world[lives.late()]).tolist()
    return [Organism(opened, lives.oldest(world)) for world in worlds]


def unforked(runs: Sequence[Path]) -> Run:
    """Return the runs that forks go back to; runs that are no forks are returned themselves."""
    arm = primordia.load(runs)
    forks = [read_config(path).fork for path in arm.directories()]
    sources = [Path(fork.run) for fork in forks if fork is not None]
    return unforked(sources) if sources else arm


def founders(run: Run) -> list[Organism]:
    """Return the first organism that lived in each world."""
    opened = run.opened()
    lives = opened.lives
    return [Organism(opened, lives.row(0, world)) for world in range(lives.worlds)]


def alive(run: Path) -> list[Organism]:
    """Return the organisms of all worlds that are alive at the end."""
    opened = primordia.load(run).opened()
    return [Organism(opened, int(row)) for row in np.flatnonzero(~opened.lives.died)]


def best(run: Path, rows: list[dict[str, Any]]) -> list[Organism]:
    """Return the organism of each world that scored most in its one game."""
    opened = primordia.load(run).opened()
    rising = sorted(rows, key=lambda row: (row["score"], row["lifespan"]))
    last = {row["world"]: row["organism"] for row in rising}
    return [Organism(opened, opened.lives.row(last[world], world)) for world in sorted(last)]


def played(
    name: str,
    run: Run,
    organisms: list[Organism],
    ways: dict[str, dict[str, Any]],
    games: int,
) -> list[dict[str, Any]]:
    """Let organisms play in some ways and return a row for each organism and way."""
    rows = []
    for way, options in ways.items():
        evaluations = run.evaluate(organisms, games=games, ticks=TICKS, **options)
        for organism, evaluation in zip(organisms, evaluations, strict=True):
            outcome = evaluation.to_dict()
            row = {"who": name, "world": organism.world, "organism": organism.id}
            row |= {"age": organism.age, "way": way}
            row |= {count: outcome[count] for count in ("games", "distinct")}
            row |= {column: round(outcome[column]["median"], 2) for column in COLUMNS}
            row |= {f"best_{column}": round(outcome[column]["maximum"], 2) for column in COLUMNS}
            rows.append(row)
        print(f"{name}: {way} is done", flush=True)
    return rows


def summary(rows: list[dict[str, Any]]) -> str:
    """Return a table of medians over worlds of each world's median, with the least and the most."""
    lines = []
    for name, way in dict.fromkeys((row["who"], row["way"]) for row in rows):
        plays = [row for row in rows if (row["who"], row["way"]) == (name, way)]
        worlds = sorted({row["world"] for row in plays})
        cells = [
            spread([np.median([r[column] for r in plays if r["world"] == w]) for w in worlds])
            for column in COLUMNS
        ]
        lines.append([name, way, len(plays), *cells])
    note = (
        f"Medians over worlds (least to most) of the median in each world, and of each organism's over"
        f" {GAMES} games; all alive play one each. One is enough where nothing is drawn at random. Games"
        f" were cut after {TICKS:,} ticks."
    )
    return f"{table(['who', 'plays', 'organisms', *COLUMNS], lines)}\n\n{note}"


def spread(values: list[float]) -> str:
    """Return the median, the least and the most as text."""
    middle, least, most = (number_text(float(of(values))) for of in (np.median, min, max))
    return f"{middle} ({least} to {most})"


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
