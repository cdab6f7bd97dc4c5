"""Archipelagos: habitats made of habitats, each in a stretch of a world's cells.

All organisms have one kind of brain. So every island takes the senses and actions of all: its own
senses are followed by zeros, and a button or a motor that it lacks does nothing. Each island's
bodies are stepped in a batch of their own.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.tree_util import register_dataclass

from primordia.errors import InputError
from primordia.habitats.around import AroundHost, AroundJax
from primordia.habitats.contract import (
    Ability,
    Action,
    AnyHabitat,
    Bodies,
    Continuous,
    Discrete,
    Habitat,
    HostHabitat,
    JaxHabitat,
    Outcome,
)
from primordia.settings.islands import ARRAYS, Islands

if TYPE_CHECKING:
    from PIL.Image import Image

IDLE = "noop"
"""The name of the button that does nothing."""


class _OnIsland:
    """What a habitat as one island of an archipelago has in common in JAX and on the host."""

    inner: Any

    def __init__(self, inner: AnyHabitat, union: "_Union") -> None:
        super().__init__(inner, union)  # type: ignore[call-arg]
        self.senses_size, self.action, self.words = union.senses, union.action, union.words
        self.tallies = union.tallies
        self._more = union.senses - inner.senses_size
        self._choice = _choices(inner, union)

    def _own(self, action: Any) -> Any:
        """Return the island's own actions for actions of the archipelago, (N,) or (N, A)."""
        if self._choice is not None:
            choice = self._choice if isinstance(action, np.ndarray) else jnp.asarray(self._choice)
            return choice[action]
        return action[:, : self.inner.action.size] if action.ndim == 2 else action

    def picture(self, body: Bodies, action: np.ndarray) -> "Image":
        """Return the island's picture."""
        return self.inner.picture(body, np.asarray(self._own(action[None]))[0])

    def caption(self, body: Bodies, action: np.ndarray) -> str:
        """Return the island's caption."""
        return self.inner.caption(body, np.asarray(self._own(action[None]))[0])


class _InJax(_OnIsland, AroundJax):
    """One island in JAX."""

    def reset(self, words: Array) -> Bodies:
        """Return fresh bodies; see `JaxHabitat.reset`."""
        return self.inner.reset(words[:, : self.inner.words])

    def sense(self, bodies: Bodies) -> Array:
        """Return the island's senses, followed by zeros, float32 (N, S)."""
        senses = self.inner.sense(bodies)
        return jnp.pad(senses, ((0, 0), (0, self._more))) if self._more else senses

    def step(self, bodies: Bodies, action: Array) -> tuple[Bodies, Outcome]:
        """Step bodies by one tick; see `JaxHabitat.step`."""
        return self.inner.step(bodies, self._own(action))


class _OnHost(_OnIsland, AroundHost):
    """One island on the host."""

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells (K,); see `HostHabitat.reset`."""
        return self._wide(self.inner.reset(cells, words[:, : self.inner.words]))

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies of living cells; see `HostHabitat.step`."""
        senses, outcome = self.inner.step(self._own(action), alive)
        return self._wide(senses), outcome

    def tally(self) -> np.ndarray:
        """Return the counts of all islands; those that this island lacks are 0, int32 (N, K)."""
        own = dict(zip(self.inner.tallies, self.inner.tally().T, strict=True))
        none = np.zeros(len(self.inner.tally()), np.int32)
        return np.stack([own.get(name, none) for name in self.tallies], axis=1)

    def _wide(self, senses: np.ndarray) -> np.ndarray:
        return np.pad(senses, ((0, 0), (0, self._more))) if self._more else senses


