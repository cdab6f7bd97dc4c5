"""The oldest organisms, others and founders born again."""

import numpy as np
import pytest

import primordia
from primordia.assays.garden import Bed, garden
from primordia.errors import InputError


def test_each_world_has_a_bed_of_each_group(poles: primordia.Run) -> None:
    found = garden(poles.opened(), each=6, games=2, ticks=400)
    assert [(bed.group, bed.world) for bed in found] == [
        (group, world) for group in ("oldest", "late-born", "founders") for world in (0, 1)
    ]
    lives = poles.lives()
    for bed in found[:2]:
        late = lives.late() & (lives.world == bed.world)
        assert bed.recorded is not None
        assert bed.recorded.tolist() == sorted(lives.lifespan[late])[::-1][:6]
    for bed in found[:4]:
        rows = [lives.row(int(each), bed.world) for each in bed.organism]
        assert bed.recorded is not None
        np.testing.assert_array_equal(bed.recorded, lives.lifespan[rows])
        assert bed.kept == pytest.approx(bed.reborn.mean() / bed.recorded.mean())
    for bed in found[4:]:
        assert (bed.recorded, bed.kept, len(bed.organism)) == (None, None, 6)
        assert bed.to_dict()["reborn"] == bed.reborn.tolist()


def test_organisms_without_a_recorded_life_keep_nothing() -> None:
    bed = Bed("oldest", 0, np.arange(2), np.zeros(2, int), np.array([3.0, 4.0]))
    assert bed.kept is None


def test_the_reborn_live_as_in_an_evaluation(poles: primordia.Run) -> None:
    bed = garden(poles.opened(), each=3, games=2, ticks=400)[1]
    organisms = [poles.organism(int(each), 1) for each in bed.organism]
    evaluated = poles.evaluate(organisms, games=2, ticks=400)
    assert bed.reborn.tolist() == [each.lived.ticks.mean() for each in evaluated]


def test_founders_live_in_the_changed_habitat_too(poles: primordia.Run) -> None:
    free = garden(poles.opened(), each=4, games=1, ticks=400)
    heavy = garden(poles.opened(), each=4, games=1, ticks=400, habitat={"angle_limit": 2.0})
    for before, after in zip(free, heavy, strict=True):
        np.testing.assert_array_equal(before.organism, after.organism)
        assert (before.reborn != after.reborn).any()
    with pytest.raises(InputError, match="no setting 'weight'"):
        garden(poles.opened(), habitat={"weight": 1})
