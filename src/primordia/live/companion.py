"""One organism beside its world: its picture, bars for its senses and memory, and its next action."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from PIL import Image, ImageDraw
from rich.segment import Segment

from primordia.compiled import shared
from primordia.engine.engine import Engine
from primordia.habitats.archipelago import at, bodies_with
from primordia.habitats.contract import AnyHabitat, Bodies, JaxHabitat
from primordia.habitats.framed import MARGIN, PAPER
from primordia.law.metabolism import ONE
from primordia.live import thoughts
from primordia.live.forms import Room
from primordia.live.paint import FAINT, Row, levels, photograph
from primordia.live.panel import STRONG
from primordia.live.thoughts import LABEL
from primordia.organism.inside import CHANGED, since_change
from primordia.organism.mind import Mind, perceiver, think
from primordia.random.wide import to_host, wide


class Body(NamedTuple):
    """What a habitat draws of one organism."""

    body: Bodies
    """the body alone, no first axis"""
    action: np.ndarray
    """the action that its brain chooses next"""


class Companion:
    """The organism that is shown: the oldest, or another one, until it dies."""

    def __init__(self) -> None:
        self._who: tuple[int, int] | None = None
        self._undrawn = set[str]()
        """islands whose habitats cannot draw; "" is a plain world"""

    def find(self, engine: Engine, alone: int | None, step: int = 0) -> int | None:
        """Return the organism's cell, on the axis of all worlds; None if nothing is alive.

        Args:
            engine: the run.
            alone: the world in which it lives; None for any.
            step: 1 for the next younger organism in place of the present one.
        """
        law, organisms = engine.law, engine.state.world.organisms
        here = (
            slice(0, None) if alone is None else slice(alone * law.cells, (alone + 1) * law.cells)
        )
        cells = here.start + np.flatnonzero(np.asarray(organisms.alive)[here])
        if not len(cells):
            self._who = None
            return None
        world, number = cells // law.cells, to_host(organisms.number)[cells].astype(np.int64)
        age = to_host(engine.state.world.worlds.tick)[world] - to_host(organisms.born)[cells]
        order = np.lexsort((cells, -age.astype(np.int64)))
        place = 0
        if self._who is not None:
            same = (world[order] == self._who[0]) & (number[order] == self._who[1])
            place = (int(same.argmax()) + step) % len(cells) if same.any() else 0
        chosen = order[place]
        self._who = int(world[chosen]), int(number[chosen])
        return int(cells[chosen])

    def rows(self, engine: Engine, alone: int | None, room: Room) -> list[Row]:
        """Draw the organism as it is now."""
        cell = self.find(engine, alone)
        if cell is None:
            return [[Segment("nothing is alive"[: room.width], FAINT)]]
        law, (organisms, worlds) = engine.law, engine.state.world
        world, number = self._who or (0, 0)
        habitat = at(engine.habitat, cell % law.cells)
        island = law.islands.names[int(law.islands.of_cells(cell % law.cells))]
        where = f" of world {world}" if law.worlds > 1 else ""
        where += f", on {island}" if island else ""
        title = f"organism {number:,} in cell {cell % law.cells:,}{where}"
        age = int(to_host(worlds.tick)[world]) - int(to_host(organisms.born)[cell])
        senses, memory, body = _perceived(engine, cell, world)
        facts = {"age": f"{age:,} ticks"}
        if law.metabolism is not None:
            facts["energy"] = f"{int(np.asarray(organisms.energy)[cell]) / ONE:,.1f}"
        if eaten := int(np.asarray(organisms.eaten)[cell]):
            facts["food eaten"] = f"{eaten / ONE:,.1f}"
        facts |= {"does next": _caption(habitat, body), "senses": levels(senses)}
        facts["memory"] = levels(memory)
        below = [_fact(name, text, room.width) for name, text in facts.items() if text]
        ago = since_change(habitat, body.body, age)
        below += thoughts.rows(engine, habitat, cell, senses, memory, ago, room.width)
        below = below[: max(room.height - 1, 0)]
        left = room.height - 1 - len(below)
        picture = self._picture(habitat, body, Room(room.width, left), (island, ago is not None))
        return [[Segment(title[: room.width], STRONG)], *picture, *below]

    def _picture(
        self, habitat: AnyHabitat, body: Body, room: Room, world: tuple[str, bool]
    ) -> list[Row]:
        """Return a picture of the body, with a frame if its world, an island, has changed.

        There are no rows if the habitat cannot draw the body.

        Emulators and many environments draw only bodies that are watched from birth. Other people
        wrote the code that draws, and an error in this code must not end the run.
        """
        island, changed = world
        if room.height < 4 or island in self._undrawn:
            return []
        try:
            pixels = np.asarray(habitat.picture(*body).convert("RGB"))
        except Exception:
            self._undrawn.add(island)
            return []
        if (pixels[:MARGIN] == np.array([*bytes.fromhex(PAPER[1:])], np.uint8)).all():
            pixels = pixels[MARGIN:]
        high, wide = pixels.shape[:2]
        zoom = min(room.width / wide, 2 * room.height / high)
        size = max(int(wide * zoom), 1), max(int(high * zoom) // 2 * 2, 2)
        small = Image.fromarray(pixels).resize(size, Image.Resampling.BOX)
        if changed:
            edges = (0, 0, size[0] - 1, size[1] - 1)
            ImageDraw.Draw(small).rectangle(edges, outline=CHANGED)
        return photograph(np.asarray(small))


def _caption(habitat: AnyHabitat, body: Body) -> str:
    try:
        return habitat.caption(*body)
    except Exception:  # see _picture
        return np.array2string(body.action, precision=2)


def _fact(name: str, text: str, width: int) -> Row:
    return [Segment(f"{name:<{LABEL}}", FAINT), Segment(text[: max(width - LABEL, 0)])]


def _perceived(engine: Engine, cell: int, world: int) -> tuple[np.ndarray, np.ndarray, Body]:
    """Return senses (S,), memory (M,), and the body of a cell's organism with its next action."""
    law, (organisms, worlds) = engine.law, engine.state.world

    def own(tree: Any, row: int = cell) -> Any:
        """Copy the organism's part of arrays, (1, ...) from (C, ...)."""
        return jax.tree.map(lambda leaf: np.array(np.asarray(leaf)[row : row + 1]), tree)

    def embodied(bodies: Bodies) -> Any:
        return own(*bodies_with(bodies, engine.habitat, cell))

    if isinstance(engine.habitat, JaxHabitat):
        seen = embodied(engine.state.bodies)
        here: Any = at(engine.habitat, cell % law.cells)
        senses = shared(type(here).sense, here)(seen)
    else:
        senses, seen = own(engine.state.bodies), embodied(engine.habitat.seen())
    seed, tick = (to_host(each)[world : world + 1] for each in (worlds.seed, worlds.tick))
    mind = Mind(own(organisms.genome), wide(seed), jnp.array([cell % law.cells], jnp.int32))
    memory, perceived = own(organisms.memory), perceiver(law)(senses, own(organisms.energy))
    thought = shared(think, law.alone)(mind, memory, perceived, wide(tick + np.uint64(1)))
    alone = jax.tree.map(
        lambda leaf: np.asarray(leaf)[0], (perceived, memory, seen, thought.action)
    )
    return alone[0], alone[1], Body(alone[2], alone[3])
