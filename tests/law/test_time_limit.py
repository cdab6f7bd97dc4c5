"""A habitat's own time limit ends lives, with a cause of its own; any other reason comes first."""

import numpy as np
import pytest

from tests.worlds import MILL, Lived, config

LIMIT = 6
STILL = {
    "replication": 0.0,
    "genesis": "fill",
    "hazard": 0.0,
    "seasons": [],
    "brain": {"hidden": 2},
}


@pytest.mark.parametrize("kind", ["Organ", pytest.param("OrganOnHost", marks=pytest.mark.slow)])
@pytest.mark.parametrize(("store", "cause"), [(1000.0, "time-limit"), (6.0, "starved")])
def test_lives_end_at_the_limit(kind: str, store: float, cause: str) -> None:
    """A store of 6 that drains by 1 is empty in the tick of the limit, and hunger comes first."""
    habitat = {"name": f"tests.toys:{kind}", "limit": LIMIT}
    hunger = {"store": store, "gain": 0.0, "effort_cost": 0.0, "cap": 2000.0}
    lived = Lived(config(MILL, **STILL, habitat=habitat, metabolism=hunger), LIMIT)
    deaths = lived.table("deaths")
    at_the_limit = deaths["tick"] == LIMIT
    assert at_the_limit.sum() > 12
    assert set(np.asarray(deaths["cause"])[at_the_limit]) <= {cause, "fatal"}
    assert (np.asarray(deaths["cause"])[at_the_limit] == cause).sum() > 12
    assert set(np.asarray(deaths["cause"])[~at_the_limit]) <= {"fatal"}
