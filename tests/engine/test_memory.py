"""Memory of a run: known to the byte before it is needed, and refused if the machine has less."""

from typing import Any

import jax
import pytest

from primordia import device
from primordia.engine import memory
from primordia.engine.engine import Engine
from primordia.errors import InputError
from tests.commands import complains, here
from tests.toys import HOST_CARTPOLE
from tests.worlds import MILL, config


@pytest.mark.parametrize("settings", [MILL, {**MILL, "seeds": 3, "cells": 40}])
@pytest.mark.parametrize("host", [False, True])
def test_the_bytes_needed_are_those_of_the_state_and_the_lists(
    settings: dict[str, Any], host: bool
) -> None:
    if host:
        settings = {**settings, "habitat": HOST_CARTPOLE, "motor": {}}
    engine = Engine(config(settings))
    needed = memory.bytes_needed(engine.law, engine.config.build_habitat())
    assert needed == sum(leaf.nbytes for leaf in jax.tree.leaves((engine.state, engine.events)))


def test_a_run_for_which_there_is_no_memory_is_refused_before_anything_is_made(
    tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert memory.bytes_available([device.default()]) > 1e8
    monkeypatch.setattr(memory, "bytes_available", lambda _: int(2e10))
    for words in (("--cells", 2**24, "--seeds", 4), ("--brain.hidden", 4096, "--seeds", 300)):
        done = here("run", "CartPole-survival", *words, "--out", tmp_path / "run", "--quiet")
        complains(done, 2, "GB of memory or more, 20.0 GB are available; choose fewer cells")
        assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("text", [None, "max", "0"])
def test_the_memory_of_a_container_is_a_limit(
    text: str | None, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    limit, nowhere = tmp_path / "memory.max", tmp_path / "none"
    if text is not None:
        limit.write_text(text)
    monkeypatch.setattr(memory, "CGROUP", limit)
    monkeypatch.setattr(memory, "MEMINFO", nowhere)
    assert (memory.bytes_available([device.default()]) == 0) == (text == "0")
    if text == "0":
        with pytest.raises(InputError, match="of memory or more, 0"):
            Engine(config())
