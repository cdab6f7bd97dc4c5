"""Lives with all kinds of brains, and with a brain of the tests."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from primordia.runs import loop
from tests.brains.test_contract import TABLES
from tests.history.test_rebuilding import assert_rebuilt
from tests.worlds import MILL, Lived, config

pytestmark = pytest.mark.slow
EVERY = pytest.mark.parametrize(
    "name", ["gated, biases", "recurrent, biases", "linear", "not ours"]
)
"""Brains of different kinds. The law treats all alike, so that the quick tests live with few."""
LIVING: dict[str, Any] = {"replication": 0.3, "hazard": 0.03, "metabolism": None, "seasons": []}


@EVERY
def test_organisms_with_the_brain_live_and_evolve_and_are_rebuilt(
    name: str, tmp_path: Path
) -> None:
    values = {**MILL, **LIVING, "brain": TABLES[name], "seeds": 2, "stop": {"ticks": 200}}
    loop.start(config(values), tmp_path / "run")
    assert_rebuilt(tmp_path / "run")


@EVERY
def test_organisms_live_the_same_in_a_jax_habitat_and_on_the_host(name: str) -> None:
    values = {**MILL, **LIVING, "brain": TABLES[name], "seeds": 2}
    mirror = {**values, "habitat": {"name": "tests.toys:Mirror", "inner": "mill"}}
    one, other = Lived(config(values), 200), Lived(config(mirror), 200, chunk=77)
    for table in ("births", "deaths", "metrics"):
        np.testing.assert_array_equal(
            np.concatenate(one.rows[table]), np.concatenate(other.rows[table])
        )
    assert len(one.table("births")["id"]) > 100
