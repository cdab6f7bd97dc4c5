"""The doctor: what is installed, whether the promises hold, and that it finds when they do not."""

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from importlib.metadata import metadata
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from primordia import compiled, device
from primordia.cli.doctor import doctor
from primordia.doctor import installed, memo, promises
from primordia.doctor.promises import Trial
from primordia.history.pedigree import genomes
from primordia.organism.reliving.compare import Reliving, relive
from tests.commands import well_formed
from tests.worlds import config


def without_the_cure(function: Any) -> Any:
    """Undo the cure: let the compiler contract and regroup."""
    return lambda zero, *arguments: function(*arguments)


def test_it_finds_that_arithmetic_is_not_as_written(monkeypatch: pytest.MonkeyPatch) -> None:
    assert promises._arithmetic() == ""
    monkeypatch.setattr(compiled, "rounded", without_the_cure)
    assert "numbers are rounded in another way than by NumPy" in promises._arithmetic()


def test_a_trial_that_fails_in_any_way_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> str:
        raise RuntimeError("no\nmemory")

    monkeypatch.setattr(promises, "_attempts", lambda: iter([("a", broken), ("b", lambda: "")]))
    assert list(promises.trials()) == [Trial("a", "RuntimeError: no memory"), Trial("b", "")]


def test_every_extra_of_the_package_is_named() -> None:
    assert set(installed.extras()) == set(metadata("primordia").get_all("Provides-Extra") or ())


def test_it_finds_lives_and_genomes_that_differ_from_the_records(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = tmp_path / "run"
    few = {"cells": 8, "hazard": 0.002}
    monkeypatch.setattr(promises, "load", lambda task, given: config(task, **{**given, **few}))
    assert promises._lived_again(run) == ""
    assert promises._rebuilt(run) == ""

    def changed(*of: Any) -> np.ndarray:
        first, *others = genomes(*of)
        return np.stack([first + np.float32(1e-3), *others])

    def otherwise(*of: Any) -> Reliving:
        found = relive(*of)
        return replace(found, respects=tuple(replace(each, relived="?") for each in found.respects))

    monkeypatch.setattr(promises, "genomes", changed)
    assert promises._rebuilt(run).startswith("1 of ")
    monkeypatch.setattr(promises, "relive", otherwise)
    assert " differs in " in promises._lived_again(tmp_path / "other")


def test_runs_of_other_processes_are_on_the_device_that_is_tried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[list[str]] = []
    monkeypatch.setattr(promises, "_platform", lambda: "gpu")
    monkeypatch.setattr(subprocess, "Popen", lambda words, **_: asked.append(words))
    promises._begun(tmp_path / "run", "--speed", "9")
    assert ("--device", "gpu") in pairwise(asked[0])
    well_formed(*asked[0][3:])
    trials = [name for name, _ in promises._attempts()]
    assert "a world on one thread is the same as on all" not in trials
    assert trials[-2:] == [
        "lives that are lived again end as recorded",
        "genomes that the CPU rebuilds are those of the run",
    ]


def test_what_a_run_says_that_ends_early_is_the_fault(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\necho there is no room for $4 >&2\nexit 2\n")
    python.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(python))
    assert promises._killed(["digest"]) == f"there is no room for {promises.TASK}\n"


@pytest.mark.slow
def test_the_promises_hold_here() -> None:
    assert [trial for trial in promises.trials() if trial.fault] == []


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    return tmp_path


@pytest.mark.parametrize("fault", ["", "1a2b... alone, 3c4d... beside others"])
def test_the_exit_status_says_whether_all_promises_hold(
    fault: str, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def trials() -> Iterator[Trial]:
        yield Trial("chunks", "")
        yield Trial("worlds", fault)

    monkeypatch.setattr(promises, "trials", trials)
    refused = CliRunner().invoke(doctor, ["--device", "tpu"])
    assert "JAX finds no 'tpu' device" in str(refused.exception)
    shown = CliRunner().invoke(doctor)
    assert shown.exit_code == (1 if fault else 0)
    assert "holds  chunks\n" in shown.output
    assert ("FAILS  worlds: 1a2b" in shown.output) == bool(fault)
    result = json.loads(CliRunner().invoke(doctor, ["--json"]).output)
    assert result["holds"] == (not fault)
    assert [row["fault"] for row in result["trials"]] == ["", fault]
    assert result["facts"]["jax"]
    assert "mujoco" in result["extras"]


VERSIONS = dict.fromkeys((*device.PACKAGES, "device", "instruction_set"), "9")


def test_versions_that_were_never_tried_are_named_once(home: Path) -> None:
    assert memo.warning(VERSIONS).endswith("`primordia doctor --device gpu`")
    assert memo.warning(VERSIONS) == ""
    assert memo.warning({**VERSIONS, "device": "cpu"}).endswith("`primordia doctor`")
    assert "primordia doctor" in memo.warning({**VERSIONS, "jax": "10"})


def test_versions_that_were_tried_are_not_named(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(device, "versions", lambda: VERSIONS)
    memo.remember(passed=True)
    assert memo.warning(VERSIONS) == ""
    (home / "primordia" / "doctor.json").write_text("[damaged")
    assert "primordia doctor" in memo.warning(VERSIONS)
