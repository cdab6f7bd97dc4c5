"""Pictures of a life in an environment show the body after a tick, and the action of the tick."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

pytest.importorskip("gymnasium")

from gymnasium.error import ResetNeeded

from primordia.envs import LifeEnv
from primordia.habitats.cartpole.picture import draw
from tests.toys import Organ
from tests.worlds import MILL, config

TASK = "CartPole-survival"


def test_a_picture_shows_the_present_body_and_the_latest_action() -> None:
    env = LifeEnv(TASK, {"habitat": {"track_limit": 5.0}}, render_mode="rgb_array")
    assert env.metadata["render_fps"] == 50, "from which Gymnasium's recorders read the speed"
    assert LifeEnv.metadata["render_fps"] == 30
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


def test_nothing_is_drawn_without_a_render_mode_or_without_pictures_of_the_habitat() -> None:
    env = LifeEnv(TASK)
    env.reset(seed=1)
    assert env.render() is None
    with pytest.raises(ResetNeeded, match="there is no body to see"):
        LifeEnv(TASK, render_mode="rgb_array").render()
    meadow = {"habitat": {"name": "tests.toys:Meadow"}}
    blind = LifeEnv(TASK, meadow, render_mode="rgb_array")
    blind.reset(seed=1)
    assert blind.render() is None
