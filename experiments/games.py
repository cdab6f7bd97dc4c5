"""Let the champion of every world of an experiment play, in its own game and in others, with controls.

    python experiments/games.py experiments/atari/*.toml experiments/robots/*.toml

The experiments must have been run (`primordia experiment`). An Atari player plays in four ways: the game
of its task; games with sticky buttons and no-ops at the start; the game of its task with frozen senses;
and the games with sticky buttons blindly, with the buttons that it pressed in the game of its task. If
the task has all this noise, the first way is left out. Games of robots and poles all begin differently.
Robots and organisms of gymnax play fresh games in three ways: seeing, with frozen senses, and blindly.
Pole balancers play fresh games.

The longest-lived of many may be as good by luck as by descent. So all organisms that are alive at the
end play one unknown game each, in gymnax in each of the three ways. As many founders as each world of
the reference had births, at most MOST, live one life; the longest-lived of them plays as champions do.
Founders as they come play as all that are alive do. The table goes to `results/` beside the file, as
Markdown and CSV, and grows with each group.
"""

import csv
import io
from collections.abc import Iterator
from pathlib import Path
from statistics import fmean
from typing import Any

import named

import primordia
from primordia import files
from primordia.assays.controls import OUTCOMES, Group, Standing, evolved, unevolved
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table
from primordia.runs.records import Records

GAMES = 5
TICKS = 20_000
MOST = 10_000
"""Largest number of founders of a world among which the best is chosen."""
NOISE = {"sticky": 0.25, "noops": 30}
FRESH: dict[str, dict[str, Any]] = {
    "fresh starts": {},
    "senses frozen": {"senses": "frozen"},
    "blindly": {"senses": "ignored"},
}
WAYS: dict[str, dict[str, dict[str, Any]]] = {
    "atari": {
        "own game": {},
        "sticky, no-ops": {"habitat": NOISE},
        "senses frozen": {"senses": "frozen"},
        "blindly, sticky, no-ops": {"senses": "ignored", "habitat": NOISE},
    },
    "cartpole": {"fresh starts": {}},
    "gymnax": FRESH,
    "mujoco": FRESH,
}
COMPILED = ("gymnax",)
"""habitats in which whole populations can play in all ways, since games are fast"""
UNKNOWN = dict.fromkeys(WAYS, "fresh starts") | {"atari": "sticky, no-ops"}
"""the way in which organisms that were not chosen play in the other habitats"""


def report(file: Path) -> None:
    """Let the organisms of an experiment play and write the table."""
    rows, stem = [], file.parent / "results" / f"{file.stem}-games"
    for number, folder in enumerate(named.arms(file)):
        run = primordia.load(folder).opened()
        for name, group in players_of(run, folder.name, also_founders=number == 0):
            rows += played(name, run, group)
            write_rows(stem, rows, summary(rows))


def players_of(run: Records, arm: str, *, also_founders: bool) -> Iterator[tuple[str, Group]]:
    """Yield an arm's organisms, then founders, with their names. The founders are chosen only then."""
    for group in evolved(run):
        yield f"{arm}: {group.name}", group
    for group in unevolved(run, MOST) if also_founders else ():
        yield group.name, group


def played(name: str, run: Records, group: Group) -> list[dict[str, Any]]:
    """Let organisms play and return a row for each world and way."""
    habitat, rows = str(run.config.habitat["name"]), []
    ways = WAYS[habitat]
    if NOISE.items() <= run.config.habitat.items():  # its own games are such games
        ways = {way: options for way, options in ways.items() if way != "own game"}
    if group.chosen_from == 1 and habitat not in COMPILED:
        ways = {UNKNOWN[habitat]: ways[UNKNOWN[habitat]]}
    for way, options in ways.items():
        standing = group.evaluate(games=GAMES, ticks=TICKS, **options)
        rows += [{"who": name, "way": way, **row} for row in worlds_of(standing, run)]
        print(f"{name}: {way} is done", flush=True)
    return rows


def worlds_of(standing: Standing, run: Records) -> list[dict[str, Any]]:
    """Return a row for each world: its seed, the median organism's median game, and the mean score."""
    found = {name: standing.by_world(name) for name in OUTCOMES}
    outcomes = {name: of for name, of in found.items() if of}
    rows = []
    for world in outcomes["lifespan"]:
        each = [one for one in standing.evaluations if one.world == world]
        row = {"seed": int(run.world_seeds[world]), "organisms": len(each)}
        row |= {"organism": each[0].organism if standing.chosen_from > 1 else ""}
        row |= {"games": each[0].games, "distinct": max(one.distinct for one in each)}
        row |= {name: round(of[world], 2) for name, of in outcomes.items()}
        if "score" in outcomes:  # published scores are means
            row["mean score"] = round(fmean(one.to_dict()["score"]["median"] for one in each), 2)
        rows.append(row)
    return rows


def write_rows(stem: Path, rows: list[dict[str, Any]], summary_text: str) -> None:
    """Write all rows to STEM.csv and their summary to STEM.md."""
    stem.parent.mkdir(parents=True, exist_ok=True)
    text = io.StringIO()
    sheet = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    sheet.writeheader()
    sheet.writerows(rows)
    files.write_text(stem.with_suffix(".csv"), text.getvalue())
    files.write_text(stem.with_suffix(".md"), summary_text + "\n")
    print(f"{stem}: .md .csv")


def summary(rows: list[dict[str, Any]]) -> str:
    """Return a table of medians and quartiles over worlds of the median organism's median game."""
    lines, outcomes = [], [name for name in OUTCOMES if name in rows[0]]
    for name, way in dict.fromkeys((row["who"], row["way"]) for row in rows):
        worlds = [row for row in rows if (row["who"], row["way"]) == (name, way)]
        cells = [spread_text([row[column] for row in worlds]) for column in outcomes]
        lines.append([name, way, len(worlds), sum(row["organisms"] for row in worlds), *cells])
    note = (
        f"Medians over worlds (quartiles) of the median organism's median game. Champions and best"
        f" founders play {GAMES} games; one is enough where nothing is drawn at random. The others play"
        " one each. The best founder of a world is the longest-lived of as many founders as the reference"
        f" had births there, at most {MOST:,}. Where nothing is drawn at random, the own game of a"
        " champion or best founder is the one that chose it; the others are not. Games were cut after"
        f" {TICKS:,} ticks."
    )
    return f"{table(['who', 'plays', 'worlds', 'organisms', *outcomes], lines)}\n\n{note}"


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
