"""Worlds and counts that are posed for the live view, without any law that would change them."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from primordia.law.placement import Placement
from primordia.law.world import Cause, Organisms, World, Worlds
from primordia.live.census import Census
from primordia.random.wide import wide


def posed(alive: list[list[int]], born: list[list[int]], tick: list[int], **more: Any) -> World:
    """Return worlds from (W, N) cells and W ticks; `more` has other columns of cells or of worlds."""
    cells, worlds = np.array(alive, bool).ravel(), len(tick)
    nothing: Any = None
    columns = {
        "births": [0] * worlds,
        "deaths": [[0] * len(Cause)] * worlds,
        "extinctions": [0] * worlds,
        "organism_ticks": [0] * worlds,
        "saturated": [-1] * worlds,
        "seed": list(range(worlds)),
        **{name: more[name] for name in more if name in Worlds._fields and name != "calm"},
    }
    organisms = dict.fromkeys(Organisms._fields, nothing)
    organisms |= {"alive": cells, "born": wide(np.array(born).ravel())}
    for name in ("number", "branch"):
        organisms[name] = wide(np.array(more.get(name, np.arange(len(cells)))).ravel())
    history = dict.fromkeys(Worlds._fields, nothing)
    history |= {"tick": wide(tick), "calm": np.array(more.get("calm", [0] * worlds), np.int32)}
    history |= {name: wide(values) for name, values in columns.items()}
    return World(Organisms(**organisms), Worlds(**history))


def law(cells: int, worlds: int = 1, topology: str = "ring", saturation_ticks: int = 99) -> Any:
    """Return what the view asks of a law."""
    placement = Placement.model_validate({"topology": topology})
    return SimpleNamespace(
        cells=cells, worlds=worlds, placement=placement, saturation_ticks=saturation_ticks
    )


def counted(worlds: int = 1, **counts: Any) -> Census:
    """Return a census with some counts; all others are 0, and no world is saturated."""
    names = ("tick", "alive", "births", "extinctions", "organism_ticks", "calm")
    columns: dict[str, Any] = {name: [0] * worlds for name in names}
    columns |= {"deaths": [[0] * len(Cause)] * worlds, "saturated": [-1] * worlds}
    single = {name: counts.pop(name, 0) for name in ("mean_age", "oldest")}
    arrays = {name: np.array(value, np.int64) for name, value in (columns | counts).items()}
    return Census(**arrays, mean_age=float(single["mean_age"]), oldest=single["oldest"])
