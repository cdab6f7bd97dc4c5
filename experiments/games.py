"""Let the longest-lived organism of every world of an experiment play, in its own game and in others.

    python experiments/games.py experiments/atari/*.toml experiments/robots/*.toml

For experiments that have been run (`experiments/run.py`). On the Atari each organism plays the game of
its task; games with sticky buttons and no-ops at the start; the first with frozen senses; and the second
blindly, doing what it did in the first. Robots, whose games all begin differently, play fresh ones,
seeing, with frozen senses and blindly. Beside them plays the first founder of each world of the
reference, which nothing has selected. Since the longest-lived of many may be as good by luck as by
descent, all that are alive at the end play an unknown game too; then those that scored most in it play
as the longest-lived did (their unknown games are that one, and others). The table goes to `results/`
beside the file, as Markdown and CSV.
"""

import csv
from pathlib import Path
from typing import Any

import files
import numpy as np

import primordia
from primordia.cli.side_by_side import number
from primordia.organism.organism import Organism
from primordia.runs.directory import read_config
from results import table

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
"""how all that are alive play"""
BEST = "{}, best of these"
"""what rows of those are called who scored most of all that are alive"""
COLUMNS = ("lifespan", "score", "length")


def report(file: Path) -> None:
    """Play, and write what came out."""
    runs = files.runs(file)
    habitat = read_config(runs[0]).habitat["name"]
    ways, unknown = WAYS[habitat], UNKNOWN[habitat]
    first = unforked(runs[0])
    rows = played("a founder", first, founders(first), ways, GAMES)
    for run in runs:
        rows += played(run.name, run, longest_lived(run), ways, GAMES)
        everyone = played(f"{run.name}, all alive", run, alive(run), {unknown: ways[unknown]}, 1)
        rows += everyone
        rows += played(BEST.format(run.name), run, best(run, everyone), ways, GAMES)
        write_rows(file.parent / "results" / f"{file.stem}-games", rows, summary(rows))


def write_rows(stem: Path, rows: list[dict[str, Any]], told: str) -> None:
    """STEM.csv with all rows, STEM.md with what they come to."""
    stem.parent.mkdir(exist_ok=True)
    with stem.with_suffix(".csv").open("w", newline="", encoding="utf-8") as out:
        sheet = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
        sheet.writeheader()
        sheet.writerows(rows)
    stem.with_suffix(".md").write_text(told + "\n", encoding="utf-8")
    print(f"{stem}: .md .csv")


def longest_lived(run: Path) -> list[Organism]:
    """Of each world."""
    opened = primordia.load(run).opened()
    everyone = opened.lives
    return [Organism(opened, everyone.oldest(world)) for world in range(everyone.worlds)]


def unforked(run: Path) -> Path:
    """The run that a fork goes back to; of any other, itself."""
    fork = read_config(run).fork
    return run if fork is None else unforked(Path(fork.run))


def founders(run: Path) -> list[Organism]:
    """The first that lived in each world."""
    opened = primordia.load(run).opened()
    everyone = opened.lives
    return [Organism(opened, everyone.row(0, world)) for world in range(everyone.worlds)]


def alive(run: Path) -> list[Organism]:
    """At the end, in all worlds."""
    opened = primordia.load(run).opened()
    return [Organism(opened, int(row)) for row in np.flatnonzero(~opened.lives.died)]


def best(run: Path, rows: list[dict[str, Any]]) -> list[Organism]:
    """Of each world, who scored most in its one game."""
    opened = primordia.load(run).opened()
    rising = sorted(rows, key=lambda row: (row["score"], row["lifespan"]))
    last = {row["world"]: row["organism"] for row in rising}
    return [Organism(opened, opened.lives.row(last[world], world)) for world in sorted(last)]


def played(
    name: str,
    run: Path,
    organisms: list[Organism],
    ways: dict[str, dict[str, Any]],
    games: int,
) -> list[dict[str, Any]]:
    """A row for each organism and way of playing."""
    rows = []
    for way, options in ways.items():
        found = primordia.Run(run).evaluate(organisms, games=games, ticks=TICKS, **options)
        for organism, told in zip(organisms, (each.to_dict() for each in found), strict=True):
            row = {"who": name, "world": organism.world, "organism": organism.id}
            row |= {"age": organism.age, "way": way}
            row |= {count: told[count] for count in ("games", "distinct")}
            row |= {column: round(told[column]["median"], 2) for column in COLUMNS}
            row |= {f"best_{column}": round(told[column]["maximum"], 2) for column in COLUMNS}
            rows.append(row)
        print(f"{name}: {way} is done", flush=True)
    return rows


def summary(rows: list[dict[str, Any]]) -> str:
    """Medians over worlds of each world's median, with the least and the most."""
    lines = []
    for name, way in dict.fromkeys((row["who"], row["way"]) for row in rows):
        mine = [row for row in rows if (row["who"], row["way"]) == (name, way)]
        worlds = sorted({row["world"] for row in mine})
        cells = [
            spread([np.median([r[column] for r in mine if r["world"] == w]) for w in worlds])
            for column in COLUMNS
        ]
        lines.append([name, way, len(mine), *cells])
    note = (
        f"Medians over worlds (least to most) of the median in each world, and of each organism's over"
        f" {GAMES} games; all alive play one each. One is enough where nothing is drawn at random. Games"
        f" were cut after {TICKS:,} ticks."
    )
    return f"{table(['who', 'plays', 'organisms', *COLUMNS], lines)}\n\n{note}"


def spread(values: list[float]) -> str:
    """Median, least and most."""
    middle, least, most = (number(float(of(values))) for of in (np.median, min, max))
    return f"{middle} ({least} to {most})"


if __name__ == "__main__":
    files.each(report, __doc__)
