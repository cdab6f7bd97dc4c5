"""The check of habitats."""

import jax
import numpy as np
from jax import Array, lax

from primordia.compiled import jit
from primordia.habitats.change import changes_of
from primordia.habitats.changing import changing
from primordia.habitats.checks import check_arrays, check_parameters, check_properties
from primordia.habitats.contract import (
    Ability,
    AnyHabitat,
    Bodies,
    JaxHabitat,
    Outcome,
)
from primordia.law.events import DEATHS
from primordia.testing.lives import TICKS, Lives, Past
from primordia.testing.report import ALL, COUNTS, SUMMED, advise, kept, need

FACTORS = {"range": [0.8, 1.25], "every": [2, 9]}
"""Factors of a habitat's parameters, and ticks between two draws of a body."""


def check_habitat(habitat: AnyHabitat) -> None:
    """Check types, purity, exact lives, saving and pictures of a habitat.

    A habitat with `parameters` is checked again while they change.

    Args:
        habitat: the habitat with its settings; a habitat on the host must not be open. The habitat
            is not changed, since only copies are opened.

    Raises:
        ContractError: the habitat does not keep the contract of `habitats.contract`.
    """
    _stated(habitat)
    if isinstance(habitat, JaxHabitat):
        advise(habitat)
    lives = Lives(habitat)
    expected = lives.whole()
    if isinstance(habitat, JaxHabitat):
        _in_a_loop(habitat, lives, expected)
    lives.compare(
        expected,
        lives.whole(),
        "when it begins again, so it depends on more than words and actions; draw only from"
        " `words`, and let `open` keep nothing of earlier lives",
    )
    for count in COUNTS:
        says = f"among {count} bodies than among {ALL}; compute each body alone, elementwise"
        lives.compare(expected, lives.among(count), says)
    says = "after a rest; do not step bodies whose cells are not alive"
    lives.compare(expected, lives.interrupted(), says)
    says = (
        "when others are born beside it, or if another lived in its cell before; let `reset` make"
        " complete bodies, only in the given cells"
    )
    lives.compare(expected, lives.born_late(), says)
    if habitat.can(Ability.SAVE):
        for rows in (slice(None), slice(2, 3)):
            says = "after `save` and `load`; save everything on which a body's future depends"
            lives.compare(expected, lives.restored(rows), says)
    if habitat.can(Ability.PICTURE):
        lives.drawn()
    if habitat.parameters:
        change = {"kind": "parameter", "of": habitat.parameters, **FACTORS}
        check_habitat(changing(habitat, changes_of([change], habitat)))


def _stated(habitat: AnyHabitat) -> None:
    """Check the habitat's properties and, in JAX, its shapes and dtypes."""
    with kept():
        check_properties(habitat)
        check_parameters(habitat)
        if isinstance(habitat, JaxHabitat):
            check_arrays(habitat)
    _abilities(habitat)


def _abilities(habitat: AnyHabitat) -> None:
    """Check optional properties and methods."""
    taken = sorted({"world", *DEATHS.names} & set(habitat.tallies))
    need(
        not taken,
        habitat,
        f"has tallies {taken}, which are columns of deaths already; give the tallies other names",
    )
    for ability, methods in habitat.abilities.items():
        lacking = habitat.lacks(ability)
        need(
            not 0 < len(lacking) < len(methods),
            habitat,
            f"defines {', '.join(sorted(set(methods) - set(lacking)))} without"
            f" {', '.join(lacking)}; define both, or neither",
        )


def _in_a_loop(habitat: JaxHabitat, lives: Lives, expected: list[Past]) -> None:
    """Compare lives in two loops with separate traces, and lives that were stepped tick by tick."""
    one, other = (
        jit(lambda words, actions: _looped(habitat, words, actions))(lives.words, lives.actions)
        for _ in range(2)
    )
    says = "when it is traced again, so it draws from more than `words`; keep no random generator in it"
    lives.compare(_pasts(one), _pasts(other), says)
    says = f"in a compiled loop than when it is stepped tick by tick{SUMMED}"
    lives.compare(expected, _pasts(one), says)


def _looped(habitat: JaxHabitat, words: Array, actions: Array) -> tuple[Array, Array, Outcome]:
    """Live TICKS ticks. Return senses at birth (N, S), later senses (TICKS, N, S), and outcomes."""

    def tick(bodies: Bodies, action: Array) -> tuple[Bodies, tuple[Array, Outcome]]:
        bodies, outcome = habitat.step(bodies, action)
        return bodies, (habitat.sense(bodies), outcome)

    born = habitat.reset(words)
    senses, outcomes = lax.scan(tick, born, actions)[1]
    return habitat.sense(born), senses, outcomes


def _pasts(looped: tuple[Array, Array, Outcome]) -> list[Past]:
    first, senses, outcomes = jax.tree.map(np.asarray, looped)
    pasts = []
    for body in range(ALL):
        past: Past = [(first[body],)]
        for tick in range(TICKS):
            reported = outcomes[:5]  # without faults, which the law detects in a loop
            outcome = [None if each is None else each[tick, body] for each in reported]
            past.append((senses[tick, body], *outcome))
        pasts.append(past)
    return pasts
