"""Archipelagos: habitats made of habitats, each in a stretch of a world's cells.

All organisms have one kind of brain. So every island takes the senses and actions of all: its own
senses are followed by zeros, and a button or a motor that it lacks does nothing. Each island's
bodies are stepped in a batch of their own.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.tree_util import register_dataclass

from primordia.errors import InputError
from primordia.habitats.around import Composed
from primordia.habitats.contract import (
    Ability,
    AnyHabitat,
    Bodies,
    HostHabitat,
    JaxHabitat,
    Outcome,
)
from primordia.habitats.on_island import IslandInJax, IslandOnHost, Union
from primordia.settings.islands import ARRAYS, Islands


@register_dataclass
@dataclass(frozen=True)
class Parts:
    """Bodies of all islands of W worlds: those of island k have W x sizes[k] rows, world by world."""

    island: tuple[Bodies, ...]
    sizes: tuple[int, ...] = field(metadata={"static": True})


def _common(values: Iterable[Any]) -> Any:
    """Return the value if all are equal, otherwise None."""
    different = set(values)
    return different.pop() if len(different) == 1 else None


class Archipelago(Composed):
    """What archipelagos in JAX and on the host have in common."""

    habitats: tuple[Any, ...]

    def __init__(self, habitats: Sequence[AnyHabitat], islands: Islands) -> None:
        union = Union.of(habitats, islands.names)
        kind = IslandInJax if isinstance(habitats[0], JaxHabitat) else IslandOnHost
        self.islands = islands
        self.habitats = tuple(kind(each, union) for each in habitats)
        self.senses_size, self.action, self.words = union.senses, union.action, union.words
        self.buttons = union.buttons or None
        self.rate = _common(each.rate for each in habitats)
        self.episode = _common(each.episode for each in habitats)
        self.exact = all(each.exact for each in habitats)
        self.versions = {k: v for each in habitats for k, v in each.versions.items()}
        self.tallies = union.tallies
        self._key = (type(self), self.habitats, islands)

    def original(self) -> Any:
        """Return the islands as the standard benchmarks score them; None if one has no original."""
        originals = [each.original() for each in self.habitats]
        return None if None in originals else type(self)(originals, self.islands)

    def lacks(self, ability: Ability) -> list[str]:
        """Return the methods that one of the habitats lacks for an ability."""
        return next((lacks for each in self.habitats if (lacks := each.lacks(ability))), [])


class ArchipelagoInJax(Archipelago, JaxHabitat):
    """Islands in JAX. Its functions take the bodies of whole worlds, `Parts`."""

    def reset(self, words: Array) -> Parts:
        """Return fresh bodies in all cells of W worlds; see `JaxHabitat.reset`."""
        parts = zip(self.habitats, split(words, self.islands.sizes), strict=True)
        return Parts(tuple(each.reset(own) for each, own in parts), self.islands.sizes)

    def sense(self, bodies: Parts) -> Array:
        """Return the senses of all cells; see `JaxHabitat.sense`."""
        each = zip(self.habitats, bodies.island, strict=True)
        return joined([habitat.sense(own) for habitat, own in each], self.islands.sizes)

    def step(self, bodies: Parts, action: Array) -> tuple[Parts, Outcome]:
        """Step all bodies by one tick; see `JaxHabitat.step`."""
        actions, sizes = split(action, self.islands.sizes), self.islands.sizes
        stepped = [
            habitat.step(own, chosen)
            for habitat, own, chosen in zip(self.habitats, bodies.island, actions, strict=True)
        ]
        after, outcomes = zip(*stepped, strict=True)
        return Parts(after, sizes), _outcome(outcomes, sizes)


class ArchipelagoOnHost(Archipelago, HostHabitat):
    """Islands on the host. Simulators in other processes step on all islands at the same time."""

    def open(self, cells: int, watched: bool = False) -> None:
        """Allocate a body for each of N cells of whole worlds; see `HostHabitat.open`."""
        numbers = np.arange(cells)
        self._of_cell = self.islands.of_cells(numbers % self.islands.bounds[-1])
        self._cells = [np.flatnonzero(self._of_cell == k) for k in range(self.islands.count)]
        self._row = np.zeros(cells, int)
        for habitat, own in zip(self.habitats, self._cells, strict=True):
            self._row[own] = np.arange(len(own))
            habitat.open(len(own), watched)

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells (K,); see `HostHabitat.reset`."""
        senses = np.zeros((len(cells), self.senses_size), np.float32)
        for number, habitat in enumerate(self.habitats):
            here = self._of_cell[cells] == number
            if here.any():
                senses[here] = habitat.reset(self._row[cells[here]], words[here])
        return senses

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies of living cells; see `HostHabitat.step`."""
        begun = [
            habitat.begin(action[own], alive[own])
            for habitat, own in zip(self.habitats, self._cells, strict=True)
        ]
        stepped = [finish() for finish in begun]
        sensed, outcomes = zip(*stepped, strict=True)
        senses = np.zeros((len(alive), self.senses_size), np.float32)
        for own, each in zip(self._cells, sensed, strict=True):
            senses[own] = each
        return senses, _outcome(outcomes, self.islands.sizes)

    def close(self) -> None:
        """Release what `open` allocated."""
        for each in self.habitats:
            each.close()

    def seen(self) -> Parts:
        """Return the bodies of all islands for `picture` and `caption`."""
        return Parts(tuple(each.seen() for each in self.habitats), self.islands.sizes)

    def tally(self) -> np.ndarray:
        """Return the counts of the present lives, int32 (N, K); 0 where an island has no such count."""
        return joined([each.tally() for each in self.habitats], self.islands.sizes)

    def message(self, cell: int) -> str:
        """Return why the body in a cell failed."""
        return self.habitats[self._of_cell[cell]].message(int(self._row[cell]))

    def save(self) -> dict[str, np.ndarray]:
        """Return the arrays of all islands, `island.K.NAME`, with a row for each cell of an island."""
        saved = {
            f"{ARRAYS}{number}.{name}": array
            for number, each in enumerate(self.habitats)
            for name, array in each.save().items()
        }
        return {**saved, **({"tally": self.tally()} if self.tallies else {})}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore what `save` returned."""
        for number, each in enumerate(self.habitats):
            prefix = f"{ARRAYS}{number}."
            own = {n.removeprefix(prefix): a for n, a in arrays.items() if n.startswith(prefix)}
            each.load(own)