@dataclass(frozen=True)
class _Union:
    """What all islands of an archipelago share."""

    senses: int
    action: Action
    words: int
    tallies: tuple[str, ...]
    buttons: tuple[str, ...]
    """the names of all choices, of a Discrete action"""

    @classmethod
    def of(cls, habitats: Sequence[AnyHabitat], names: Sequence[str]) -> "_Union":
        """Return what the islands share.

        Raises:
            InputError: an island cannot take the actions of another one.
        """
        sizes = max(each.senses_size for each in habitats), max(each.words for each in habitats)
        actions = [each.action for each in habitats]
        kinds = {type(action) for action in actions}
        if len({*actions}) > 1 and (len(kinds) > 1 or not kinds <= {Discrete, Continuous}):
            raise InputError(
                "habitat.islands: all islands need the same kind of actions: choices, or amounts; "
                + ", ".join(f"{n} has {a}" for n, a in zip(names, actions, strict=True))
            )
        buttons: tuple[str, ...] = ()
        if isinstance(action := max(actions, key=lambda each: each.size), Discrete):
            named = [_buttons(each) for each in habitats]
            buttons = tuple(dict.fromkeys(name for own in named for name in own))
            for island, own in zip(names, named, strict=True):
                if IDLE not in own and (lacking := [each for each in buttons if each not in own]):
                    raise InputError(
                        f"habitat.islands: {island} lacks the button {lacking[0]!r} of another island,"
                        " and has no button that does nothing; give all islands the same actions"
                    )
            action = Discrete(len(buttons))
        elif isinstance(action, Continuous) and len({*actions}) > 1:
            action = Continuous(action.size)
        tallies = tuple(dict.fromkeys(name for each in habitats for name in each.tallies))
        return cls(sizes[0], action, sizes[1], tallies, buttons)


def _buttons(habitat: AnyHabitat) -> tuple[str, ...]:
    return habitat.buttons or tuple(map(str, range(habitat.action.size)))


def _choices(habitat: AnyHabitat, union: _Union) -> np.ndarray | None:
    """Return the habitat's own choice for each button of all islands, int32; None for amounts, or if
    they are the same."""
    own = _buttons(habitat)
    if not union.buttons or own == union.buttons:
        return None
    return np.array([own.index(b if b in own else IDLE) for b in union.buttons], np.int32)


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


class Archipelago(Habitat):
    """What archipelagos in JAX and on the host have in common."""

    habitats: tuple[Any, ...]
    senses_size: int
    action: Action
    words: int
    versions: dict[str, str]
    rate: float | None
    episode: int | None
    tallies: tuple[str, ...]
    exact: bool
    buttons: tuple[str, ...] | None

    def __init__(self, habitats: Sequence[AnyHabitat], islands: Islands) -> None:
        union = _Union.of(habitats, islands.names)
        kind = _InJax if isinstance(habitats[0], JaxHabitat) else _OnHost
        self.islands = islands
        self.habitats = tuple(kind(each, union) for each in habitats)
        self.senses_size, self.action, self.words = union.senses, union.action, union.words
        self.buttons = union.buttons or None
        self.rate = _common(each.rate for each in habitats)
        self.episode = _common(each.episode for each in habitats)
        self.exact = all(each.exact for each in habitats)
        self.versions = {k: v for each in habitats for k, v in each.versions.items()}
        self.tallies = union.tallies

    @property
    def _key(self) -> tuple:
        return self.habitats, self.islands

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Archipelago) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

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
    """Islands on the host, stepped one after another."""

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
        stepped = [
            habitat.step(action[own], alive[own])
            for habitat, own in zip(self.habitats, self._cells, strict=True)
        ]
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
    """Join the outcomes of islands; what only some islands report is 0 or False on the others."""

    def all_of(*results: Any) -> Any:
        if all(each is None for each in results):
            return None
        like = next(each for each in results if each is not None)
        counts = [len(outcome.fatal) for outcome in outcomes]
        filled = [
            np.zeros(count, like.dtype) if each is None else each
            for each, count in zip(results, counts, strict=True)
        ]
        return joined(
            filled if isinstance(like, np.ndarray) else [*map(jnp.asarray, filled)], sizes
        )

    return Outcome(*map(all_of, *outcomes))


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
