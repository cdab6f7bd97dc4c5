"""Fill the pages of the documents with figures from committed tables (`make figures`).

    python docs/templates/fill.py

Each page with measured figures has a template in Jinja2: `docs/results/atari.md` is made from
`docs/templates/results/atari.md`. In a template, a figure is an expression over a table, such as
`{{ cell("cartpole/heredity", "no-heredity", "births to saturation").median }}`. So no sentence can say
another figure than its table. A table is named by its folder below `experiments` and its name in
`results/` there. A test fills all templates and compares them with the pages.
"""

import re
import tomllib
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pandas as pd
import reference
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from primordia import config
from primordia.comparison.pairs import sign_test
from primordia.comparison.tables import number_text, spread_text
from primordia.settings.tables import tasks

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
HEAD = "<!-- `make figures` makes this page from docs/templates/{}; edit that file. -->\n\n"
UNSEEN = 1_000
"""Settings were chosen on worlds of smaller seeds."""
IN_WORDS = {5: "five"}
SPREAD = re.compile(r"(.+?) \((.+?) to (.+?)\)")


class Cell(str):
    """A cell of a table, such as `392 (330 to 470)`: the text, with its parts."""

    @property
    def median(self) -> str:
        """The text before the brackets; all of it if there are none."""
        return found[1] if (found := SPREAD.fullmatch(self)) else str(self)

    @property
    def interval(self) -> str:
        """The text in the brackets."""
        found = SPREAD.fullmatch(self)
        if found is None:
            raise ValueError(f"no interval in {self!r}")
        return f"{found[2]} to {found[3]}"


class Effect(NamedTuple):
    """An arm against the reference: Cliff's delta, and the ratio of medians."""

    delta: str
    ratio: Cell


@cache
def rows(name: str) -> pd.DataFrame:
    """Return a table's CSV: a row for each world, or for each world and way to play."""
    return pd.read_csv(_path(name, "csv"))


@cache
def table(name: str, number: int = 0) -> str:
    """Return a table of a Markdown file as it stands, counted from 0."""
    text = _path(name, "md").read_text(encoding="utf-8")
    found = re.findall(r"(?:^\|.*\|\n?)+", text, re.MULTILINE)
    return str(found[number]).rstrip("\n")


def cell(name: str, row: str, column: str, number: int = 0, way: str | None = None) -> Cell:
    """Return the cell of a Markdown table at a column, in the row that begins with `row`, and `way`."""
    head, _, *body = [
        [text.strip() for text in line.strip("|").split("|")]
        for line in table(name, number).splitlines()
    ]
    wanted = [row] if way is None else [row, way]
    return Cell(next(each for each in body if each[: len(wanted)] == wanted)[head.index(column)])


def effect(name: str, arm: str, column: str) -> Effect:
    """Return the effect of an arm on an outcome, from the last table of a file of results."""
    whole, *others = cell(name, arm, column, -1).split("; ")
    ratio = next(part for part in others if SPREAD.fullmatch(part) and part[0] in ">0123456789")
    return Effect(whole.split()[0], Cell(ratio))


class Against(NamedTuple):
    """How many calibrated mutations improve more or fewer mutants than scales do."""

    as_many: int
    """the interval of the difference includes zero"""
    more: int
    fewer: int


def against(tasks: Sequence[str]) -> Against:
    """Count the calibrated mutations in the tables of some tasks' founders."""
    column, signs = "a tenth longer, against a scale", []
    for task in tasks:
        for differs in ("differs 0", "differs 0.02", "differs 0.05", "differs 0.1"):
            low, high = map(float, cell(f"mutation/{task}", differs, column).interval.split(" to "))
            signs.append((low > 0) - (high < 0))
    return Against(signs.count(0), signs.count(1), signs.count(-1))


def least_of_best(mutation: str, tasks: Sequence[str]) -> float:
    """Return the share a tenth longer, of the best scale's, in the task where that is least.

    Tasks in which no scale makes any mutant a tenth longer are left out.
    """

    def share(task: str, row: str) -> float:
        return float(cell(f"mutation/{task}", row, "a tenth longer").median)

    scales = [f"scale {each}" for each in ("0.001", "0.003", "0.01", "0.03", "0.1", "0.3")]
    best = {task: max(share(task, each) for each in scales) for task in tasks}
    return min(share(task, mutation) / most for task, most in best.items() if most > 0.003)


MISSING = "not measured"
"""What a table of standings says where a group did not play."""


def games(name: str, who: str, way: str, outcome: str = "lifespan") -> pd.Series:
    """Return each world's median organism's median game; empty if they did not play."""
    found = rows(f"{name}-games")
    found = found[(found["who"] == who) & (found["way"] == way)]
    return found.groupby("seed" if "seed" in found else "world")[outcome].median()


def played(name: str, who: str, way: str, outcome: str = "lifespan") -> Cell:
    """Return the median and quartiles over worlds of an outcome of games."""
    found = games(name, who, way, outcome)
    return Cell(spread_text(found) if len(found) else MISSING)


class Standings(NamedTuple):
    """How four groups play: the rows that every evaluation shows."""

    champion: Cell
    alive: Cell
    best: Cell
    """of as many founders"""
    founder: Cell