def body_in(arrays: Mapping[str, np.ndarray], islands: Islands, place: int) -> dict[str, Any]:
    """Return the arrays of the body in one cell, (1, ...), by their names in a plain world.

    Args:
        arrays: arrays of a state, by name; those of bodies begin with `bodies`.
        islands: the islands of a world.
        place: the cell, counted over all worlds.
    """
    own, row, shared = "bodies", place, ("bodies.senses",)
    if islands.count > 1:
        number, row = _place_of(place, islands)
        own = f"bodies.{ARRAYS}{number}"
    found = {
        f"bodies{name.removeprefix(own)}": array[row : row + 1]
        for name, array in arrays.items()
        if name == own or (name.startswith(f"{own}.") and name not in shared)
    }
    return found | {name: arrays[name][place : place + 1] for name in shared if name in arrays}


def bodies_with(bodies: Bodies, habitat: AnyHabitat, place: int) -> tuple[Bodies, int]:
    """Return the bodies of the island of a cell, and the row of the cell's body among them.

    In a world without islands they are all bodies, and the cell itself.

    Args:
        bodies: the bodies of all worlds.
        habitat: the habitat of the worlds.
        place: the cell, counted over all worlds.
    """
    if not isinstance(habitat, Archipelago):
        return bodies, place
    number, row = _place_of(place, habitat.islands)
    return bodies.island[number], row


def _place_of(place: int, islands: Islands) -> tuple[int, int]:
    """Return the number of the island of a cell, counted over all worlds, and its row there."""
    world, cell = divmod(place, islands.bounds[-1])
    number = int(islands.of_cells(cell))
    return number, world * islands.sizes[number] + cell - islands.bounds[number]


def split(rows: Array, sizes: tuple[int, ...]) -> list[Array]:
    """Split an array (C, ...) of whole worlds by islands: (W x size, ...) each."""
    of_worlds = rows.reshape(-1, sum(sizes), *rows.shape[1:])
    parts = np.split if isinstance(rows, np.ndarray) else jnp.split
    each = parts(of_worlds, np.cumsum(sizes)[:-1].tolist(), axis=1)
    return [part.reshape(-1, *rows.shape[1:]) for part in each]


def joined(parts: Sequence[Any], sizes: tuple[int, ...]) -> Any:
    """Join arrays of islands (W x size, ...) into one of whole worlds (C, ...)."""
    each = [
        part.reshape(-1, size, *part.shape[1:]) for part, size in zip(parts, sizes, strict=True)
    ]
    join = np.concatenate if isinstance(parts[0], np.ndarray) else jnp.concatenate
    whole = join(each, axis=1)
    return whole.reshape(-1, *whole.shape[2:])


def _outcome(outcomes: Sequence[Outcome], sizes: tuple[int, ...]) -> Outcome:
    """Join the outcomes of islands; what one does not report is 0 or False, and 1 for a capacity."""

    def all_of(name: str, *results: Any) -> Any:
        if all(each is None for each in results):
            return None
        like = next(each for each in results if each is not None)
        counts = [len(outcome.fatal) for outcome in outcomes]
        filled = [
            np.full(count, name == "capacity", like.dtype) if each is None else each
            for each, count in zip(results, counts, strict=True)
        ]
        return joined(
            filled if isinstance(like, np.ndarray) else [*map(jnp.asarray, filled)], sizes
        )

    return Outcome(*map(all_of, Outcome._fields, *outcomes))


def archipelago(habitats: Sequence[AnyHabitat], islands: Islands) -> AnyHabitat:
    """Return the habitat of islands; a single island is its own habitat.

    Raises:
        InputError: the islands do not fit together; the message says why.
    """
    if len(habitats) == 1:
        return habitats[0]
    kinds = {each.kind for each in habitats}
    if len(kinds) > 1:
        named = zip(islands.names, habitats, strict=True)
        raise InputError(
            "habitat.islands: all islands must be in JAX, or all on the host; "
            + ", ".join(f"{n} is {WHERE[each.kind]}" for n, each in named)
        )
    if kinds == {"jax"}:
        return ArchipelagoInJax(habitats, islands)
    return ArchipelagoOnHost(habitats, islands)


WHERE = {"jax": "in JAX", "host": "on the host"}


def at(habitat: AnyHabitat, cell: int) -> AnyHabitat:
    """Return the habitat of a body in a cell of a world: an island, or the only habitat."""
    if not isinstance(habitat, Archipelago):
        return habitat
    return habitat.habitats[int(habitat.islands.of_cells(cell))]


def each_in(habitat: AnyHabitat) -> tuple[AnyHabitat, ...]:
    """Return the habitats of all islands, or the only habitat."""
    return habitat.habitats if isinstance(habitat, Archipelago) else (habitat,)
