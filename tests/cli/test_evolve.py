"""What commands that write runs say at their end."""

from pathlib import Path

import pytest

from tests.commands import complains, here
from tests.toys import Meadow
from tests.trouble import SMALL


def test_a_replay_is_recommended_where_the_habitat_draws_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = tmp_path / "run"
    meadow = ("--habitat", '{name = "tests.toys:Meadow"}', "--brain.hidden", 1)
    words = [word for word in SMALL if word != "--quiet"]
    lines = here("run", *words, *meadow, "--ticks", 2, "--out", run).stdout.splitlines()
    figures = f"Figures: primordia plot {run}"
    video = f"Video of the champion: primordia replay {run}"
    assert (figures in lines, video in lines) == (True, False)
    complains(here("replay", run), 2, "draws no pictures, since it has no `picture` and no `rate`")
    monkeypatch.setattr(Meadow, "rate", 50.0, raising=False)
    monkeypatch.setattr(Meadow, "picture", lambda self, body, action: None)
    lines = here("resume", run, "--ticks", 3).stdout.splitlines()
    assert (figures in lines, video in lines) == (True, True)
