"""Bodies at birth."""

from pathlib import Path

import pytest

from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.organism.test_life import assert_ends_as_recorded
from tests.worlds import MEADOW, config


@pytest.mark.parametrize("cells", [32, pytest.param(1024, marks=pytest.mark.slow)])
def test_a_body_starts_as_it_was_born(cells: int, tmp_path: Path) -> None:
    """Compiled code may round a product and a sum once, and several bodies may be born as vectors."""
    full = {"genesis": "fill", "replication": 0.0, "cells": cells, "stop": {"ticks": 2}}
    loop.start(config(MEADOW, habitat={"name": "tests.toys:Slope"}, **full), tmp_path / "run")
    run = Archive(tmp_path / "run")
    for row in range(0, cells, cells // 16):
        assert_ends_as_recorded(RelivedLife.of(run, row))
