"""Golden digests of the law's parts."""

from pathlib import Path

import pytest

from tests.goldens import others, placements
from tests.test_goldens import assert_lives_as_it_did, marked

SHOWN = {"blind-torus4-founder", "blind-torus8", "empty-only-ring", "empty-only-well-mixed-saturated",
         "replacing-well-mixed-worlds", "schedules", "ratchets-blocks", "ancestors",
         "host-cartpole-clocked"}  # fmt: skip
"""Laws with each rule, each topology, each kind of season, ancestors, and a habitat on the host."""


@pytest.mark.parametrize("name", marked([*placements(), *others()], SHOWN))
def test_each_law_gives_the_lives_that_it_gave(name: str, tmp_path: Path) -> None:
    assert_lives_as_it_did(name, tmp_path)
