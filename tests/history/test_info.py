"""A run in numbers, counted again from its records."""

from collections import Counter
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.runs import loop
from tests.worlds import MEADOW, config

SETTINGS: dict[str, Any] = {
    **MEADOW,
    "habitat": {**MEADOW["habitat"], "lifespan": 60},
    "brain": {"hidden": 1},
    "seeds": 3,
    "seed": 4,
    "replication": 0.3,
    "hazard": 0.02,
    "metabolism": {"store": 50.0, "drain": 1.0, "gain": 0.25},
    "stop": {"ticks": 300, "births": 90},
}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    folder = tmp_path_factory.mktemp("info") / "run"
    loop.start(config(SETTINGS), folder)
    return primordia.load(folder)


@pytest.mark.parametrize("number", range(3))
def test_the_numbers_of_a_world_are_those_of_its_records(run: primordia.Run, number: int) -> None:
    world, cells = run.info()["worlds"][number], SETTINGS.get("cells", 16)
    born, died = (run.table(name).to_pylist() for name in ("births", "deaths"))
    born, died = ([row for row in rows if row["world"] == number] for rows in (born, died))
    ends = {row["id"]: row["tick"] for row in died}
    last = world["ticks"]
    ages = [last - row["tick"] for row in born if row["id"] not in ends]
    lived = sum(ends.get(row["id"], last) - row["tick"] for row in born)
    founders = [row for row in born if row["parent"] is None]
    assert np.mean(ages) != pytest.approx(np.median(ages), rel=0.01)
    assert {
        "seed": 4 + number,
        "births": len(born),
        "deaths": len(died),
        "alive": len(ages),
        "extinctions": len(founders) - 1,
        "cell_ticks": last * cells,
        "organism_ticks": lived,
        "mean_age": pytest.approx(np.mean(ages)),
        "oldest_age": max(ages),
        "tries_per_life": pytest.approx(0.3 * lived / len(born)),
        "break_even": {"food_per_tick": 4.0, "food_per_second": None},
    }.items() <= world.items()
    causes = Counter(row["cause"] for row in died)
    assert {cause: count for cause, count in world["deaths_by_cause"].items() if count} == causes
    assert len(born) >= 90
    assert last < 300
    assert max(row["tick"] for row in born) == last
