"""Checks for your own brains, habitats and mutations: do they keep their contracts?

A test of a part is one call, such as `check_brain(Leaky(neurons=8))`. A check raises `ContractError`; its
message says what is wrong and what to do. It warns if a part is only slow.
"""

from primordia.testing.brain import check_brain
from primordia.testing.habitat import check_habitat
from primordia.testing.mutation import check_mutation
from primordia.testing.report import ContractError

__all__ = ["ContractError", "check_brain", "check_habitat", "check_mutation"]
