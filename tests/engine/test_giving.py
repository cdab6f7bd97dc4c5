"""Worlds in which organisms choose when to copy themselves keep the promises, and energy is conserved."""

from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

import primordia
from primordia.history.pedigree import genomes
from primordia.history.summary import summary
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.reliving.compare import relive
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.engine.test_strange import assert_lived_alike
from tests.history.larders import FED, RICH
from tests.history.test_rebuilding import assert_rebuilt
from tests.strange import GIVING, TICKS
from tests.worlds import config


@pytest.fixture(scope="module")
def brim(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("brim") / "run"
    loop.start(config(FED, stop={"ticks": TICKS}), path)
    return path


@pytest.fixture(scope="module")
def giving(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("giving") / "run"
    loop.start(config(GIVING, stop={"ticks": TICKS}), path)
    return path


@pytest.fixture(scope="module", params=["brim", pytest.param("giving", marks=pytest.mark.slow)])
def run(request: pytest.FixtureRequest) -> Path:
    return request.getfixturevalue(request.param)


def test_parents_live_again_with_the_same_energy(run: Path) -> None:
    """Also those that were replaced in the tick of their last child, and the living."""
    opened = Archive(run)
    lives = opened.lives
    children = np.bincount(lives.parent_row[lives.parent_row >= 0], minlength=len(lives))
    last = np.zeros(len(lives), np.int64)
    np.maximum.at(last, lives.parent_row[lives.parent_row >= 0], lives.born[lives.parent_row >= 0])
    at_once = (lives.cause == Cause.REPLACED) & (last == lives.ended)
    chosen = [children > 2, ~lives.died & (children > 0), lives.cause == Cause.HAZARD]
    if opened.config.placement.rule == "replacing":
        chosen.append(at_once)
    for rows in map(np.flatnonzero, chosen):
        assert len(rows)
        for row in rows[-5:]:
            found = relive(opened, int(lives.id[row]), int(lives.world[row]))
            assert found.agrees, found


def test_a_fork_keeps_endowments_and_counts_on(run: Path, tmp_path: Path) -> None:
    before, at = Archive(run), 150
    fork = Archive(primordia.load(run).fork(at, tmp_path / "fork", stop={"ticks": TICKS}).path)
    older = fork.lives.take(np.flatnonzero(fork.lives.inherited))
    assert len(older) > 10
    rows = before.lives.rows_of(older.world, older.id)
    then = before.endowments_of(before.lives.take(rows))
    np.testing.assert_array_equal(fork.endowments_of(older), then)
    assert len(set((then / ONE).tolist())) > 5
    assert len([name for name in before.state if "acts" in name]) == 6
    assert_lived_alike(before, fork)
    assert_rebuilt(fork.path)


def outputs(run: Archive, share: float) -> np.ndarray:
    """Return the copying outputs of all organisms at an energy, as a share of the store: (L, 2)."""
    blocks = run.layout.split(jnp.asarray(genomes(run, np.arange(len(run.lives)))))
    senses = jnp.tile(jnp.array([1, 1, share], jnp.float32), (len(run.lives), 1))
    return np.asarray(run.law.brain(blocks, senses[:, :0], senses)[1], np.float64)[:, 2:]


def test_each_step_of_energy_in_each_life_is_accounted_for(brim: Path) -> None:
    """An account kept here ends with the recorded energy at death, to the last step.

    A tick brings 2 units, or later 8, and costs 1. Whether an organism tries follows from its genome and
    its energy at the beginning of the tick. A try costs its price, whatever follows.
    """
    opened = Archive(brim)
    lives, left = opened.lives, opened.table("deaths").to_pandas().set_index(["world", "id"])
    at_none, at_store = outputs(opened, 0.0), outputs(opened, 1.0)
    endowment, failed = opened.endowments_of(lives), 0
    children = [np.flatnonzero(lives.parent_row == row) for row in range(len(lives))]
    for row in np.flatnonzero(lives.died):
        given = dict(zip(lives.born[children[row]], endowment[children[row]], strict=True))
        energy, tries = int(endowment[row]), 0
        end = lives.ended[row] + (lives.cause[row] == Cause.HAZARD)
        for tick in range(lives.born[row] + 1, lives.ended[row] + 1):
            wish, share = at_none[row] + (at_store - at_none)[row] * energy / (16 * ONE)
            energy = min(energy + (ONE if tick <= RICH else 7 * ONE), 40 * ONE)
            worth = (1 + np.tanh(share / 2)) / 2 * energy >= 1
            if wish > 0 and worth and energy > 0.75 * ONE + 1 and tick < end:
                energy, tries = energy - 3 * ONE // 4, tries + 1
            else:
                assert tick not in given
            energy -= given.get(tick, 0)
        failed += tries - len(given)
        assert energy == round(left["energy"][lives.world[row], lives.id[row]] * ONE)
    assert failed > 100


def test_what_parents_give_is_what_children_begin_with(brim: Path) -> None:
    opened, info = Archive(brim), primordia.load(brim).info()
    lives, endowment = opened.lives, opened.endowments_of(opened.lives)
    children = lives.parent >= 0
    assert set(endowment[~children].tolist()) == {16 * ONE}
    assert len(set(endowment[children].tolist())) > 20
    for world, numbers in enumerate(info["worlds"]):
        own, act = children & (lives.world == world), numbers["act"]
        assert act["children"] == own.sum() > 50
        assert act["invested"] == endowment[own].sum() / ONE
        assert act["failed"] == act["tries"] - act["children"] > 50
        assert act["mean_endowment"] == act["invested"] / act["children"]
    assert "tries to copy" in summary(info)
