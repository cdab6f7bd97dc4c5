"""Pictures of a life in an environment: the body after the tick, with the action that led to it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

pytest.importorskip("gymnasium")

from primordia.envs import LifeEnv
from primordia.envs.bodies import zeros
from primordia.habitats.cartpole.picture import draw
from primordia.habitats.contract import Action, Compound, Continuous, Discrete
from tests.toys import Organ
from tests.worlds import MILL, config

TASK = "CartPole-survival"


def test_a_picture_has_the_present_body_and_the_latest_action() -> None:
    env = LifeEnv(TASK, {"habitat": {"track_limit": 5.0}}, render_mode="rgb_array")
    for seed in (1, 2):
        pictures, actions = [(env.reset(seed=seed)[0], env.render())], [0, 1, 1]
        pictures += [(env.step(action)[0], env.render()) for action in actions]
        for (senses, picture), action in zip(pictures, [0, *actions], strict=True):
            drawn = draw(senses, action, 5.0).convert("RGB")
            np.testing.assert_array_equal(picture, np.asarray(drawn))


class Drawn(Organ):
    """A habitat whose pictures are as wide as an action has numbers."""

    def picture(self, body: Any, action: np.ndarray) -> Image.Image:
        assert not action.any()
        return Image.new("RGB", (len(action), 2))


def test_the_action_of_the_first_picture_has_the_habitats_form(tmp_path: Path) -> None:
    """An action has three numbers: a choice and a vector of two."""
    task = tmp_path / "task.toml"
    task.write_text(config(MILL, habitat={"name": f"{__name__}:Drawn"}).to_toml())
    env = LifeEnv(task, render_mode="rgb_array")
    env.reset(seed=1)
    picture = env.render()
    assert picture is not None
    assert picture.shape == (2, 3, 3)


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


def test_nothing_is_drawn_unless_it_is_asked_for_and_can_be() -> None:
    env = LifeEnv(TASK)
    env.reset(seed=1)
    assert env.render() is None
    meadow = {"habitat": {"name": "tests.toys:Meadow"}}
    blind = LifeEnv(TASK, meadow, render_mode="rgb_array")
    blind.reset(seed=1)
    assert blind.render() is None
