"""Replication as an act: who tries, what it costs, and that energy is conserved to the last step."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import primordia
from primordia.errors import InputError
from primordia.history.pedigree import genomes
from primordia.history.summary import summary
from primordia.law.act import Act
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.worlds import MEADOW, config

TRIES = jax.jit(Act.tries, static_argnums=0)
BRIM: dict[str, Any] = {
    **MEADOW,
    "habitat": {"name": "tests.toys:Meadow", "food": 2.0, "lifespan": 150},
    "brain": {"kind": "linear", "interoception": True},
    "replication": {"kind": "act", "price": 0.75},
    "placement": {"topology": "torus4"},
    "metabolism": {"store": 16.0, "cap": 40.0},
    "mutation": {"founder_scale": 1.0, "probability": 0.5, "scale": 0.3},
    "genesis": "fill",
    "hazard": 0.01,
    "seeds": 2,
    "stop": {"ticks": 400},
}


def tries(act: Act, copying: list[list[float]], energy: list[int], price: float) -> list[list[int]]:
    """Return (tried, price, endowment) of each organism; energy and results in steps."""
    given = np.array(copying, np.float32), np.array(energy, np.int32), np.float32(price)
    return np.stack([np.asarray(each) for each in TRIES(act, *given)], axis=1).astype(int).tolist()


def test_an_organism_tries_if_its_output_is_above_zero_and_it_can_pay() -> None:
    """With 3 + 5 units to pay, one step more than 8 units is enough, and with `fatal` 8 units are."""
    act, paid = Act(kind="act", endowment=5.0), [1, 3 * ONE, 5 * ONE]
    outputs = [[1.0], [1e-30], [0.0], [-1.0], [np.nan], [1.0]]
    energy = [*[8 * ONE + 1] * 5, 8 * ONE]
    none = [0, 0, 0]
    assert tries(act, outputs, energy, 3.0) == [paid, paid, none, none, none, none]
    fatal = act.model_copy(update={"fatal": True})
    assert tries(fatal, outputs, energy, 3.0) == [paid, paid, none, none, none, paid]
    assert tries(fatal, [[1.0]], [8 * ONE - 1], 3.0) == [none]


def test_a_chosen_endowment_is_a_share_of_the_energy_that_leaves_one_step() -> None:
    """The share is 1/2 at 0, and cut where the parent could not pay the price any more."""
    act = Act(kind="act")
    outputs = [[1.0, 0.0], [1.0, 2 * np.arctanh(0.5)], [1.0, 100.0], [1.0, -100.0], [1.0, 100.0]]
    energy = [64 * ONE, 64 * ONE, 64 * ONE, 64 * ONE, 4 * ONE + 1]
    price = 4 * ONE
    half, most, (none, just) = (
        [1, price, 32 * ONE],
        [1, price, 60 * ONE - 1],
        ([0, 0, 0], [0, 0, 0]),
    )
    found = tries(act, outputs, energy, 4.0)
    assert [found[0], found[2], found[3], found[4]] == [half, most, none, just]
    assert found[1][2] == pytest.approx(48 * ONE, abs=1)
    fatal = tries(act.model_copy(update={"fatal": True}), outputs, energy, 4.0)
    assert fatal[2] == [1, price, 60 * ONE]
    assert fatal[4] == [1, price, 1]


@pytest.fixture(scope="module")
def brim(tmp_path_factory: pytest.TempPathFactory) -> Archive:
    run = tmp_path_factory.mktemp("brim") / "run"
    loop.start(config(BRIM), run)
    return Archive(run)


def outputs(run: Archive, share: float) -> np.ndarray:
    """Return the copying outputs of all organisms at an energy, as a share of the store: (L, 2)."""
    blocks = run.layout.split(jnp.asarray(genomes(run, np.arange(len(run.lives)))))
    senses = jnp.tile(jnp.array([1, 1, share], jnp.float32), (len(run.lives), 1))
    return np.asarray(run.law.brain(blocks, senses[:, :0], senses)[1], np.float64)[:, 2:]


def test_each_step_of_energy_in_each_life_is_accounted_for(brim: Archive) -> None:
    """An account kept here ends with the recorded energy at death, to the last step.

    A tick brings 2 units and costs 1. Whether an organism tries follows from its genome and its energy at
    the beginning of the tick. A try costs its price, also if no child is born or an accident follows.
    """
    lives, left = brim.lives, brim.table("deaths").to_pandas().set_index(["world", "id"])
    at_none, at_store = outputs(brim, 0.0), outputs(brim, 1.0)
    endowment, failed = brim.endowments_of(lives), 0
    children = [np.flatnonzero(lives.parent_row == row) for row in range(len(lives))]
    for row in np.flatnonzero(lives.died):
        given = dict(zip(lives.born[children[row]], endowment[children[row]], strict=True))
        energy, tries = int(endowment[row]), 0
        end = lives.ended[row] + (lives.cause[row] == Cause.HAZARD)
        for tick in range(lives.born[row] + 1, lives.ended[row] + 1):
            wish, share = at_none[row] + (at_store - at_none)[row] * energy / (16 * ONE)
            energy = min(energy + ONE, 40 * ONE)
            worth = (1 + np.tanh(share / 2)) / 2 * energy >= 1
            if wish > 0 and worth and energy > 0.75 * ONE + 1 and tick < end:
                energy, tries = energy - 3 * ONE // 4, tries + 1
            else:
                assert tick not in given
            energy -= given.get(tick, 0)
        failed += tries - len(given)
        assert energy == round(left["energy"][lives.world[row], lives.id[row]] * ONE)
    assert failed > 100


def test_what_parents_give_is_what_children_begin_with(brim: Archive) -> None:
    lives, endowment, info = (
        brim.lives,
        brim.endowments_of(brim.lives),
        primordia.load(brim.path).info(),
    )
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


def test_an_act_needs_a_metabolism() -> None:
    with pytest.raises(InputError, match=r"replication\.kind: .* needs a metabolism"):
        config(MEADOW, replication={"kind": "act"})
