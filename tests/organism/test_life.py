"""Lives lived again, and the properties of an organism, all from its records."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax
import numpy as np
import pytest

import primordia
from primordia.law.life import BODILY
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.organism import Organism
from primordia.organism.reliving.compare import relive
from primordia.organism.reliving.instant import Stretch
from primordia.organism.reliving.relived import RelivedLife
from primordia.random.wide import wide
from primordia.runs.archive import Archive
from tests.worlds import MILLS


@pytest.mark.parametrize("which", ["mill", "poles"])
def test_the_living_reach_their_recorded_state_when_lived_again(
    which: str, request: pytest.FixtureRequest
) -> None:
    """Alone, and later, bodies and energy are the same bits, with noisy motors and seasons."""
    run = Archive(request.getfixturevalue(which))
    lives = run.lives
    alive = np.flatnonzero(~lives.died & (lives.lifespan > 0))
    for row in alive[:: max(1, len(alive) // 6)]:
        found = relive(run, int(lives.id[row]), int(lives.world[row]))
        assert found.agrees, found


def test_a_second_life_of_another_length_compiles_nothing(
    poles: Path, caplog: pytest.LogCaptureFixture
) -> None:
    run = Archive(poles)
    lives = run.lives
    one, other = np.flatnonzero(lives.died & (lives.lifespan > 3))[[0, 1]]
    assert lives.lifespan[one] != lives.lifespan[other]
    list(RelivedLife.of(run, lives.id[one]).stretches())
    with jax.log_compiles():
        list(RelivedLife.of(run, lives.id[other]).stretches())
    assert "Finished XLA compilation" not in caplog.text


def test_an_accident_kills_only_what_dies_of_nothing_else() -> None:
    """Neither in a tick without an accident nor in one with it does another cause change."""
    causes, none = np.array([-1, *BODILY], np.int32), np.zeros(0)
    ticks = np.arange(2 * len(causes))
    stretch = Stretch(ticks, none, none, None, none, none, np.tile(causes, 2), none)
    life: Any = SimpleNamespace(
        law=SimpleNamespace(has_hazard=True),
        record=SimpleNamespace(cell=np.zeros(1, np.int32)),
        _seed=wide([7]),
    )
    hazard = np.repeat(np.float32([0, 1]), len(causes))
    found = RelivedLife._with_accidents(life, stretch, ticks, {"hazard": hazard})
    assert found.cause.tolist() == [*causes, Cause.HAZARD, *BODILY]


def test_a_life_begins_with_the_store_in_force_in_the_tick_of_its_birth(mill: Path) -> None:
    """In this past, the store is as large as the number of the tick."""
    run = Archive(mill)
    past = SimpleNamespace(of_lives=lambda lives, ticks: {"metabolism.store": np.float32(ticks)})
    for row in np.flatnonzero(run.lives.born > 0)[[0, 9, -1]]:
        life = RelivedLife.of(run, run.lives.id[row], run.lives.world[row])
        life.__dict__["_past"] = past
        held, _ = next(life.instants())
        assert held["world.organisms.energy"] == run.lives.born[row] * ONE


def test_a_policy_acts_as_its_organism_did(poles: Path) -> None:
    organism = primordia.load(poles).oldest()
    seen = next(RelivedLife.of(organism.run, organism.id, organism.world).stretches())
    policy = organism.policy()
    assert [policy(each) for each in seen.senses[:200]] == seen.action[:200].tolist()
    policy.reset()
    assert policy(seen.senses[0]) == seen.action[0]


def test_a_policy_gives_continuous_actions(mill: Path) -> None:
    """They are those of the organism in its life, less the noise of its motor."""
    organism = primordia.load(mill).oldest()
    policy, life = organism.policy(), RelivedLife.of(organism.run, organism.id, organism.world)
    seen = next(life.stretches())
    actions = [policy(senses) for senses in seen.senses[:200]]
    assert {(action.shape, action.dtype.name) for action in actions} == {((2,), "float32")}
    noise = seen.action[:200] - np.array(actions)
    assert noise.std() == pytest.approx(MILLS["motor"]["sd"], rel=5 / np.sqrt(2 * noise.size))
    assert np.abs(np.corrcoef(noise.T)[0, 1]) < 5 / np.sqrt(len(noise))
    assert np.array(actions).std() > 0.01
    policy.reset()
    np.testing.assert_array_equal(policy(seen.senses[0]), actions[0])


def test_an_organism_has_the_properties_that_are_recorded(poles: Path) -> None:
    run = primordia.load(poles)
    births, ended = (
        [row for row in run.table(name).to_pylist() if row["world"] == 0]
        for name in ("births", "deaths")
    )
    deaths = {row["id"]: row for row in ended}
    opened = run.opened()
    by_id = {row["id"]: Organism(opened, opened.lives.row(row["id"])) for row in births}
    parents = [row["parent"] for row in births]
    assert {None, 0} <= {*parents}
    assert [by_id[row["id"]].parent for row in births] == parents
    for row in births[::40]:
        organism = by_id[row["id"]]
        assert (organism.parent, organism.cell, organism.born) == (
            row["parent"], row["cell"], row["tick"])  # fmt: skip
        died = deaths.get(row["id"])
        assert organism.cause == (died["cause"] if died else None)
        assert organism.age == (died["tick"] if died else 6000) - row["tick"]
        line = organism.descent()
        assert line[-1] == organism.id
        assert by_id[line[0]].birth_cause == "founder"
        assert [by_id[child].parent for child in line[1:]] == line[:-1]
    later = list(by_id.values())[len(by_id) // 2 :]
    assert run.oldest(0).age == max(organism.age for organism in later)
    assert run.organism(organism.id).descent() == organism.descent()
