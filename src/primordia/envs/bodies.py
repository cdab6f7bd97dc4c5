"""A task's bodies, without brains: a policy acts in them, and they live and die by the law."""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from gymnasium import Space, spaces

from primordia import device
from primordia.compiled import shared
from primordia.config import Config
from primordia.errors import InputError
from primordia.habitats.contract import Action, Compound, Continuous, Discrete, JaxHabitat
from primordia.habitats.on_host import OnHost
from primordia.law import life
from primordia.law.genesis import words_of
from primordia.law.life import Vitals
from primordia.law.metabolism import ONE, Rates, to_fixed_point
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide


class Births(NamedTuple):
    """Seed, tick and cell of K births, int (K,) each: they determine the bodies, as in a run."""

    seeds: np.ndarray
    """seed of the world"""
    ticks: np.ndarray
    """tick of the birth"""
    cells: np.ndarray
    """cell of the birth, within the world"""


class Bodies:
    """N bodies and their energy."""

    def __init__(self, config: Config, count: int, watched: bool = False) -> None:
        device.prepare()
        if config.islands.count > 1:
            raise InputError(
                f"{config.task} has islands, and an environment is one habitat; write a task with the"
                " settings of one island"
            )
        habitat = config.build_habitat()
        self.law = config.build_law(habitat)
        self.habitat = OnHost(habitat) if isinstance(habitat, JaxHabitat) else habitat
        self.habitat.open(count, watched)
        rates = dict(self.law.beginning)
        self._rates = Rates.of({name: np.full(count, rates[name], np.float32) for name in rates})
        self._judge = shared(life.judge, self.law)
        self._sound = np.zeros(count, bool)
        self._store = to_fixed_point(self._rates.store)
        self._vitals = Vitals._make((self._store, np.zeros(count, np.int32)))
        self.senses = np.zeros((count, habitat.senses_size), np.float32)
        """float32 (N, S)"""

    @property
    def energy(self) -> np.ndarray | None:
        """Energy, float64 (N,); None if the task has no metabolism."""
        return None if self.law.metabolism is None else np.asarray(self._vitals.energy) / ONE

    @property
    def food(self) -> np.ndarray:
        """Food gathered in the present lives, float64 (N,)."""
        return np.asarray(self._vitals.eaten) / ONE

    def begin(self, cells: np.ndarray, births: Births) -> None:
        """Begin lives in cells (K,)."""
        if not len(cells):
            return
        keys = stream(wide(births.seeds.astype(np.uint64)), Purpose.BODY, wide(births.ticks))
        places = jnp.asarray(births.cells, jnp.int32)
        # A policy has no genes, so it has the founders' body.
        words = words_of(self.law, None, keys, places, self.habitat.words)
        self.senses[cells] = self.habitat.reset(cells, np.asarray(words))
        energy, eaten = (np.array(each) for each in self._vitals)
        energy[cells], eaten[cells] = self._store[cells], 0
        self._vitals = Vitals._make((energy, eaten))

    def step(self, action: np.ndarray, alive: np.ndarray) -> np.ndarray:
        """Live one tick in the living cells; `alive` is bool (N,).

        Returns:
            causes of death, int32 (N,); -1 for none.
        """
        before = [np.asarray(each) for each in self._vitals]
        senses, outcome = self.habitat.step(action, alive)
        vitals, cause = self._judge(self._vitals, self._sound, senses, outcome, self._rates)
        self.senses = np.where(alive[:, None], senses, self.senses).astype(np.float32)
        kept = (np.where(alive, new, old) for new, old in zip(vitals, before, strict=True))
        self._vitals = Vitals._make(kept)
        return np.where(alive, np.asarray(cause), -1)

    def close(self) -> None:
        """Release the habitat."""
        self.habitat.close()


def observation_space(bodies: Bodies) -> spaces.Box:
    """Return the space of one body's senses."""
    return spaces.Box(-np.inf, np.inf, (bodies.habitat.senses_size,), np.float32)


def action_space(bodies: Bodies) -> Space:
    """Return the space of one body's actions."""
    action = bodies.habitat.action
    if isinstance(action, Compound):
        return spaces.Tuple(map(_part_space, action.parts))
    return _part_space(action)


def _part_space(part: Discrete | Continuous) -> Space:
    if isinstance(part, Discrete):
        return spaces.Discrete(part.size)
    low, high = part.bounds or ((-np.inf,) * part.size, (np.inf,) * part.size)
    return spaces.Box(np.array(low, np.float32), np.array(high, np.float32))


def zeros(kind: Action) -> np.ndarray:
    """Return the action of one body in which every number is 0, int32 (1,) or float32 (1, K)."""
    if isinstance(kind, Discrete):
        return np.zeros(1, np.int32)
    return np.zeros((1, kind.columns if isinstance(kind, Compound) else kind.size), np.float32)


def as_rows(actions: Any, kind: Action, count: int) -> np.ndarray:
    """Return the actions of bodies in the habitat's form: int32 (N,) or float32 (N, K).

    Args:
        actions: actions of the batched space; for a compound action a tuple with an entry for each
            part.
        kind: the kind of one body's action.
        count: the number N of bodies.

    Raises:
        ValueError: there is no such action, or not one for each body.
    """
    if isinstance(kind, Compound):
        pairs = zip(actions, kind.parts, strict=True)
        columns = [as_rows(part, own, count).reshape(count, -1) for part, own in pairs]
        return np.concatenate(columns, axis=1).astype(np.float32)
    rows = np.asarray(actions)
    if isinstance(kind, Continuous):
        if rows.shape != (count, kind.size):
            raise ValueError(f"actions: give the shape {(count, kind.size)}, not {rows.shape}")
        return rows.astype(np.float32)
    whole = rows.shape == (count,) and rows.dtype.kind in "iu"
    if not whole or not ((rows >= 0) & (rows < kind.size)).all():
        wanted = f"give {count} of the whole numbers from 0 to {kind.size - 1}"
        raise ValueError(f"actions: {wanted}, not {np.array2string(rows, threshold=8)}")
    return rows.astype(np.int32)
