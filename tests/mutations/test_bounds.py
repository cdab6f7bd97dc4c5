"""Bounds of the settings of mutations, the metabolism and brains: the last value is accepted, the next is
refused. `tests/settings/test_bounds.py` has the settings of a run."""

from typing import Any

import pytest

from primordia.config import load
from primordia.errors import InputError
from primordia.settings.tables import flat

TINY = 1e-9
BOUNDS: list[tuple[dict[str, Any], str, Any, Any]] = [
    ({}, "mutation.probability", 0.0, -TINY),
    ({}, "mutation.probability", 1.0, 1 + TINY),
    ({}, "mutation.scale", 0.0, -TINY),
    ({}, "mutation.founder_scale", 0.0, -TINY),
    ({}, "mutation.blocks.input.scale", 0.0, -TINY),
    ({}, "mutation.blocks.input.probability", 0.0, -TINY),
    ({}, "mutation.blocks.input.probability", 1.0, 1 + TINY),
    ({}, "mutation.blocks.input.founder_scale", 0.0, -TINY),
    *(
        ({"mutation.kind": "calibrated"}, f"mutation.{name}", accepted, refused)
        for name, accepted, refused in [
            ("probability", 0.0, -TINY),
            ("probability", 1.0, 1 + TINY),
            ("differs", 0.0, -TINY),
            ("remembered", 1, 0),
            ("remembered", 256, 257),
            ("every", 1, 0),
            ("every", 256, 257),
            ("founder_scale", 0.0, -TINY),
            ("blocks.input.founder_scale", 0.0, -TINY),
        ]
    ),
    *(
        ({"mutation.kind": "heritable"}, f"mutation.{name}", accepted, refused)
        for name, accepted, refused in [
            ("stride", 1, 0),
            ("stride", 16, 17),
            ("finest", 0, 1),
            ("finest", -96, -97),
            ("coarsest", 0, -1),
            ("coarsest", 32, 33),
        ]
    ),
    *(
        ({"metabolism.store": 1.0}, f"metabolism.{name}", accepted, refused)
        for name, accepted, refused in [
            ("store", 1e6, 1e6 + 1),
            ("store", 1e-3, 0.0),
            ("drain", 0.0, -TINY),
            ("drain", 1e6, 1e6 + 1),
            ("gain", 0.0, -TINY),
            ("gain", 1e6, 1e6 + 1),
            ("effort_cost", 0.0, -TINY),
            ("effort_cost", 1e6, 1e6 + 1),
            ("cap", 1e6, 1e6 + 1),
            ("cap", 1e-3, 0.0),
        ]
    ),
    ({"recombination.unit": "row"}, "recombination.probability", 0.0, -TINY),
    ({"recombination.unit": "row"}, "recombination.probability", 1.0, 1 + TINY),
    ({}, "motor.sd", 0.0, -TINY),
    ({}, "motor.sd", 100.0, 100.1),
    ({}, "brain.hidden", 1, 0),
    ({}, "brain.hidden", 4096, 4097),
]
"""settings that it needs, setting, a value that is accepted, a value that is refused"""


def nested(values: dict[str, Any]) -> dict[str, Any]:
    tables: dict[str, Any] = {}
    for path, value in values.items():
        table, (*groups, name) = tables, path.split(".")
        for group in groups:
            table = table.setdefault(group, {})
        table[name] = value
    return tables


@pytest.mark.parametrize(("needed", "setting", "accepted", "refused"), BOUNDS)
def test_a_value_at_the_bound_is_accepted_and_one_beyond_it_is_not(
    needed: dict[str, Any], setting: str, accepted: Any, refused: Any
) -> None:
    config = load("CartPole-survival", nested({**needed, setting: accepted}))
    assert flat(config.model_dump())[setting] == accepted
    with pytest.raises(InputError, match=setting):
        load("CartPole-survival", nested({**needed, setting: refused}))
