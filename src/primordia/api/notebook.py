"""Runs as notebooks show them: a small HTML table, in the notebook's own colours."""

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

from primordia.experiments.status import CampaignStatus

MOST = 20
"""Largest number of worlds or arms that are listed."""
CELL = 'style="text-align: right; padding: 0.1em 0.7em"'


def of_run(info: dict[str, Any]) -> str:
    """Return a table of the worlds of a run; `info` is that of `history.info`."""
    worlds = info["worlds"]
    count = "1 world" if len(worlds) == 1 else f"{len(worlds):,} worlds"
    head = ("seed", "ticks", "births", "alive", "mean age", "oldest", "deaths", "saturated at tick")
    title = f"{info['task']}: {count} of {info['cells']:,} cells"
    return table(title, head, map(_world, worlds))


def _world(world: dict[str, Any]) -> tuple[str, ...]:
    numbers = [world[name] for name in ("ticks", "births", "alive", "mean_age", "oldest_age")]
    causes = world["deaths_by_cause"].items()
    deaths = ", ".join(f"{count:,} {cause}" for cause, count in causes if count)
    moment = world["saturation"]
    saturated = "" if moment is None else f"{moment['tick']:,}"
    return str(world["seed"]), *map(_number, numbers), deaths, saturated


def of_experiment(status: CampaignStatus) -> str:
    """Return a table of the arms of an experiment so far."""
    jobs = ", ".join(f"{count:,} {state}" for state, count in status.jobs.items() if count)
    head = ("arm", "worlds", "begun", "saturated", "ticks lived for each death")
    rows = [
        (arm.name, f"{arm.worlds:,}", f"{arm.begun:,}", f"{arm.saturated:,}", _number(arm.life))
        for arm in status.arms
    ]
    return table(f"{status.question} Jobs: {jobs}", head, rows)


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:,.0f}"


def table(title: str, head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return an HTML table; every text is escaped."""
    listed = list(rows)
    below = [f"and {len(listed) - MOST:,} more"] if len(listed) > MOST else []
    return "".join(
        [
            f"<p><strong>{escape(title)}</strong></p><table><thead>",
            _row("th", head),
            "</thead><tbody>",
            *(_row("td", row) for row in listed[:MOST]),
            "</tbody></table>",
            *(f"<p>{each}</p>" for each in below),
        ]
    )


def _row(kind: str, texts: Sequence[str]) -> str:
    return f"<tr>{''.join(f'<{kind} {CELL}>{escape(text)}</{kind}>' for text in texts)}</tr>"
