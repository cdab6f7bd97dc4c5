"""Worlds with food for all, whose organisms choose when to copy themselves. Mutants have a note."""

from typing import Any

from tests.worlds import MEADOW

FOOD = 2.0
RICH = 200
"""The last tick in which a unit of food is a unit of energy. Then it is four."""
FED: dict[str, Any] = {
    **MEADOW,
    "habitat": {"name": "tests.toys:Meadow", "food": FOOD, "lifespan": 150},
    "brain": {"kind": "linear", "interoception": True},
    "replication": {"kind": "act", "price": 0.75},
    "placement": {"topology": "torus4"},
    "metabolism": {"store": 16.0, "cap": 40.0},
    "seasons": [{"kind": "schedule", "setting": "metabolism.gain", "at": RICH, "value": 4.0}],
    "mutation": {
        "kind": "examples.mutation:SelfAdaptive",
        "founder_scale": 1.0,
        "probability": 0.5,
        "scale": 0.3,
    },
    "genesis": "fill",
    "hazard": 0.01,
    "seeds": 2,
    "sample_every": 40,
}
"""All gather the same food. A birth has a note of its mutation."""
