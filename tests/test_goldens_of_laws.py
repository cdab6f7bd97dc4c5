"""Golden digests of the law's parts."""

from pathlib import Path

import pytest

from tests.goldens import others, placements
from tests.test_goldens import assert_lives_as_it_did, marked

SHOWN = {"host-ancestors-founder-well-mixed", "seasons-blocks-torus8-worlds"}
"""Laws that have together two rules, both kinds of season, blocks, ancestors, children without heredity
and a habitat on the host. Tasks have the third rule."""


@pytest.mark.parametrize("name", marked([*placements(), *others()], SHOWN))
def test_each_law_gives_the_lives_that_it_gave(name: str, tmp_path: Path) -> None:
    assert_lives_as_it_did(name, tmp_path)
