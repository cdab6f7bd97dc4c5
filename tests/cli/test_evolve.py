"""What commands that write runs say at their end."""

from pathlib import Path
from typing import Any

import pytest

from tests.commands import complains, here
from tests.trouble import SMALL


@pytest.mark.parametrize("drawn", [True, False])
def test_a_replay_is_recommended_where_the_habitat_draws_pictures(
    drawn: bool, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    words: tuple[Any, ...] = () if drawn else ("--habitat", '{name = "tests.toys:Meadow"}')
    loud = [word for word in SMALL if word != "--quiet"]
    done = here("run", *loud, *words, "--ticks", 2, "--out", run)
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert f"Figures: primordia plot {run}" in lines
    assert (f"Video of the longest life: primordia replay {run}" in lines) == drawn
    if not drawn:
        complains(here("replay", run), 2, "its habitat draws no pictures (it has no `picture`")
