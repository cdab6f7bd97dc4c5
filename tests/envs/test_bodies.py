"""Bodies of a vector environment: their energy and food, their number, and their spaces."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from gymnasium import spaces

from primordia.envs import LifeVectorEnv, vector
from primordia.envs.bodies import Births, Bodies, action_space, observation_space
from primordia.habitats.contract import Compound, Continuous, Discrete
from primordia.law.world import Cause
from tests.worlds import MEADOW, config


def test_each_life_of_a_body_begins_with_a_full_store_and_without_food() -> None:
    """The energy of a body changes by 0.5 x 2 - 3 in a tick. The dead neither eat nor starve."""
    habitat, hunger = {**MEADOW["habitat"], "food": 0.5}, {"store": 9.0, "drain": 3.0, "gain": 2.0}
    bodies = Bodies(config({**MEADOW, "habitat": habitat}, metabolism=hunger), 4)

    def begin(*cells: int) -> None:
        numbers = np.array(cells, int)
        bodies.begin(numbers, Births(0 * numbers, 0 * numbers, numbers))

    def energy_and_food() -> list[list[float]]:
        assert bodies.energy is not None
        return [bodies.energy.tolist(), bodies.food.tolist()]

    begin(0, 1, 2, 3)
    assert energy_and_food() == [[9] * 4, [0] * 4]
    for alive in ([True] * 4, [True, False, True, True], [True, False, True, True]):
        bodies.step(np.zeros(4, np.int32), np.array(alive))
    assert energy_and_food() == [[3, 7, 3, 3], [1.5, 0.5, 1.5, 1.5]]
    begin()
    begin(1, 2, 3)
    assert energy_and_food() == [[3, 9, 9, 9], [1.5, 0, 0, 0]]
    causes = [bodies.step(np.zeros(4, np.int32), np.ones(4, bool)).tolist() for _ in range(2)]
    assert causes == [[-1] * 4, [Cause.STARVED, -1, -1, -1]]
    assert energy_and_food() == [[-1, 5, 5, 5], [2.5, 1, 1, 1]]
    bodies.close()


def test_a_vector_has_at_most_2_to_the_24_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    """The test replaces the bodies, so that none is made."""

    def make(config: Any, count: int) -> None:
        raise MemoryError(count)

    monkeypatch.setattr(vector, "Bodies", make)
    with pytest.raises(MemoryError, match=str(2**24)):
        LifeVectorEnv("CartPole-survival", 2**24)
    with pytest.raises(ValueError, match="num_envs"):
        LifeVectorEnv("CartPole-survival", 2**24 + 1)


SPACES: list[tuple[Any, spaces.Space]] = [
    (Discrete(3), spaces.Discrete(3)),
    (Continuous(2), spaces.Box(-np.inf, np.inf, (2,), np.float32)),
    (
        Continuous(2, ((-1.0, 0.0), (2.0, np.inf))),
        spaces.Box(np.float32([-1, 0]), np.float32([2, np.inf])),
    ),
    (
        Compound((Discrete(2), Continuous(1, ((-3.0,), (4.0,))))),
        spaces.Tuple([spaces.Discrete(2), spaces.Box(-3, 4, (1,), np.float32)]),
    ),
]


@pytest.mark.parametrize(("action", "space"), SPACES)
def test_spaces_are_those_of_the_habitat(action: Any, space: spaces.Space) -> None:
    bodies: Any = SimpleNamespace(habitat=SimpleNamespace(action=action, senses_size=5))
    assert action_space(bodies) == space
    assert observation_space(bodies) == spaces.Box(-np.inf, np.inf, (5,), np.float32)
