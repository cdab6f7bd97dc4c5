"""Worlds, counts, views and a clock for tests of the live view, without a law that changes worlds."""

import io
from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
from rich.console import Console

from primordia.engine.engine import Engine
from primordia.engine.state import State
from primordia.law.events import BIRTHS, DEATHS, Rows
from primordia.law.placement import Placement
from primordia.law.world import Cause, Organisms, World, Worlds
from primordia.live.census import Census
from primordia.live.paint import Cells
from primordia.live.terminal import Keyboard
from primordia.live.view import View
from primordia.random.wide import Wide, wide
from primordia.runs.loop import Status
from primordia.settings.islands import Islands
from tests.worlds import MEADOW, config


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


def old(count: int) -> Cells:
    """Return old cells, each of its own line."""
    return Cells(np.arange(count), np.ones(count))


def law(
    cells: int,
    worlds: int = 1,
    topology: str = "ring",
    saturation_ticks: int = 99,
    islands: Islands | None = None,
) -> Any:
    """Return what the view asks of a law."""
    placement = Placement.model_validate({"topology": topology})
    return SimpleNamespace(
        alone="the law of an organism alone",
        cells=cells,
        worlds=worlds,
        placement=placement,
        islands=islands or Islands(("",), (0, cells)),
        saturation_ticks=saturation_ticks,
        interoception=False,
        perceived=lambda senses, energy: senses,
    )


def counted(worlds: int = 1, **counts: Any) -> Census:
    """Return a census with some counts; all others are 0, and no world is saturated."""
    names = ("tick", "alive", "births", "extinctions", "organism_ticks", "calm")
    columns: dict[str, Any] = {name: [0] * worlds for name in names}
    columns |= {"deaths": [[0] * len(Cause)] * worlds, "saturated": [-1] * worlds}
    single = {name: counts.pop(name, 0) for name in ("mean_age", "oldest")}
    arrays = {name: np.array(value, np.int64) for name, value in (columns | counts).items()}
    return Census(**arrays, mean_age=float(single["mean_age"]), oldest=single["oldest"])


NOTHING = tuple(
    Rows(np.zeros((1, columns.width), np.uint32), np.int32(0)) for columns in (BIRTHS, DEATHS)
)


def status(worlds: int = 3, tick: int = 100, **more: Any) -> Status:
    """Return the status of worlds of four cells.

    One organism is alive in the first world, two are in the second, and so on. Each world is a tick
    behind the one before it.
    """
    alive = [[int(cell <= world) for cell in range(4)] for world in range(worlds)]
    world = posed(alive, [[0] * 4] * worlds, [tick - at for at in range(worlds)], **more)
    engine: Any = SimpleNamespace(
        law=law(4, worlds), config=config(MEADOW, cells=4, seeds=worlds), longest=None,
        state=SimpleNamespace(world=world), events=SimpleNamespace(births=NOTHING[0], deaths=NOTHING[1]),
    )  # fmt: skip
    return Status(engine, 75.0)


def terminal(width: int, height: int) -> Console:
    """Return a terminal with all colours.

    rich keeps the codes of a style for the first terminal that it meets, so all have the same colours.
    """
    return Console(
        file=io.StringIO(),
        width=width,
        height=height,
        force_terminal=True,
        color_system="truecolor",
    )


class Pressed(Keyboard):
    """Keys of a terminal, of which one is pressed at each look; no time passes."""

    there = True

    def __init__(self, keys: Iterable[str] = "") -> None:
        super().__init__()
        self._keys = iter(keys)

    def pressed(self, seconds: float) -> str:
        """Return the next key, or "" after the last."""
        return next(self._keys, "")


def view(width: int = 100, height: int = 30, keyboard: Any = None) -> Any:
    """Return a view in such a terminal."""
    return View(terminal(width, height), keyboard=keyboard)


class Clock:
    """Seconds that pass only while something waits, or if a test sets them; it notes the waits."""

    def __init__(self) -> None:
        self.now, self.waits = 0.0, list[float]()

    def perf_counter(self) -> float:
        """Return the time."""
        return self.now

    def sleep(self, seconds: float) -> None:
        """Wait."""
        self.waits.append(seconds)
        self.now += seconds + 1e-9


def look_alive(made: Engine) -> None:
    """Pose four fifths of the cells as organisms of many ages, without events."""
    world, bodies = made.state
    cells = np.arange(len(world.organisms.alive), dtype=np.uint32)
    number, born = (Wide(jnp.zeros_like(cells), jnp.asarray(n)) for n in (cells, cells % 999))
    organisms = world.organisms._replace(alive=cells % 5 > 0, number=number, born=born)
    thousand = wide([1000] * made.law.worlds)
    worlds = world.worlds._replace(tick=thousand, births=thousand)
    made.state = State(World(organisms, worlds), bodies)
    made.advance = lambda _: made.events
