"""Habitats: the simulators in which organisms live, each in a folder, and the contract of habitats."""

from primordia.habitats.contract import (
    Ability,
    Compound,
    Continuous,
    Discrete,
    HostHabitat,
    JaxHabitat,
    Outcome,
)

__all__ = ["Ability", "Compound", "Continuous", "Discrete", "HostHabitat", "JaxHabitat", "Outcome"]
