"""Results of an experiment: a table for people, a row for each world for programs, and a figure."""

import csv
import datetime
import statistics
from pathlib import Path
from typing import Any

import late

import primordia
from primordia.cli.comparison_tables import (
    effect_text,
    quartiles_text,
    ratio_text,
    setting_text,
)
from primordia.comparison.comparison import Comparison
from primordia.figures import style
from primordia.figures.comparison import draw

NOTE = (
    "Medians over worlds (quartiles); a world that stopped unsaturated is known only to be at least"
    " so late. Effects: Cliff's delta; ratio of medians (95 % interval over worlds)."
)


def write(stem: Path, question: str, runs: list[Path]) -> None:
    """Write STEM.md, STEM.csv and STEM.png; the first run is the reference."""
    stem.parent.mkdir(exist_ok=True)
    compared = primordia.compare(*runs)
    infos = [primordia.Run(run).info() for run in runs]
    parts = [f"# {question}", summary(compared, infos), effects(compared), NOTE]
    ends = [late.last_deaths(run, compared) for run in runs] if "pace" in compared.outcomes else []
    if ends:
        parts.insert(2, dying(compared, ends))
    text = "\n\n".join([*parts, made(runs[0], infos[0])])
    stem.with_suffix(".md").write_text(text + "\n", encoding="utf-8")
    write_worlds(stem.with_suffix(".csv"), compared, infos, ends)
    with style.applied():
        draw(compared).savefig(stem.with_suffix(".png"), dpi=200)
    print(f"{stem}: .md .csv .png")


def summary(compared: Comparison, infos: list[dict[str, Any]]) -> str:
    """Return a table with a row for each arm: medians over worlds, with quartiles."""
    names = list(compared.arms[0].settings)
    outcomes = compared.outcomes
    head = ["", *names, "worlds", "saturated", "extinctions (median)", *outcomes.values()]
    rows = [
        [
            arm.name,
            *map(setting_text, arm.settings.values()),
            arm.worlds,
            arm.saturated,
            f"{extinct(info):g}",
        ]
        + [quartiles_text(arm, outcome) for outcome in outcomes]
        for arm, info in zip(compared.arms, infos, strict=True)
    ]
    return table(head, rows)


def extinct(info: dict[str, Any]) -> float:
    """Return the median number of extinctions of a world."""
    return statistics.median(world["extinctions"] for world in info["worlds"])


def dying(compared: Comparison, ends: list[list[dict[str, float]]]) -> str:
    """Return a table with a row for each arm: the figures of late deaths, world by world."""
    names = [name for name in late.COLUMNS if name in ends[0][0]]
    rows = [
        [arm.name, *("; ".join(f"{world[name]:,.0f}" for world in worlds) for name in names)]
        for arm, worlds in zip(compared.arms, ends, strict=True)
    ]
    return table(["world by world", *(late.COLUMNS[name] for name in names)], rows)


def effects(compared: Comparison) -> str:
    """Return a table with a row for each arm: Cliff's delta and the ratio of medians to the reference."""
    reference, *others = compared.arms
    rows = []
    for arm in others:
        contrasts = {outcome: compared.contrast(arm, outcome) for outcome in compared.outcomes}
        cells = [f"{effect_text(c, outcome)}; {ratio_text(c)}" for outcome, c in contrasts.items()]
        rows.append([arm.name, *cells])
    return table([f"against {reference.name}", *compared.outcomes.values()], rows)


def table(head: list[str], rows: list[list[Any]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def made(run: Path, info: dict[str, Any]) -> str:
    """Say when the experiment was run, with which versions, and where it stopped."""
    begun = datetime.date.fromtimestamp((run / "versions.json").stat().st_mtime)
    what = ", ".join(f"{name} {version}" for name, version in info["versions"].items())
    limits = [f"{name} {value}" for name, value in info["limits"].items() if value is not None]
    return f"Run on {begun} with {what}. Each world stopped at: {' or '.join(limits)}."


def write_worlds(
    path: Path,
    compared: Comparison,
    infos: list[dict[str, Any]],
    ends: list[list[dict[str, float]]],
) -> None:
    """Write a row for each world of each arm; the moment of saturation is empty if there was none."""
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        moments = ["saturated_births", "saturated_tick"]
        counted = ["seed", "ticks", "births", "extinctions", "alive"]
        rows.writerow(["arm", *counted, *moments, "mean_lifespan", *(ends[0][0] if ends else ())])
        for number, (arm, info) in enumerate(zip(compared.arms, infos, strict=True)):
            for w, world in enumerate(info["worlds"]):
                at = world["saturation"] or {"births": "", "tick": ""}
                mean = f"{arm.measured['lifespan'].value[w]:.1f}"
                last = ends[number][w].values() if ends else ()
                counts = [world[name] for name in counted]
                rows.writerow([arm.name, *counts, at["births"], at["tick"], mean, *last])
