"""Seasons: settings change in the right tick, in the right world, and by the right amount."""

from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from primordia.errors import InputError
from primordia.law.seasons import Season
from tests.chronicle import History
from tests.worlds import MILL, MILLS, Lived, config


def schedule(setting: str, at: int, value: float) -> dict[str, Any]:
    return {"kind": "schedule", "setting": setting, "at": at, "value": value}


def ratchet(setting: str, when: str, above: float, factor: float, every: int) -> dict[str, Any]:
    return {"kind": "ratchet", "setting": setting, "when": when, "above": above, "factor": factor,
            "every": every}  # fmt: skip


RATCHETS = MILLS["seasons"]
SETTINGS = {
    "metabolism.gain": "metabolism.gain",
    "replication": "replication",
    "mutation.scale": "mutation.blocks.input.scale",
    "mutation.blocks.output.scale": "mutation.blocks.output.scale",
}
"""The column of the metrics that shows the setting of a season."""


@pytest.fixture(scope="module", params=[(0, 0), (2**32 - 50, 2**32 - 100)], ids=["0", "2^32"])
def mills(request: pytest.FixtureRequest) -> Lived:
    """Live MILLS; `output` has its own scale, which mutation.scale leaves alone.

    The counts of ticks and births start at 0, or cross 2^32 soon.
    """
    start = request.param
    return Lived(config(MILLS), last_tick(start[0]), start=start)


def last_tick(first: int) -> int:
    """Return the first multiple of 10 after 600 ticks."""
    return -(-(first + 600) // 10) * 10


def of_world(run: Lived, world: int) -> dict[str, np.ndarray]:
    metrics = run.table("metrics")
    return {column: values[metrics["world"] == world] for column, values in metrics.items()}


def expected_climate(rows: dict[str, np.ndarray]) -> list[dict[str, np.float32]]:
    """Return what the seasons make of the populations in the rows, which include every look."""
    now = {
        "metabolism.gain": np.float32(3.0),
        "replication": np.float32(MILLS["replication"]),
        "mutation.scale": np.float32(0.2),
        "mutation.blocks.output.scale": np.float32(0.1),
    }
    last = dict.fromkeys(range(len(RATCHETS)), (0.0, 0))
    climates = []
    for i, tick in enumerate(rows["tick"]):
        for s, season in enumerate(RATCHETS):
            if season["kind"] == "schedule":
                if tick == season["at"]:
                    now[season["setting"]] = np.float32(season["value"])
                continue
            if tick % season["every"]:
                continue
            food, lived = float(rows["food"][i]), int(rows["organism_ticks"][i])
            seen = {
                "mean_age": rows["mean_age"][i],
                "saturation": rows["population"][i] / 16,
                "food": (food - last[s][0]) / (lived - last[s][1]),
            }[season["when"]]
            last[s] = food, lived
            if seen > season["above"]:
                now[season["setting"]] *= np.float32(season["factor"])
        climates.append(dict(now))
    return climates


@pytest.mark.parametrize("world", range(2))
def test_ratchets_turn_when_and_only_when_their_condition_holds(mills: Lived, world: int) -> None:
    rows = of_world(mills, world)
    lived = range(mills.start[0] + 1, last_tick(mills.start[0]) + 1)
    ticks = [tick for tick in lived if tick % 10 == 0 or tick == 205]
    assert rows["tick"].tolist() == ticks
    expected = expected_climate(rows)
    for setting, column in SETTINGS.items():
        values = rows[column].astype(np.float32)
        np.testing.assert_array_equal(values, [row[setting] for row in expected], err_msg=column)
    np.testing.assert_array_equal(
        rows["mutation.blocks.recurrent.scale"], rows["mutation.blocks.input.scale"]
    )
    for column in ("hazard", "metabolism.store", "mutation.blocks.input.probability"):
        assert len(set(rows[column].tolist())) == 1


def test_ratchets_turn_in_each_world_separately(mills: Lived) -> None:
    """The test above has something to check: every ratchet turned sometimes, and not always."""
    for setting, column in SETTINGS.items():
        series = [tuple(of_world(mills, world)[column].tolist()) for world in range(2)]
        assert all(len(set(each)) > 1 for each in series), setting
    looks = [season for season in RATCHETS if season["kind"] == "ratchet"]
    for season in looks[:3]:
        column = SETTINGS[season["setting"]]
        turned = {len(set(of_world(mills, world)[column].tolist())) for world in range(2)}
        assert max(turned) < 600 // season["every"] + 1, "always turned: nothing was decided"
    series = [tuple(of_world(mills, w)[c].tolist() for c in SETTINGS.values()) for w in range(2)]
    assert series[0] != series[1]


@pytest.mark.parametrize("world", range(2))
def test_ratchets_look_at_what_the_records_say(mills: Lived, world: int) -> None:
    rows, history = of_world(mills, world), History(mills, world, mills.start)
    for i, tick in enumerate(rows["tick"]):
        living = [
            life
            for life in history.lives
            if life.born <= tick and (life.died is None or life.died > tick)
        ]
        assert rows["population"][i] == len(living)
        ages = [int(tick) - life.born for life in living]
        assert rows["mean_age"][i] == pytest.approx(np.mean(ages))
        assert rows["oldest_age"][i] == max(ages)
        lived = sum(
            min(life.died or tick, tick) - life.born for life in history.lives if life.born <= tick
        )
        assert rows["organism_ticks"][i] == lived
    eaten = sum(life.food for life in history.dead)
    organisms = mills.engine.state.world.organisms
    own = np.asarray(organisms.alive) & (np.arange(32) // 16 == world)
    eaten += np.asarray(organisms.eaten)[own].sum() / 1024
    assert rows["food"][-1] == eaten


@pytest.mark.parametrize(
    ("kind", "name", "accepted", "refused"),
    [
        ("schedule", "at", 1, 0),
        ("schedule", "value", 0.0, -1e-9),
        ("ratchet", "above", 0.0, -1e-9),
        ("ratchet", "factor", 1e-9, 0.0),
        ("ratchet", "every", 1, 0),
        ("ratchet", "every", 2**31 - 1, 2**31),
    ],
)
def test_values_of_seasons_are_accepted_up_to_their_bounds(
    kind: str, name: str, accepted: float, refused: float
) -> None:
    good = {
        "schedule": schedule("hazard", 5, 0.5),
        "ratchet": ratchet("replication", "mean_age", 1.0, 0.5, 10),
    }[kind]
    season = TypeAdapter(Season)
    assert getattr(season.validate_python({**good, name: accepted}), name) == accepted
    with pytest.raises(ValidationError, match=name):
        season.validate_python({**good, name: refused})


@pytest.mark.parametrize(
    ("setting", "nearest"),
    [
        ("cells", ""),
        ("mutation.founder_scale", ""),
        ("mutation.blocks.hidden.scale", "mutation.blocks.input.scale"),
        ("metabolism.gian", "metabolism.gain"),
        ("mutation.scael", "'mutation.scale'"),
    ],
)
def test_a_season_of_what_seasons_cannot_change_is_refused(setting: str, nearest: str) -> None:
    """The faulty season is the second one."""
    good, season = (ratchet(name, "mean_age", 1.0, 0.5, 10) for name in ("hazard", setting))
    with pytest.raises(InputError, match="not a setting that seasons can change") as error:
        config(MILL, seasons=[good, season])
    assert nearest in str(error.value)
