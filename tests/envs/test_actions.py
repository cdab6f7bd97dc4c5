"""Actions in environments: rows for the habitat, and the parts of a compound action."""

import numpy as np
import pytest

pytest.importorskip("gymnasium")

from primordia.envs import LifeEnv, LifeVectorEnv
from primordia.envs.bodies import as_rows, zeros
from primordia.habitats.contract import Action, Compound, Continuous, Discrete


def test_choices_of_every_integer_type_are_rows_and_there_is_a_row_for_each_body() -> None:
    for dtype in (np.uint8, np.int64):
        rows = as_rows(np.array([2, 0], dtype), Discrete(3), 2)
        assert (rows.tolist(), rows.dtype) == ([2, 0], np.int32)
    for count in (1, 3):
        with pytest.raises(ValueError, match=rf"give the shape \(2, 2\), not \({count}, 2\)"):
            as_rows(np.zeros((count, 2)), Continuous(2), 2)


def test_a_single_body_takes_the_parts_of_a_compound_action() -> None:
    """Part 1 is a brake, which is on at 1. The first number of part 2 turns a wheel; the turn is food."""
    settings = {"habitat": {"name": "tests.toys:Organ"}}
    env, many = (
        LifeEnv("CartPole-survival", settings),
        LifeVectorEnv("CartPole-survival", 1, settings),
    )
    np.testing.assert_array_equal(env.reset(seed=1)[0], many.reset(seed=1)[0][0])
    eaten = []
    for brake, numbers in ((2, np.array([0.5, -1])), (np.int64(1), [0.5, 3]), (0, (0.25, 1))):
        senses, _, died, _, info = env.step((brake, numbers))
        np.testing.assert_array_equal(senses, many.step(([brake], [numbers]))[0][0])
        assert not died
        eaten.append(info["food"])
    assert eaten == [0.5, 0.5, 0.75]


@pytest.mark.parametrize(
    ("kind", "dtype", "shape"),
    [
        (Discrete(3), np.int32, (1,)),
        (Continuous(3), np.float32, (1, 3)),
        (Compound((Discrete(3), Continuous(2))), np.float32, (1, 3)),
    ],
)
def test_an_action_of_zeros_has_the_form_of_any_action(
    kind: Action, dtype: type, shape: tuple[int, ...]
) -> None:
    made = zeros(kind)
    assert (made.dtype, made.shape) == (dtype, shape)
    assert not made.any()
