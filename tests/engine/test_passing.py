"""Children that begin with what their parents have learned, on the host and without heredity.

`test_strange.py` has such worlds in JAX, and lives of them that are lived again.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import pytest

from primordia.organism.reliving.course import Course, recorded
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.engine.test_strange import first_of, generations, life
from tests.worlds import MEADOW, Lived, config

pytestmark = pytest.mark.slow
LEARNING: dict[str, Any] = {
    **MEADOW,
    "habitat": {"name": "tests.toys:Clocked", "inner": "meadow"},
    "brain": {"kind": "plastic", "hidden": 1, "inherited": True},
    "cells": 60,
    "genesis": "fill",
    "replication": 0.5,
    "hazard": 0.1,
}
"""A small world on the host in which children begin with what their parents have learned."""


def test_without_heredity_children_begin_with_nothing() -> None:
    lonely = Lived(config(LEARNING, inheritance="founder", habitat=MEADOW["habitat"]), 50)
    arrays = lonely.engine.arrays()
    memory, born = (arrays[f"world.organisms.{name}"] for name in ("memory", "born.lo"))
    new = born == 50
    assert 3 < new.sum() < len(new)
    assert memory[arrays["world.organisms.alive"] & ~new].any(axis=1).all()
    assert not memory[new].any()


def test_descendants_on_the_host_live_again_as_recorded(tmp_path: Path) -> None:
    loop.start(config(LEARNING, stop={"ticks": 60}), tmp_path / "host")
    opened = Archive(tmp_path / "host")
    generation = generations(opened)
    right = life(opened, first_of(generation, ~opened.lives.died & (generation > 2)))
    for each, same in ((right, True), (replace(right, first=jnp.zeros_like(right.memory)), False)):
        list((course := Course(each)).stretches())
        assert (course.found()["memory"] == recorded(each)["memory"]) is same
