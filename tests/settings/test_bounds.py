"""The smallest and the largest value of each setting of a run, and the next values beyond."""

from typing import Any

import pytest

from primordia.brains.layout import Layout
from primordia.config import parsed
from primordia.errors import InputError
from primordia.fitting import check
from primordia.habitats.contract import Compound, Continuous, Discrete
from primordia.mutations.gaussian import Gaussian
from primordia.settings.limits import Stop, checked
from tests.toys import Organ
from tests.worlds import MEADOW, MILL, config, law_of

MOST = 2**53
BOUNDS: list[tuple[str, list[float], list[float]]] = [
    ("cells", [2, 2**24], [1, 2**24 + 1]),
    ("replication", [0.0, 1.0], [-5e-324, 1.0000000000000002]),
    ("hazard", [0.0, 1.0], [-5e-324, 1.0000000000000002]),
    ("saturation_ticks", [1, 2**31 - 1], [0, 2**31]),
    ("sample_every", [1, 2**31 - 1], [0, 2**31]),
    ("seed", [0, 2**64 - 1], [-1, 2**64]),
    ("seeds", [1, 2**16], [0, 2**16 + 1]),
    ("stop.ticks", [1, MOST - 1], [0, MOST]),
    ("stop.births", [1, MOST - 1], [0, MOST]),
    ("fork.tick", [1, MOST - 1], [0, MOST]),
]


def with_value(path: str, value: float) -> dict[str, Any]:
    """Return settings with a value at a dotted path."""
    group, _, name = path.rpartition(".")
    if not group:
        return {**MEADOW, name: value}
    return {**MEADOW, group: {name: value, **({"run": "a"} if group == "fork" else {})}}


@pytest.mark.parametrize(("path", "taken", "refused"), BOUNDS, ids=[path for path, *_ in BOUNDS])
def test_values_at_the_bounds_are_accepted_and_the_next_are_refused(
    path: str, taken: list[float], refused: list[float]
) -> None:
    for value in taken:
        found: Any = parsed(with_value(path, value), source="test")
        for name in path.split("."):
            found = getattr(found, name)
        assert found == value
    for value in refused:
        with pytest.raises(InputError, match=f"^test: {path}: .*{value}"):
            parsed(with_value(path, value), source="test")


def test_the_last_world_may_have_the_largest_seed() -> None:
    values = {**MEADOW, "seed": 2**64 - 3, "seeds": 3}
    seeds = parsed(values, source="test").world_seeds
    assert [int(seed) for seed in seeds] == [2**64 - 3, 2**64 - 2, 2**64 - 1]
    with pytest.raises(InputError, match=r"^test: seeds must be below 2\^64"):
        parsed({**values, "seeds": 4}, source="test")


def test_the_cells_of_all_worlds_are_limited() -> None:
    most = parsed({**MEADOW, "cells": 2**24, "seeds": 4, "seasons": []}, source="test")
    check(most)
    more = most.model_copy(update={"cells": 2**24 - 1, "seeds": 5})
    with pytest.raises(InputError, match=rf"^cells x seeds: {5 * (2**24 - 1)} cells are more"):
        check(more)


def test_records_begin_after_the_tick_of_a_fork() -> None:
    assert parsed(MEADOW, source="test").begins == 0
    assert parsed(with_value("fork.tick", 7), source="test").begins == 7


def test_limits_are_checked_and_none_is_no_limit() -> None:
    given = {"ticks": "none", "births": 5, "until": "saturation"}
    assert checked(given) == {"ticks": None, "births": 5, "until": "saturation"}
    assert Stop() == Stop(ticks=None, births=None, until=None)
    with pytest.raises(InputError, match=r"^births: .* not 0$"):
        checked({"births": 0})
    with pytest.raises(InputError, match=r"^there is no setting 'tick'; did you mean 'ticks'\?$"):
        checked({"tick": 1})


def test_one_continuous_part_of_an_action_is_enough_for_a_gaussian_motor() -> None:
    assert {type(part) for part in Organ().action.parts} == {Continuous, Discrete}
    assert isinstance(Organ().action, Compound)
    values = {"habitat": {"name": "tests.toys:Organ"}, "motor": {"kind": "gaussian"}}
    assert config(MILL, **values).motor.kind == "gaussian"
    with pytest.raises(InputError, match=r"motor\.kind: this habitat's actions are discrete"):
        config(MEADOW, motor={"kind": "gaussian"})


def test_a_law_begins_with_the_rates_of_its_settings() -> None:
    """Without a metabolism, its rates have their defaults."""
    own = {"hazard": 0.25, "metabolism": {"store": 7.0, "drain": 0.5, "gain": 3.0}}
    rates = dict(law_of(MILL, seasons=[], **own).beginning)
    assert [rates[f"metabolism.{name}"] for name in ("drain", "gain")] == [0.5, 3.0]
    assert rates["hazard"] == 0.25
    without = dict(law_of(MILL, seasons=[], metabolism=None).beginning)
    assert without["metabolism.drain"] == 1.0


def test_a_season_of_metabolism_needs_a_metabolism() -> None:
    season = {"kind": "schedule", "setting": "metabolism.gain", "at": 2, "value": 0.5}
    with pytest.raises(InputError, match=r"seasons: metabolism.gain needs a metabolism; remove"):
        config(MILL, metabolism=None, seasons=[season])


@pytest.mark.parametrize(
    ("setting", "value"),
    [("hazard", 5.0), ("mutation.probability", 50.0), ("mutation.blocks.input.probability", 1.5)],
)
def test_a_schedule_sets_no_value_that_its_setting_may_not_have(setting: str, value: float) -> None:
    season = {"kind": "schedule", "setting": setting, "at": 2, "value": value}
    with pytest.raises(InputError, match=f"seasons: {setting}: .* less than or equal to 1"):
        config(MILL, seasons=[season])
    assert config(MILL, seasons=[{**season, "value": 1.0}]).seasons


class Warm(Gaussian):
    """A mutation with a rate that is no setting."""

    def rates(self, layout: Layout) -> dict[str, float]:
        return {**super().rates(layout), "warmth": 0.1}


def test_a_season_may_change_any_rate_of_an_own_mutation() -> None:
    season = {"kind": "schedule", "setting": "mutation.warmth", "at": 5, "value": 7.0}
    mutation = {"kind": f"{__name__}:Warm"}
    assert config(MILL, mutation=mutation, seasons=[season]).seasons
