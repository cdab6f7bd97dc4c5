"""Habitats: simulators in which organisms live, one folder each, and the contract of habitats."""

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
