"""Lives of robots: exact through a stop and when lived again; shown in pictures."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

import primordia
from primordia.errors import InputError
from primordia.habitats.mujoco import picture as mujoco_picture
from primordia.organism.reliving.compare import relive
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.robots import MOTOR, SLIDE, born, of_task
from tests.worlds import HOSTED

mujoco = pytest.importorskip("mujoco")

BOX: dict[str, Any] = {
    "task": "box",
    **HOSTED,
    "habitat": {
        "name": "mujoco",
        "file": "box.xml",
        "position_noise": 0.5,
        "velocity_noise": 1.0,
        "substeps": 10,
        "fatal": "abs(qpos[0]) > 1",
        "effort": "abs(ctrl[0])",
        "food": "9 * abs(com_forward)",
    },
    "replication": 0.1,
    "hazard": 0.01,
    "stop": {"ticks": 67, "until": "none"},
}
"""Boxes that slide along a line, in a law of other tests. Their food is measured from the place of a
body in the tick before."""


@pytest.fixture(scope="module")
def boxes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of 67 ticks; the model's file lies beside the TOML file that names it."""
    folder = tmp_path_factory.mktemp("boxes")
    (folder / "box.xml").write_text(SLIDE.format(actuator=MOTOR))
    (folder / "box.toml").write_text(tomli_w.dumps(BOX))
    return primordia.run(str(folder / "box.toml"), folder / "run").path


def test_a_run_that_was_stopped_goes_on_exactly_and_only_with_its_model(boxes: Path) -> None:
    """Lives through the stop end when lived again as they did, with food from the place before it."""
    model = boxes.parent / "box.xml"
    model.write_text(SLIDE.format(actuator=MOTOR).replace("0.1", "0.2"))
    complains(here("resume", boxes, "--ticks", 200), 2, "box.xml has changed", "--inexact")
    model.write_text(SLIDE.format(actuator=MOTOR))
    assert here("resume", boxes, "--ticks", 200).returncode == 0
    assert primordia.load(boxes).info()["versions"]["mujoco"] == mujoco.__version__
    run = Archive(boxes)
    lives, through = run.lives, (run.lives.born <= 67) & (run.lives.ended > 67) & run.lives.died
    chosen = np.flatnonzero(through)[:3].tolist() + np.flatnonzero(lives.born > 67)[:3].tolist()
    assert len(chosen) == 6
    for row in chosen:
        found = relive(run, int(lives.id[row]), int(lives.world[row]))
        assert found.agrees, found


@pytest.mark.slow
def test_evaluations_are_cut_where_gymnasium_cuts(tmp_path: Path) -> None:
    small: dict[str, Any] = {"cells": 6, "seeds": 2, "genesis": "fill", "hazard": 0.003}
    stop = {"ticks": 260, "until": "none"}
    run = primordia.run("Reacher-forager-costly", tmp_path / "run", **small, stop=stop)
    evaluation = run.oldest().evaluate(games=3, ticks=400)
    assert evaluation.whole is not None
    assert evaluation.whole.ticks.tolist() == [50] * 3
    assert (evaluation.games, evaluation.distinct) == (3, 3)
    assert 50 < evaluation.lived.ticks.max() <= 400
    assert evaluation.lived.over.all()


def needs_gl() -> None:
    """Skip the test if the machine has no library that draws without a screen."""
    try:
        mujoco_picture._gl_context()
    except InputError as error:
        pytest.skip(str(error))


@pytest.mark.parametrize(
    "task", ["Reacher-forager", pytest.param("HalfCheetah-forager", marks=pytest.mark.slow)]
)
def test_pictures_show_the_robot_in_its_place(task: str) -> None:
    """Another pose gives another picture, and one renderer does not disturb another."""
    needs_gl()
    habitat, other = of_task(task), of_task("Hopper-survival")
    born(habitat)
    born(other)
    action = np.zeros(habitat.action.size, np.float32)
    pose = {"qpos": habitat.seen()["qpos"][0].copy()}
    first = np.asarray(habitat.picture(pose, action)).astype(int)
    assert first.shape == (360 + 56, 640, 3)
    assert first[60:].std() > 5
    other.picture({"qpos": other.seen()["qpos"][0]}, action)
    assert np.abs(np.asarray(habitat.picture(pose, action)) - first).max() <= 2
    pose["qpos"][-3:] += 0.5
    assert (np.abs(np.asarray(habitat.picture(pose, action)) - first).max(axis=2) > 40).sum() > 50
    assert (first[:56] == first[0, 0]).all()


def test_without_opengl_the_error_says_what_to_install(
    boxes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mujoco_picture._gl_context.cache_clear()
    monkeypatch.setenv("MUJOCO_GL", "nothing")
    done = here("replay", boxes, "--to", 10, "--out", tmp_path / "life.mp4")
    mujoco_picture._gl_context.cache_clear()
    complains(
        done,
        2,
        "OpenGL without a screen, and nothing cannot be used; install OSMesa with `apt-get install",
    )
    assert not list(tmp_path.iterdir())
