"""What commands that write runs say at their end."""

from pathlib import Path
from typing import Any
from unittest.mock import MagicMock, patch

import pytest

from primordia import interrupts
from tests.commands import complains, here
from tests.toys import Meadow
from tests.worlds import HERD, config


def test_a_replay_is_recommended_where_the_habitat_draws_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = tmp_path / "run"
    file = tmp_path / "herd.toml"
    file.write_text(config(HERD).to_toml())
    lines = here("run", file, "--ticks", 2, "--out", run).stdout.splitlines()
    figures = f"Figures: primordia plot {run}"
    video = f"Video of the champion: primordia replay {run}"
    assert (figures in lines, video in lines) == (True, False)
    complains(here("replay", run), 2, "draws no pictures, since it has no `picture` and no `rate`")
    monkeypatch.setattr(Meadow, "rate", 50.0, raising=False)
    monkeypatch.setattr(Meadow, "picture", lambda self, body, action: None)
    lines = here("resume", run, "--ticks", 3).stdout.splitlines()
    assert (figures in lines, video in lines) == (True, True)


def resumed(path: Path, resume: Any) -> Any:
    """Return the finished command `resume`, in which a function takes the place of the run's own."""
    run = MagicMock()
    run.resume.side_effect = resume
    with patch("primordia.api.load", return_value=run):
        return here("resume", path, "--quiet")


@pytest.mark.parametrize("begun", [True, False])
def test_a_command_that_is_stopped_says_how_to_go_on_if_there_is_a_run(
    begun: bool, tmp_path: Path
) -> None:
    if begun:
        (tmp_path / "versions.json").touch()
    done = resumed(tmp_path, KeyboardInterrupt)
    saved = f"Stopped and saved. Go on with: primordia resume {tmp_path}\n"
    assert done.returncode == interrupts.STATUS
    assert done.stderr == (saved if begun else f"Stopped before {tmp_path} had begun\n")


def test_every_note_on_a_resumed_run_is_a_line(tmp_path: Path) -> None:
    done = resumed(tmp_path, lambda **_: ["one thing", "another"])
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr == "primordia: one thing\nprimordia: another\n"
