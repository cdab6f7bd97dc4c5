"""Golden digests of the law's parts, in code that is optimised as users' code is."""

from pathlib import Path

import pytest

from tests.goldens import others, placements
from tests.test_goldens import assert_lives_as_it_did

pytestmark = pytest.mark.usefixtures("optimised")


@pytest.mark.parametrize("name", dict([*placements(), *others()]))
def test_each_law_gives_the_lives_that_it_gave(name: str, tmp_path: Path) -> None:
    assert_lives_as_it_did(name, tmp_path)
