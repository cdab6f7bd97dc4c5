"""Founders that a world might have had: the k-th is the same, however many are made."""

from pathlib import Path

import numpy as np
import pytest

import primordia
from primordia.history import founders as made
from primordia.history.founders import founders
from primordia.runs.records import Records


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Records:
    folder: Path = tmp_path_factory.mktemp("run") / "run"
    stop = {"ticks": 5, "until": "none"}
    return primordia.run("CartPole-survival", folder, seeds=2, cells=4, stop=stop).opened()


def test_a_founder_depends_on_its_number_and_world_alone(
    run: Records, monkeypatch: pytest.MonkeyPatch
) -> None:
    few, many = founders(run, 1, 3), founders(run, 1, 150)
    np.testing.assert_array_equal(few, many[:3])
    assert len(np.unique(many, axis=0)) == 150
    assert (founders(run, 0, 3) != few).any(axis=1).all()
    monkeypatch.setattr(made, "AT_ONCE", 7)
    np.testing.assert_array_equal(founders(run, 1, 20), many[:20])


def test_the_first_founders_are_those_that_they_always_were(run: Records) -> None:
    """Tables of experiments name founders by their numbers."""
    first = [[0.00957343, -0.0262672, -0.00436687], [-0.00482515, 0.00808968, 0.01595863]]
    np.testing.assert_allclose(founders(run, 0, 2)[:, :3], first, rtol=1e-6)
