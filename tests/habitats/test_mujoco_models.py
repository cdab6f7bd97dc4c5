"""Models that users bring, and what is refused."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from primordia.habitats.mujoco import simulator as mujoco_model
from tests import commands
from tests.commands import complains, here
from tests.robots import SLIDE, born, opened

mujoco = pytest.importorskip("mujoco")


def test_sites_are_perceived_in_three_coordinates(tmp_path: Path) -> None:
    """A hinge of the y axis turns the arm's tip from x to -z."""
    file = tmp_path / "arm.xml"
    file.write_text(
        '<mujoco><worldbody><body><joint name="hinge" type="hinge" axis="0 1 0"/><geom size="0.1"/>'
        '<site name="tip" pos="1 0.25 0.5"/></body></worldbody>'
        '<actuator><motor joint="hinge"/></actuator></mujoco>'
    )
    arm = opened(2, file=str(file), senses=('site["tip"]', "qpos"), position_noise=1.0, substeps=1)
    senses = born(arm, 2)
    arm.close()
    cosine, sine = np.cos(senses[:, 3]), np.sin(senses[:, 3])
    expected = [cosine + 0.5 * sine, np.full(2, 0.25), 0.5 * cosine - sine]
    np.testing.assert_allclose(senses[:, :3], np.stack(expected, axis=1), atol=1e-6)
    assert senses[0, 3] != senses[1, 3]
    with pytest.raises(ValueError, match=r"from site\['tip'\]\[0\] to site\['tip'\]\[2\]"):
        opened(2, file=str(file), senses=('site["tip"][3]',))


@pytest.mark.parametrize(
    ("flags", "says"),
    [
        (["--habitat.file", "nowhere.xml"], "file: there is no nowhere.xml"),
        (["--habitat.file", "gymnasium:dog.xml"], "dog.xml"),
        (["--habitat.file", "bad.xml"], "bad.xml: XML"),
        (["--habitat.file", "still.xml"], "still.xml has no actuators"),
        (["--habitat.fatal", "heihgt < 1"], "there is no 'heihgt'; known: qpos, qvel"),
        (["--habitat.fatal", "qpos[99] < 1"], "qpos goes from qpos[0] to qpos[8]"),
        (["--habitat.food", 'xpos["foot"][0]'], "xpos has the parts world, torso"),
        (["--habitat.senses", '["qpos[1:]", "velocity"]'], "there is no 'velocity'"),
    ],
)
def test_wrong_settings_are_errors_that_say_why(
    flags: list[str], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("bad.xml").write_text("<mujoco><body></mujoco>")
    Path("still.xml").write_text(SLIDE.format(actuator=""))
    complains(here("run", "HalfCheetah-forager", *flags, "--out", "run"), 2, says)
    assert not Path("run").exists()
    assert not Path("MUJOCO_LOG.TXT").exists()


def test_without_the_extra_the_error_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    import sys

    mujoco_model.package.cache_clear()
    monkeypatch.setitem(sys.modules, "mujoco", None)
    done = here("run", "HalfCheetah-forager", "--out", tmp_path / "run")
    mujoco_model.package.cache_clear()
    complains(done, 2, "pip install 'primordia[mujoco]'")


PICTURE = """
import weakref
from primordia.habitats.mujoco.picture import Renderer
from primordia.habitats.mujoco.simulator import load_model

class Early:
    pass

early = Early()
weakref.finalize(early, print, "finalizers of earlier objects come last")
model = load_model("gymnasium:reacher.xml", None)
print(Renderer(model).draw(model.qpos0).size)
"""


def test_a_process_that_has_drawn_ends_in_silence() -> None:
    """EGL's display is closed at exit, before objects are finalized; contexts must be gone by then."""
    variables = {**commands.environment(), "MUJOCO_GL": "egl"}
    words = [sys.executable, "-c", PICTURE]
    done = subprocess.run(words, env=variables, capture_output=True, text=True, check=False)
    if "cannot be used" in done.stderr or "cannot be loaded" in done.stderr:
        pytest.skip("there is no EGL here")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("(640, 416)")
