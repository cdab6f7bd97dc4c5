"""Founders that a world might have had: the k-th is the same, however many are made."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.history import founders as made
from primordia.history.founders import founders
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide
from tests.worlds import config


@pytest.fixture(scope="module")
def run() -> Any:
    """Return what founders need to know of a run, of which nothing has lived."""
    settings = config("CartPole-survival", seeds=2)
    law = settings.build_law(settings.build_habitat())
    return SimpleNamespace(
        config=settings,
        world_seeds=settings.world_seeds,
        heredity=law.heredity,
        description=SimpleNamespace(beginning=dict(law.beginning)),
        origin=None,
    )


def test_a_founder_depends_on_its_number_and_world_alone(run: Any) -> None:
    few, many = founders(run, 1, 3), founders(run, 1, 150)
    np.testing.assert_array_equal(few, many[:3])
    assert len(np.unique(many, axis=0)) == 150
    assert (founders(run, 0, 3) != few).any(axis=1).all()


def test_the_first_founders_are_those_that_they_always_were(run: Any) -> None:
    """Tables of experiments name founders by their numbers."""
    first = [[0.00957343, -0.0262672, -0.00436687], [-0.00482515, 0.00808968, 0.01595863]]
    np.testing.assert_allclose(founders(run, 0, 2)[:, :3], first, rtol=1e-6)


def test_founders_are_made_for_their_world_as_it_began(monkeypatch: pytest.MonkeyPatch) -> None:
    """They have the world's seed, and its climate at tick 0. Founders are made 4 at a time."""
    asked: list[tuple[list[int], list[int]]] = []
    numbers: list[int] = []

    class Past:
        def __init__(self, run: Any) -> None: ...

        def of_worlds(self, worlds: np.ndarray, ticks: np.ndarray) -> str:
            asked.append((worlds.tolist(), ticks.tolist()))
            return "climate"

    def make(seed: Wide, number: Wide, climate: str) -> np.ndarray:
        assert (climate, made_of(seed)) == ("climate", made_of(control))
        numbers.extend(np.asarray(number.lo).tolist())
        return np.asarray(number.lo)[:, None]

    def made_of(words: Wide) -> list[list[int]]:
        return [np.asarray(word).tolist() for word in words]

    seeds = np.array([5, 6, 7], np.uint64)
    control = stream(wide(seeds[[2]]), Purpose.CONTROL, wide([0]))
    monkeypatch.setattr(made, "PastClimate", Past)
    monkeypatch.setattr(made, "shared", lambda *_: make)
    monkeypatch.setattr(made, "AT_ONCE", 4)
    found = founders(SimpleNamespace(world_seeds=seeds, heredity=None), 2, 9)
    assert found.ravel().tolist() == [*range(9)]
    assert (asked, numbers) == ([([2] * 4, [0] * 4)], [*range(12)])
