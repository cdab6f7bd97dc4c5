"""Settings of islands: which are refused, and what each island has of its own."""

from typing import Any

import pytest

from primordia.config import load
from primordia.envs.bodies import Bodies
from primordia.errors import InputError
from tests.worlds import MEADOW, config, law_of

A, B = {"name": "a"}, {"name": "b"}
MIXED = {"topology": "well-mixed"}


@pytest.mark.parametrize(
    ("islands", "more", "message"),
    [
        ([], {}, "write a list of islands"),
        ([{"share": 1.0}], {}, r"habitat.islands.0.name is missing"),
        ([A, A], {}, "'a' is used twice"),
        ([{"name": "hazard"}], {}, "'hazard' is the name of a setting"),
        ([{**A, "hazard": 2.0}, B], {}, "island a: hazard: input should be less than or equal to 1"),
        ([{**A, "metabolism": {"store": 3.0}}, B], {}, "the task has no metabolism"),
        ([{**A, "mutation": {"kind": "heritable"}}, B], {}, "islands cannot differ in this setting"),
        ([{**A, "placement": {"topology": "ring"}}, B], {"placement": MIXED}, "cannot differ"),
        ([{**A, "placement": {"migration": 3.0}}, B], {"placement": MIXED}, "placement.migration"),
        ([{**A, "share": 100.0}, B], {}, "'b' gets no cell of 8"),
        ([{**A, "share": 7.0}, B], {"placement": MIXED}, "b gets one cell"),
        ([A, B], {"placement": {"migration": 0.1}}, "children cross the borders"),
        ([A, B], {"placement": MIXED}, "the others stay empty; set genesis to fill"),
        ([{**A, "habitat": {"nme": 1}}, B], {}, "island a: there is no setting 'habitat.nme'"),
        ([{**A, "habitat": {"factors": {"gravty": 2.0}}}, B], {}, "did you mean 'gravity'"),
        ([{**A, "habitat": {"factors": {"gravity": 0.0}}}, B], {}, "is not above 0"),
        ([A, B], {"seasons": [{"kind": "schedule", "setting": "a.hazard", "at": 3, "value": 0.1}]},
         "a.hazard is not a setting that seasons can change"),
    ],
)  # fmt: skip
def test_wrong_islands_are_refused_in_one_line(islands: Any, more: Any, message: str) -> None:
    with pytest.raises(InputError, match=message) as told:
        load("CartPole-survival", {"cells": 8, "habitat": {"islands": islands}, **more})
    assert "\n" not in str(told.value)


def test_one_founder_may_begin_where_children_may_migrate() -> None:
    later = {"kind": "schedule", "setting": "placement.migration", "at": 3, "value": 0.1}
    leaving = {**A, "placement": {"migration": 0.1}}
    for islands, seasons in ([leaving, B], []), ([A, B], [later]):
        assert config(habitat={"islands": islands}, placement=MIXED, seasons=seasons).islands
    assert config(habitat={"islands": [A, B]}, placement=MIXED, genesis="fill").islands.count == 2


def test_migration_needs_islands_and_an_environment_has_none() -> None:
    with pytest.raises(InputError, match="this world has no islands"):
        load("CartPole-survival", {"placement": {**MIXED, "migration": 0.1}})
    with pytest.raises(InputError, match="an environment is one habitat"):
        Bodies(config(habitat={"islands": [A, B]}), 2)


def test_borders_on_a_torus_lie_between_rows() -> None:
    """Cells are shared in whole rows of six, as nearly as shares allow."""
    islands = [{**A, "share": 1.0}, {**B, "share": 2.0}]
    torus = config({**MEADOW, "habitat": {**MEADOW["habitat"], "islands": islands}}, cells=24,
                   placement={"topology": "torus4"})  # fmt: skip
    assert torus.placement.shape(24) == (4, 6)
    assert torus.islands.bounds == (0, 6, 24)
    assert torus.islands.of_cells([0, 5, 6, 23]).tolist() == [0, 0, 1, 1]


def test_an_island_as_a_plain_world_has_its_own_rates_and_seasons() -> None:
    seasons = [
        {"kind": "schedule", "setting": "a.hazard", "at": 5, "value": 0.3},
        {"kind": "schedule", "setting": "replication", "at": 6, "value": 0.3},
    ]
    both = config(
        habitat={"islands": [{**A, "hazard": 0.2, "replication": 0.5}, B]}, seasons=seasons
    )
    first, second = both.by_island
    assert (first.hazard, first.replication, first.islands.count) == (0.2, 0.5, 1)
    assert [(each.setting, each.at) for each in first.seasons] == [
        ("hazard", 5),
        ("replication", 6),
    ]
    assert [each.setting for each in second.seasons] == ["replication"]
    assert second == config(seasons=seasons[1:])


def test_accidents_on_one_island_are_accidents_of_the_law() -> None:
    """A law without accidents draws none, so it must know of those that an island alone has."""
    none = law_of(habitat={"islands": [A, B]})
    assert not none.has_hazard
    for islands, seasons in (
        ([{**A, "hazard": 0.1}, B], []),
        ([{**A, "hazard": 0.0}, B], [{"kind": "schedule", "setting": "hazard", "at": 3, "value": 0.1}]),
    ):  # fmt: skip
        law = law_of(habitat={"islands": islands}, seasons=seasons)
        assert law.has_hazard
        assert law.compiled.has_hazard


def test_no_islands_is_a_plain_world() -> None:
    without = config(habitat={"islands": "none"})
    assert without.islands.count == len(without.by_island) == 1
    assert without.build_habitat() == config().build_habitat()
