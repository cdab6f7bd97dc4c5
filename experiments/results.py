"""What came out of an experiment: a table for people, one row a world for programs, a figure."""

import csv
import datetime
import statistics
from pathlib import Path
from typing import Any

import late

import primordia
from primordia.cli.side_by_side import effect, ratio, setting, spread
from primordia.comparison.comparison import Comparison
from primordia.figures import style
from primordia.figures.comparison import draw

NOTE = (
    "Medians over worlds (quartiles); a world that stopped unsaturated is known only to be at least"
    " so late. Effects: Cliff's delta; ratio of medians (95 % interval over worlds)."
)


def write(stem: Path, question: str, runs: list[Path]) -> None:
    """STEM.md, STEM.csv and STEM.png; the first run is the reference."""
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
    with style.look():
        draw(compared).savefig(stem.with_suffix(".png"), dpi=200)
    print(f"{stem}: .md .csv .png")


def summary(compared: Comparison, infos: list[dict[str, Any]]) -> str:
    """A row an arm: medians over worlds, with quartiles."""
    names = list(compared.arms[0].settings)
    told = compared.outcomes
    head = ["", *names, "worlds", "saturated", "extinctions (median)", *told.values()]
    rows = [
        [
            arm.name,
            *map(setting, arm.settings.values()),
            arm.worlds,
            arm.saturated,
            f"{extinct(info):g}",
        ]
        + [spread(arm, outcome) for outcome in told]
        for arm, info in zip(compared.arms, infos, strict=True)
    ]
    return table(head, rows)


def extinct(info: dict[str, Any]) -> float:
    """How often the median world did."""
    return statistics.median(world["extinctions"] for world in info["worlds"])


def dying(compared: Comparison, ends: list[list[dict[str, float]]]) -> str:
    """A row an arm: what the worlds' deaths came to, each world's figure."""
    names = [name for name in late.COLUMNS if name in ends[0][0]]
    rows = [
        [arm.name, *("; ".join(f"{world[name]:,.0f}" for world in worlds) for name in names)]
        for arm, worlds in zip(compared.arms, ends, strict=True)
    ]
    return table(["world by world", *(late.COLUMNS[name] for name in names)], rows)


def effects(compared: Comparison) -> str:
    """A row an arm: Cliff's delta against the reference, and the ratio of the medians."""
    reference, *others = compared.arms
    rows = []
    for arm in others:
        found = [(compared.contrast(arm, outcome), outcome) for outcome in compared.outcomes]
        rows.append([arm.name, *(f"{effect(*each)}; {ratio(each[0])}" for each in found)])
    return table([f"against {reference.name}", *compared.outcomes.values()], rows)


def table(head: list[str], rows: list[list[Any]]) -> str:
    """Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def made(run: Path, info: dict[str, Any]) -> str:
    """When, up to where and with what."""
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
    """A row for each world of each arm; empty where it never saturated."""
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        moments = ["saturated_births", "saturated_tick"]
        counted = ["seed", "ticks", "births", "extinctions", "alive"]
        rows.writerow(["arm", *counted, *moments, "mean_lifespan", *(ends[0][0] if ends else ())])
        for number, (arm, info) in enumerate(zip(compared.arms, infos, strict=True)):
            for each, world in enumerate(info["worlds"]):
                at = world["saturation"] or {"births": "", "tick": ""}
                mean = f"{arm.figures['lifespan'].value[each]:.1f}"
                last = ends[number][each].values() if ends else ()
                counts = [world[name] for name in counted]
                rows.writerow([arm.name, *counts, at["births"], at["tick"], mean, *last])
