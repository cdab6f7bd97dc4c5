"""Bodies at birth."""

from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from primordia.compiled import jit
from primordia.organism.reliving.compare import relive
from primordia.organism.reliving.in_jax import LifeInJax
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.toys import Slope
from tests.worlds import MEADOW, config, law_of


def test_a_body_alone_starts_as_one_among_many() -> None:
    """Compiled code may round a product and a sum once, and several bodies may be born as vectors."""
    words = np.random.default_rng(3).integers(0, 2**32, (64, 2), np.uint32)
    law, no_mind = law_of(MEADOW), cast(Any, None)
    alone = LifeInJax(law, no_mind, Slope())
    bodies = np.concatenate([alone.embody(each[None]) for each in words])
    np.testing.assert_array_equal(bodies, jit(Slope().reset)(words))


@pytest.mark.slow
@pytest.mark.parametrize("cells", [32, 1024])
def test_a_body_starts_as_it_was_born(cells: int, tmp_path: Path) -> None:
    full = {"genesis": "fill", "replication": 0.0, "cells": cells, "stop": {"ticks": 2}}
    loop.start(config(MEADOW, habitat={"name": "tests.toys:Slope"}, **full), tmp_path / "run")
    run = Archive(tmp_path / "run")
    for row in range(0, cells, cells // 16):
        found = relive(run, row)
        assert found.agrees, found
