"""The law in whole worlds, with habitats so simple that one can say what must happen."""

from typing import Any

import numpy as np
import pytest

from primordia.law.metabolism import ONE
from tests.chance import binomial, even
from tests.chronicle import History
from tests.worlds import CLOCKWORK, HERD, RING, Lived, config, law_of


def test_without_food_an_organism_lives_as_long_as_its_store_lasts() -> None:
    """The first organisms have 60 units; organisms born after tick 50 have half a unit more."""
    lived = Lived(config(CLOCKWORK, metabolism={"store": 60.0}), 50)
    lived.change({"metabolism.store": 60.5})
    lived.advance_to(150)
    deaths = lived.table("deaths")
    assert deaths["tick"].tolist() == [60] * 72 + [121] * 72
    assert deaths["cause"].tolist() == ["starved"] * 144
    assert deaths["energy"].tolist() == [0.0] * 72 + [-0.5] * 72
    assert lived.table("births")["tick"].tolist() == np.repeat([0, 60, 121], 72).tolist()


def grown() -> Lived:
    """Return full worlds at tick 100, in which organisms die by accidents and are not born any more."""
    lived = Lived(config(RING), 1)
    lived.change({"replication": 1.0, "hazard": 0.0})
    lived.advance_to(100)
    lived.change({"replication": 0.0, "hazard": 0.01})
    assert np.asarray(lived.engine.state.world.organisms.alive).all()
    return lived


def test_a_nan_kills_its_owner_and_changes_no_other_organism() -> None:
    """One organism has a NaN in its genome, and one of another world in its memory."""
    whole, poisoned, cells = grown(), grown(), [3, 12 + 5]
    whole.advance_to(160)
    world, bodies = poisoned.engine.state
    organisms = world.organisms
    block, memory = np.array(organisms.genome["recurrent"]), np.array(organisms.memory)
    block[cells[0], 0, 0] = memory[cells[1], 0] = np.nan
    organisms = organisms._replace(genome={**organisms.genome, "recurrent": block}, memory=memory)
    poisoned.engine.state = type(poisoned.engine.state)(world._replace(organisms=organisms), bodies)
    poisoned.advance_to(160)
    expected, actual = whole.table("deaths"), poisoned.table("deaths")
    assert 10 < len(expected["id"]) < 40, "choose a seed under which some die and some live"
    own, theirs = (
        np.isin(each["cell"] + 12 * each["world"].astype(int), cells) for each in (actual, expected)
    )
    others = ~theirs
    assert actual["tick"][own].tolist() == [101] * 2
    assert actual["cause"][own].tolist() == ["fault"] * 2
    for column, values in expected.items():
        np.testing.assert_array_equal(actual[column][~own], values[others], err_msg=column)
    for column, values in whole.table("births").items():
        np.testing.assert_array_equal(poisoned.table("births")[column], values, err_msg=column)
    after, without = (run.engine.state.world.organisms for run in (poisoned, whole))
    alive = np.asarray(after.alive)
    assert not alive[cells].any()
    np.testing.assert_array_equal(np.delete(alive, cells), np.delete(without.alive, cells))
    np.testing.assert_array_equal(
        np.asarray(after.memory)[alive], np.asarray(without.memory)[alive]
    )


def test_births_and_deaths_are_as_frequent_as_their_chances() -> None:
    """Founders appear in any cell. Death and the replication of survivors are independent."""
    lived = Lived(config(RING), 1)
    lived.change({"replication": 0.3, "hazard": 0.5})
    lived.advance_to(1000)
    histories = [History(lived, world) for world in range(4)]
    deaths = sum(len(history.dead) for history in histories)
    assert binomial(deaths, sum(history.organism_ticks for history in histories), 0.5)
    founded, again = np.zeros(12, int), []
    alone = survived = replicated = 0
    for history in histories:
        founders = [life for life in history.lives if life.parent is None]
        assert [life.born for life in founders] == [0, *history.extinctions]
        cells = np.array([life.cell for life in founders])
        founded += np.bincount(cells, minlength=12)
        again += (cells[1:] == cells[:-1]).tolist()
        living = history.living_after[0]
        for tick in range(1, history.now + 1):
            before, living = living, history.living_after.get(tick, living)
            if len(before) == 1:
                alone += 1
                survived += before[0] in living
                replicated += before[0] in living and len(living) == 2
    assert even(founded)
    assert binomial(sum(again), len(again), 1 / 12)
    assert binomial(survived, alone, 0.5)
    assert binomial(replicated, survived, 0.3)


def test_genesis_can_fill_every_cell() -> None:
    run = Lived(config(CLOCKWORK), 100)
    births = run.table("births")
    for world in range(3):
        history = History(run, world)
        assert history.extinctions == [31, 62, 93]
        in_world = births["world"] == world
        assert births["tick"][in_world].tolist() == np.repeat([0, 31, 62, 93], 24).tolist()
        assert births["cell"][in_world].tolist() == [*range(24)] * 4
        assert births["id"][in_world].tolist() == [*range(96)]
        assert {(life.cause, life.age) for life in history.dead} == {("starved", 31)}
    assert len(np.unique(run.genomes(), axis=0)) == 72


def test_the_clockwork_has_the_compiled_code_of_the_herd() -> None:
    assert law_of(CLOCKWORK).compiled == law_of(HERD).compiled


@pytest.mark.parametrize(
    ("change", "same"),
    [
        ({"cells": 30, "seeds": 1, "replication": 0.2, "hazard": 0.0, "genesis": "one"}, True),
        ({"placement": {"topology": "ring"}, "sample_every": 7, "saturation_ticks": 9}, True),
        ({"mutation": {"kind": "heritable"}, "recombination": {"probability": 0.5}}, True),
        ({"metabolism": {"store": 30.0, "gain": 2.0}}, True),
        ({"seasons": [{"kind": "schedule", "setting": "hazard", "at": 9, "value": 0.5}]}, True),
        ({"brain": {"hidden": 2}}, False),
        ({"brain": {"hidden": 1, "interoception": True}}, False),
        ({"metabolism": "none"}, False),
        ({"replication": {"kind": "act"}}, False),
    ],
)
def test_lives_share_code_if_all_that_they_meet_is_the_same(change: Any, same: bool) -> None:
    one, other = law_of(HERD).alone, law_of(HERD, **change).alone
    assert (one == other) is same
    assert (hash(one) == hash(other)) is same


def test_an_organism_that_perceives_its_energy_has_its_own_store() -> None:
    feeling = {"brain": {"hidden": 1, "interoception": True}}
    few, many = (law_of(HERD, **feeling, metabolism={"store": n}) for n in (30.0, 60.0))
    assert few.alone != many.alone
    assert few.compiled != many.compiled
    energy = np.array([15 * ONE], np.int32)
    seen = [
        np.asarray(law.alone.perceived(np.zeros((1, 2), np.float32), energy)) for law in (few, many)
    ]
    assert [each[0, -1] for each in seen] == [0.5, 0.25]
