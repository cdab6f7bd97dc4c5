"""Memory of a run: known to the byte before it is needed, and refused if the machine has less."""

from types import SimpleNamespace
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


@pytest.mark.parametrize(
    ("settings", "host"), [(MILL, False), ({**MILL, "seeds": 3, "cells": 40}, True)]
)
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


def device_with(limit: int, in_use: int) -> Any:
    return SimpleNamespace(memory_stats=lambda: {"bytes_limit": limit, "bytes_in_use": in_use})


def test_the_fullest_device_limits_the_share_of_each() -> None:
    """The device with the least free memory counts. A device that reports no memory does not count."""
    devices = [device_with(900, 100), device_with(1000, 700), device_with(400, 50)]
    assert memory.bytes_available(devices) == 3 * 300
    silent: Any = SimpleNamespace(memory_stats=lambda: None)
    assert memory.bytes_available([silent, *devices[:2]]) == 2 * 300


@pytest.mark.parametrize(
    ("limit", "kibibytes", "least"), [(5_000_000, 3_000, 3_072_000), (2_000_000, 3_000, 2_000_000)]
)
def test_the_smaller_of_limit_and_available_memory_counts(
    limit: int, kibibytes: int, least: int, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "max").write_text(f"{limit}\n")
    lines = f"MemTotal: 9999 kB\nMemFree: 1000 kB\nMemAvailable: {kibibytes} kB\nCached: 7 kB\n"
    (tmp_path / "info").write_text(lines)
    monkeypatch.setattr(memory, "CGROUP", tmp_path / "max")
    monkeypatch.setattr(memory, "MEMINFO", tmp_path / "info")
    assert memory.bytes_available([device.default()]) == least


def test_a_run_may_need_all_memory_and_the_message_has_both_amounts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    law, habitat = SimpleNamespace(worlds=3, cells=500), SimpleNamespace()
    monkeypatch.setattr(memory, "bytes_needed", lambda *given: 700_000_000 * given[2])
    monkeypatch.setattr(memory, "bytes_available", lambda devices: 1_400_000_000)
    two: Any = [None, None]
    memory.check(law, habitat, two)
    with pytest.raises(
        InputError, match=r"^cells x seeds: 1,500 cells need 2\.1 GB .* 1\.4 GB are"
    ):
        memory.check(law, habitat, [*two, None])
