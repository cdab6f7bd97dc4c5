"""Worlds that have everything at once, so that one law stands for many."""

from typing import Any

from tests.worlds import MILL

TICKS = 300
SEEDS = [2**64 - 2, 2**64 - 1]
QUIET = 200
"""The tick from which little happens."""
STRANGE: dict[str, Any] = {
    **MILL,
    "task": "strange",
    "cells": 37,
    "seed": SEEDS[0],
    "seeds": 2,
    "brain": {"hidden": 3},
    "replication": 0.7,
    "hazard": 0.06,
    "metabolism": {**MILL["metabolism"], "drain": 0.7},
    "placement": {"rule": "replacing", "topology": "ring"},
    "recombination": {"probability": 0.6},
    "mutation": {
        "kind": "calibrated",
        "probability": 0.7,
        "founder_scale": 0.5,
        "blocks": {"input": {"founder_scale": 0.7}},
        "remembered": 5,
        "every": 3,
    },
    "seasons": [
        {"kind": "ratchet", "setting": "mutation.probability", "when": "mean_age", "above": 1.5,
         "factor": 0.97, "every": 13},
        {"kind": "ratchet", "setting": "metabolism.gain", "when": "food", "above": 0.01,
         "factor": 0.99, "every": 17},
        {"kind": "schedule", "setting": "hazard", "at": QUIET, "value": 0.004},
        {"kind": "schedule", "setting": "replication", "at": QUIET, "value": 0.03},
    ],
}  # fmt: skip
"""A prime number of cells, the last two seeds, two parents, children that replace neighbours, moments
that are remembered, seasons, and lives of energy, noise and accidents."""
STRANGER: dict[str, Any] = {
    **STRANGE,
    "placement": {"topology": "well-mixed"},
    "recombination": {"unit": "block", "probability": 0.9},
    "mutation": {"kind": "heritable", "scale": 0.2, "founder_scale": 0.5, "belongs": "cell"},
    "seasons": STRANGE["seasons"][1:],
}
"""The other kind of notes, of recombination and of neighbourhood."""
BLOCKS: dict[str, Any] = {
    **STRANGE,
    "recombination": None,
    "mutation": {
        **MILL["mutation"],
        "blocks": {
            "input": {"scale": 0.3, "founder_scale": 0.7},
            "output": {"probability": 0.9, "scale": 0.05},
        },
    },
    "seasons": [
        {**STRANGE["seasons"][0], "setting": "mutation.blocks.output.scale"},
        {**STRANGE["seasons"][1], "when": "mean_age", "above": 2.0},
        *STRANGE["seasons"][2:],
    ],
}
"""One parent, and settings of mutation for each block."""
GIVING: dict[str, Any] = {
    **STRANGE,
    "brain": {"hidden": 3, "interoception": True},
    "replication": {"kind": "act", "price": 0.3},
    "metabolism": {**MILL["metabolism"], "gain": 6.0, "drain": 0.7},
    "hazard": 0.03,
    "seasons": [
        *STRANGE["seasons"][:2],
        {**STRANGE["seasons"][2], "value": 0.001},
        {"kind": "schedule", "setting": "replication.price", "at": QUIET, "value": 40.0},
    ],
}
"""Organisms that perceive their energy, choose when to copy themselves, and what a child begins with."""
PASSING: dict[str, Any] = {
    **STRANGE,
    "brain": {"kind": "plastic", "hidden": 3, "activity": "graded", "gain": 1.0, "bound": 1.0,
              "decay": 0.02, "inherited": True, "efference": True},
}  # fmt: skip
"""Children that begin with what their parents have learned, which fades slowly."""
