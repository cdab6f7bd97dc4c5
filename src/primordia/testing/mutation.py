"""The check of mutations."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.brains.layout import Layout
from primordia.compiled import jit
from primordia.law.events import BIRTHS
from primordia.mutations import checks
from primordia.mutations.contract import PURPOSES, Change, Draws, Family, Mutation
from primordia.random.keys import streams
from primordia.random.trials import normal, words
from primordia.random.wide import wide
from primordia.settings.fields import rates_of
from primordia.testing.report import (
    ALL,
    COUNTS,
    SUMMED,
    ContractError,
    advise,
    kept,
    last,
    need,
    same,
    typed,
)

LAYOUT = Layout((("input", (3, 7)), ("recurrent", (7, 7)), ("output", (2, 7))))
"""The default layout for checks of mutations: the blocks of the default brain."""
GENERATIONS = 8
TAKEN = {"world", *BIRTHS.names}
"""Columns that every births table has."""


class Made(NamedTuple):
    """Children of K births, and K founders."""

    notes: Array
    genome: Array
    mutated: Array
    founders: Array


def check_mutation(mutation: Mutation, layout: Layout | None = None) -> None:
    """Check types, independent births, and equal bits of replayed births.

    Args:
        mutation: the mutation with its settings.
        layout: layout of the genomes; by default blocks named input, recurrent and output.

    Raises:
        ContractError: the mutation does not keep the contract of `mutations.contract`.
    """
    layout = layout or LAYOUT
    _stated(mutation, layout)
    family = _family(mutation, layout)
    _same_notes(mutation)
    births: Callable[[Family], Made] = partial(_births, mutation, layout)
    made = jit(births)(family)
    says = (
        "when it is traced again, so a birth depends on more than parents, notes, rates and draws;"
        " draw only from `draws`"
    )
    same(mutation, made, jit(lambda each: births(each))(family), says)
    for count in COUNTS:
        few = jit(births)(family.take(np.s_[ALL - count :]))
        says = f"when {count} instead of {ALL} are born together; compute each birth alone"
        same(mutation, last(made, count), few, says, ALL - count)
    same(mutation, made, births(family), f"when compiled{SUMMED}")
    same(mutation, made, jit(partial(_one_by_one, births))(family), f"when rebuilt{SUMMED}")
    _copies(mutation, layout, made, family)
    _obeys_rates(mutation, layout, family)
    advise(mutation)


def _stated(mutation: Mutation, layout: Layout) -> None:
    """Check the mutation as before a run, its notes, and the settings that seasons may change."""
    try:
        mutation.check(layout)
    except ValueError as error:
        raise ContractError(
            f"{type(mutation).__name__} does not fit the layout: {error}; give check_mutation a layout"
        ) from None
    with kept():
        checks.check_mutation(mutation, layout)
    for name in mutation.notes:
        need(
            name.isidentifier() and name not in TAKEN,
            mutation,
            f"has the note {name!r}, which cannot be a column of births; use a name other than"
            f" {', '.join(sorted(TAKEN))}",
        )
    rates = mutation.rates(layout)
    for name in rates:
        need(
            name in mutation.governed(name, layout),
            mutation,
            f"has a rate {name} that no season of {name} changes; `governed` must name it",
        )
    for setting in {*rates_of(mutation), *rates, "no-such-setting"}:
        unknown = set(mutation.governed(setting, layout)) - set(rates)
        need(
            not unknown,
            mutation,
            f"says that a season of {setting} changes {', '.join(sorted(unknown))}, which `rates` lacks",
        )
    need(
        not mutation.governed("no-such-setting", layout),
        mutation,
        "accepts a season of a setting that the mutation does not have; return [] from `governed`",
    )


def _family(mutation: Mutation, layout: Layout) -> Family:
    """Return births in several ticks of several worlds; parents' notes have a history of some births."""
    number = np.arange(ALL, dtype=np.uint64)
    draws = Draws(streams(wide(number % 3), wide(number // 3), *PURPOSES), jnp.arange(ALL))
    share = jnp.linspace(0.5, 1, ALL, dtype=jnp.float32)
    rates = {name: value * share for name, value in mutation.rates(layout).items()}
    parents = jnp.asarray(normal(0, ALL, layout.length))
    notes = jnp.asarray(mutation.founders_notes(ALL))
    for birth in range(GENERATIONS):
        elsewhere = draws._replace(cell=draws.cell + ALL * (birth + 1))
        typed(mutation, "notes", notes, (ALL, len(mutation.notes)), np.int32)
        notes = mutation.note(layout, Family(parents, notes, rates, elsewhere), _change(parents))
    return Family(parents, notes, rates, draws)


def _births(mutation: Mutation, layout: Layout, family: Family) -> Made:
    notes = mutation.note(layout, family, _change(family.parents))
    genome, mutated = mutation.inherit(layout, family._replace(notes=notes))
    return Made(notes, genome, mutated, mutation.founders(layout, family.draws))


def _change(parents: Array) -> Change:
    """Return a stand-in for a change of behaviour: the largest change of a weight."""
    return lambda children: jnp.abs(children - parents).max(axis=1)


def _one_by_one(births: Callable[[Family], Made], family: Family) -> Made:
    """Make the same births in a loop, as in the replay of a line of descent."""

    def birth(_: None, row: Array) -> tuple[None, Made]:
        return None, jax.tree.map(lambda leaf: leaf[0], births(family.take(row[None])))

    return lax.scan(birth, None, jnp.arange(ALL))[1]


def _same_notes(mutation: Mutation) -> None:
    """Check that all founders have the same notes."""
    one, all_ = (mutation.founders_notes(each) for each in (1, ALL))
    need(
        (np.asarray(all_) == np.asarray(one)).all(),
        mutation,
        "gives founders different notes; those of all founders must be the same",
    )


def _copies(mutation: Mutation, layout: Layout, made: Made, family: Family) -> None:
    """Compare children that are copies with parents whose weights have arbitrary bits."""
    parents = jnp.asarray(words(1, ALL, layout.length).view(np.float32))
    odd = jit(partial(_births, mutation, layout))(family._replace(parents=parents))
    for children, of in ((made, family.parents), (odd, parents)):
        copy = ~np.asarray(children.mutated)[:, None]
        says = (
            "although it is marked as a copy; return the parent's weights unchanged, or mark it as"
            " a mutant"
        )
        same(mutation, of, np.where(copy, children.genome, of), says)


def _obeys_rates(mutation: Mutation, layout: Layout, family: Family) -> None:
    """Compare births under rates of 0 with births under rates of 1."""
    none, full = (
        jit(partial(_births, mutation, layout))(
            family._replace(rates={name: jnp.full(ALL, value) for name in family.rates})
        )
        for value in (np.float32(0), np.float32(1))
    )
    need(
        not family.rates or not np.array_equal(none.genome, full.genome, equal_nan=True),
        mutation,
        "makes the same children for all rates; read rates from `rates`, not from the settings,"
        " or seasons have no effect",
    )
