"""Habitats found by name, or as `module:Class`, and made from a task's `[habitat]` table."""

from collections.abc import Mapping
from typing import Any

from primordia.errors import InputError
from primordia.habitats.contract import Ability, AnyHabitat, HostHabitat, JaxHabitat
from primordia.settings import parts

KNOWN = {
    "cartpole": "primordia.habitats.cartpole.habitat:CartPole",
    "atari": "primordia.habitats.atari.habitat:Atari",
    "mujoco": "primordia.habitats.mujoco.habitat:MuJoCo",
}


def find(name: object) -> type[AnyHabitat]:
    """Return the habitat class called `name`.

    Raises:
        LookupError: there is no such name, module or class, or the class keeps no contract; the message
            says which.
    """
    found = parts.find("habitat", name, KNOWN)
    if not issubclass(found, JaxHabitat | HostHabitat):
        raise LookupError(
            f"{found.__name__} is no habitat: subclass JaxHabitat (with reset, sense and step) or"
            " HostHabitat (with open, reset and step) of primordia.habitats, and state senses_size,"
            " action and words"
        )
    return found


def complete(habitat: AnyHabitat) -> AnyHabitat:
    """Return a habitat that states all that has no default.

    Raises:
        TypeError: it does not; the message says what it lacks.
    """
    for name in ("senses_size", "action", "words"):
        getattr(habitat, name)
    if habitat.tallies and not habitat.can(Ability.TALLY):
        raise TypeError(
            f"{type(habitat).__name__} names tallies, which need a HostHabitat's tally()"
        )
    return habitat


def build(table: Mapping[str, Any]) -> AnyHabitat:
    """Return the habitat that a `[habitat]` table describes.

    Raises:
        InputError: there is no such habitat, or it does not take these settings.
    """
    habitat: AnyHabitat = parts.build("habitat", "name", table, find)
    try:
        return complete(habitat)
    except TypeError as error:
        raise InputError(f"habitat: {error}") from None
