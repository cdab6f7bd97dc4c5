"""A habitat made from a task's table `[habitat]`, with all that may be around it."""

from collections.abc import Mapping
from typing import Any

from primordia.habitats import contract
from primordia.habitats.change import changes_of
from primordia.habitats.changing import changing
from primordia.habitats.checks import check_properties
from primordia.habitats.contract import AnyHabitat
from primordia.habitats.scaled import scaled
from primordia.habitats.traits import KEY, Traits, with_traits
from primordia.settings.making import make


def made(table: Mapping[str, Any], traits: Traits | None) -> AnyHabitat:
    """Return the habitat of a table without islands.

    Args:
        table: `name` and the habitat's own settings, and `factors`, `traits` and `change`.
        traits: what the setting `traits` says.

    Raises:
        InputError: there is no such habitat, or the habitat does not take these settings.
    """
    around = ("factors", KEY, "change")
    own = {name: value for name, value in table.items() if name not in around}
    habitat = make("habitat", own, contract.find)
    check_properties(habitat)
    if table.get("factors") is not None:
        habitat = scaled(habitat, table["factors"])
    if traits is not None:
        habitat = with_traits(habitat, traits)
    if table.get("change") is not None:
        habitat = changing(habitat, changes_of(table["change"], habitat))
    return habitat
