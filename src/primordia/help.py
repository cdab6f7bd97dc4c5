"""Text for people: settings explained, progress, and what happened."""

import json
import time
from typing import Any

from pydantic import Field
from pydantic_core import PydanticUndefined

from primordia.config import NONE, Config, setting_fields, values_of
from primordia.habitats import KNOWN, find
from primordia.loop import Status
from primordia.settings import Settings
from primordia.wide import to_host


def setting_rows(task: str | None) -> list[tuple[str, str]]:
    """Each setting with its value in a task (or by default), and what it means."""
    values = values_of(task) if task else {}
    fields = setting_fields(Config)
    try:
        found = [find(values["habitat"]["name"])] if "habitat" in values else map(find, KNOWN)
    except (LookupError, TypeError):
        found = []
    for habitat in found:
        fields |= setting_fields(habitat, "habitat.") if issubclass(habitat, Settings) else {}
    fields["habitat.name"] = Field(description=f"{', '.join(KNOWN)}, or module:Class")
    hidden = {"about", "task", "habitat"}
    return [
        (f"--{path}", f"{field.description or ''} [{_shown(values, path, field)}]")
        for path, field in fields.items()
        if path not in hidden
    ]


def _shown(values: dict[str, Any], path: str, field: Any) -> str:
    value: Any = values
    for part in path.split("."):
        value = value.get(part, PydanticUndefined) if isinstance(value, dict) else PydanticUndefined
    value = field.default if value is PydanticUndefined else value
    if value is None or value is PydanticUndefined:
        return NONE
    return json.dumps(value, default=str)


class Lines:
    """A listener that prints a plain line now and then."""

    EVERY = 2.0
    """seconds"""

    def __init__(self) -> None:
        self._last: tuple[float, int] | None = None

    def __call__(self, status: Status) -> None:
        """Print how far it is, if it is time. The first chunk is compilation, and not counted."""
        worlds = status.engine.state.world.worlds
        now, lived = time.perf_counter(), int(to_host(worlds.organism_ticks).sum())
        if self._last is None:
            self._last = now, lived
        since, before = self._last
        if now - since < self.EVERY:
            return
        self._last = now, lived
        print(
            f"{status.wall_s:6.1f} s  tick {to_host(worlds.tick).max():,}"
            f"  alive {int(status.engine.state.world.organisms.alive.sum()):,}"
            f"  births {to_host(worlds.births).sum():,}"
            f"  {(lived - before) / (now - since) / 1e6:.2f} M organism-ticks/s",
            flush=True,
        )


def summary(info: dict[str, Any]) -> str:
    """What happened, in a few lines."""
    worlds = info["worlds"]
    lines = [
        f"{info['task']}: {len(worlds)} world{'s' * (len(worlds) > 1)} of {info['cells']} cells"
    ]
    for world in worlds[:10]:
        lines.append(_world_line(world))
    if len(worlds) > 10:
        saturated = sum(world["saturation"] is not None for world in worlds)
        lines.append(f"  ... and {len(worlds) - 10} more; {saturated} of {len(worlds)} saturated")
    if not info["exact"]:
        lines.append("  not exact: parts of this run cannot be repeated bit for bit")
    return "\n".join(lines)


def _world_line(world: dict[str, Any]) -> str:
    causes = [f"{count:,} {cause}" for cause, count in world["deaths_by_cause"].items() if count]
    extinct = f", extinct {world['extinctions']} times" * bool(world["extinctions"])
    line = (
        f"  seed {world['seed']}: {world['ticks']:,} ticks, {world['births']:,} births, deaths: "
        f"{', '.join(causes) or 'none'}{extinct}\n    {world['alive']} alive"
    )
    if world["alive"]:
        line += f", mean age {world['mean_age']:,.0f}, oldest {world['oldest_age']:,}"
    if saturation := world["saturation"]:
        tick, births = saturation["tick"], saturation["births"]
        return f"{line}; saturated at tick {tick:,} after {births:,} births"
    return f"{line}; not saturated"