def standings(
    name: str,
    way: str,
    arm: str = "heredity",
    control: str = "no-heredity",
    outcome: str = "lifespan",
) -> Standings:
    """Return how the four groups of an experiment play.

    Tables of the first seeds name groups otherwise, and have the longest-lived of the arm without
    heredity as the best of founders, mostly chosen from more of them than heredity had births.
    """
    new = ("{arm}: champion", "{arm}: all alive", "best founder", "founder")
    old = ("{arm}", "{arm}, all alive", control, "a founder")
    groups = new if "seed" in rows(f"{name}-games") else old
    return Standings(*(played(name, who.format(arm=arm), way, outcome) for who in groups))


def unseen(name: str) -> bool:
    """Say whether an experiment was lived on seeds that nothing had been tried on."""
    return int(rows(name).seed.min()) >= UNSEEN


def worlds(name: str) -> str:
    """Say how many worlds each arm of an experiment has, and of which seeds."""
    count = rows(name).seed.nunique()
    kind = "unseen seeds" if unseen(name) else "the first seeds"
    return f"{IN_WORDS.get(count, count)} worlds of {kind}"


def seeds(name: str) -> str:
    """Say the same in a table: `20, unseen seeds`, or `5, first seeds`."""
    return f"{rows(name).seed.nunique()}, {'unseen' if unseen(name) else 'first'} seeds"


def seeds_of_games(name: str) -> str:
    """Say the same of the worlds whose organisms play."""
    found = rows(f"{name}-games")
    number = found["seed" if "seed" in found else "world"]
    return f"{number.nunique()}, {'unseen' if number.min() >= UNSEEN else 'first'} seeds"


def listed(values: Iterable[float]) -> str:
    """Return some values, such as one of each world, in their order."""
    return "; ".join(map(number_text, values))


def share(part: float, whole: float) -> str:
    """Return a share in per cent."""
    return f"{100 * part / whole:.0f} %"


def ratio(name: str, arm: str, to: str, column: str) -> str:
    """Return how many times the median of another arm that of an arm is."""
    own, others = (float(cell(name, each, column).median.replace(",", "")) for each in (arm, to))
    return f"{own / others:.1f}"


def budget(name: str, task: str) -> str:
    """Return the organism-ticks of a world whose cells are full all the time, in millions."""
    return f"{int(rows(name).ticks.max()) * config.load(task).cells / 1e6:.2g}"


def plan(name: str) -> config.Config:
    """Return the settings of an experiment's task, with the experiment's own cells and stop."""
    folder, stem = name.split("/")
    file = tomllib.loads((ROOT / "experiments" / folder / f"{stem}.toml").read_text("utf-8"))
    task = config.load(file["task"])
    stop = task.stop.model_copy(update=file["stop"])
    return task.model_copy(update={"cells": file.get("cells", task.cells), "stop": stop})


def planned(name: str) -> str:
    """Return the organism-ticks of a world of an experiment whose cells are always full, in millions."""
    settings = plan(name)
    assert settings.stop.ticks is not None
    return f"{settings.stop.ticks * settings.cells / 1e6:.2g}"


def searched(name: str, method: str, way: str, outcome: str = "score") -> str:
    """Return the median over seeds of what a search with a reward has found (`baselines.py`)."""
    if not _path(f"{name}-baselines", "csv").exists():
        return MISSING
    every = rows(f"{name}-baselines")
    found = every[(every["who"] == method) & (every["way"] == way)][outcome]
    return Cell(spread_text(found)).median


def ahead(name: str, arm: str, method: str, way: str) -> str:
    """Return the share of pairs of a world and a search in which the world's living live longer, in per
    cent; equal lives count half."""
    if not _path(f"{name}-baselines", "csv").exists():
        return MISSING
    every = rows(f"{name}-baselines")
    found = every[(every["who"] == method) & (every["way"] == way)]["lifespan"].to_numpy()
    own = games(name, f"{arm}: all alive", way).to_numpy()[:, None]
    return share(float((own > found).mean() + (own == found).mean() / 2), 1)


def chosen(habitat: str) -> dict[str, config.Config]:
    """Return the settings of the tasks that come with the package in a habitat, by task."""
    own = (task for task, values in tasks().items() if values["habitat"]["name"] == habitat)
    return {task: config.load(task) for task in own}


def pages() -> dict[Path, str]:
    """Return the text of each page that has a template."""
    filler = Environment(
        loader=FileSystemLoader(HERE),
        undefined=StrictUndefined,
        keep_trailing_newline=True,
        autoescape=False,
    )
    filler.globals.update(
        rows=rows,
        table=table,
        cell=cell,
        effect=effect,
        played=played,
        standings=standings,
        games=games,
        share=share,
        sign_test=sign_test,
        ratio=ratio,
        budget=budget,
        plan=plan,
        planned=planned,
        searched=searched,
        ahead=ahead,
        worlds=worlds,
        seeds=seeds,
        seeds_of_games=seeds_of_games,
        listed=listed,
        against=against,
        least_of_best=least_of_best,
        chosen=chosen,
        commands=reference.commands,
        settings=reference.settings,
        parts=reference.parts,
        changes=reference.changes,
        islands=reference.islands,
        traits=reference.traits,
        seasons=reference.seasons,
    )
    filler.filters.update(number=number_text)
    names = sorted(path.relative_to(HERE).as_posix() for path in HERE.rglob("*.md"))
    return {
        HERE.parent / name: HEAD.format(name) + filler.get_template(name).render() for name in names
    }


def _path(name: str, kind: str) -> Path:
    folder, _, stem = name.partition("/")
    return ROOT / "experiments" / folder / "results" / f"{stem}.{kind}"


if __name__ == "__main__":
    for page, text in pages().items():
        page.write_text(text, encoding="utf-8")
        print(page.relative_to(ROOT))
