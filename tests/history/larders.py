"""Worlds with food for all, in which each mutant's mutations have a size of their own."""

from typing import Any

from tests.worlds import MEADOW

FOOD = 0.25
FED: dict[str, Any] = {
    **MEADOW,
    "habitat": {"name": "tests.toys:Meadow", "lifespan": 60, "food": FOOD},
    "metabolism": {"store": 30.0, "drain": 1.0, "gain": 2.0},
    "seasons": [{"kind": "schedule", "setting": "metabolism.gain", "at": 200, "value": 8.0}],
    "brain": {"hidden": 6},
    "mutation": {"kind": "examples.mutation:SelfAdaptive"},
    "hazard": 1e-9,
    "seeds": 2,
    "replication": 0.1,
    "sample_every": 40,
    "stop": {"ticks": 400, "until": "none"},
}
"""All gather the same food, which is enough from tick 200 on. A birth has a note of its mutation."""
