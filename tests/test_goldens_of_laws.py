"""Golden digests of the law's parts. One of them is also tested by tests/engine/test_strange.py."""

from pathlib import Path

import pytest

from tests.goldens import others, placements
from tests.test_goldens import assert_lives_as_it_did

CASES = dict([*placements(), *others()])


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_each_law_gives_the_lives_that_it_gave(name: str, tmp_path: Path) -> None:
    assert_lives_as_it_did(name, tmp_path)
