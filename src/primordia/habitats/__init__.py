"""Habitats: simulators as places to live in, one folder each; and the contract that they keep."""

from primordia.habitats.contract import Continuous, Discrete, Habitat, HostHabitat, Outcome

__all__ = ["Continuous", "Discrete", "Habitat", "HostHabitat", "Outcome"]
