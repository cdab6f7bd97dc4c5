"""Settings: from TOML, a file and flags to one object, and back."""

import tomllib
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel

from primordia.brains import contract as brains
from primordia.config import Config, load, validated
from primordia.habitats.contract import KNOWN, find
from primordia.law.seasons import Ratchet, Schedule
from primordia.mutations.gaussian import Block, Gaussian
from primordia.settings.base import Settings
from primordia.settings.fields import setting_fields
from primordia.settings.tables import from_toml, tasks
from tests.commands import here
from tests.worlds import MEADOW, MILL

TASK = "CartPole-survival"


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow if name.startswith("Craftax") else ())
        for name in tasks()
    ],
)
def test_built_in_tasks_load_and_build(name: str) -> None:
    """Craftax takes long to trace, and `test_values.py` loads it too."""
    loaded = load(name)
    assert loaded.task == name
    assert loaded.about


def test_tasks_are_listed() -> None:
    done = here("tasks")
    assert (done.returncode, done.stderr) == (0, "")
    for name, values in tasks().items():
        assert f"{name} " in done.stdout
        assert values["about"] in done.stdout


MANY: list[dict[str, Any]] = [
    *(tasks()[name] for name in (TASK, "Pong-survival", "HalfCheetah-forager-ratchet")),
    MEADOW,
    MILL,
    {**MILL, "metabolism": None, "seasons": []},
    {**MEADOW, "seed": 2**64 - 1, "stop": {"ticks": 5, "births": None, "until": None}},
    {**MEADOW, "mutation": {"blocks": {"input": {"scale": 0.5}, "output": {"probability": 0.0}}}},
    {**MEADOW, "placement": {"topology": "torus8", "rows": 8, "rule": "replacing"}},
    {**MEADOW, "about": 'quotes " and \\ and é\nlines'},
]


@pytest.mark.parametrize("values", MANY, ids=range(len(MANY)))
def test_toml_keeps_every_setting(values: dict[str, Any], tmp_path: Path) -> None:
    before = validated(values, source="test")
    file = tmp_path / "config.toml"
    file.write_text(before.to_toml(), encoding="utf-8")
    assert validated(from_toml(file), source=str(file)) == before
    assert load(str(file)) == before, "this holds also where the file names a built-in task"


def test_a_setting_that_is_none_stays_none_over_a_built_in_task(tmp_path: Path) -> None:
    file = tmp_path / "config.toml"
    file.write_text(load(TASK, {"stop": {"until": None}}).to_toml())
    assert load(str(file)).stop.until is None
    assert load(TASK, {"stop": {"until": "none"}}).stop.until is None
    assert load(TASK).stop.until == "saturation"


@given(
    st.builds(
        dict,
        cells=st.integers(2, 2**20),
        replication=st.floats(0, 1),
        hazard=st.floats(0, 1),
        seed=st.integers(0, 2**64 - 1),
        mutation=st.fixed_dictionaries(
            {"scale": st.floats(0, 1e30), "probability": st.floats(0, 1)}
        ),
    )
)
def test_numbers_are_read_back_exactly(settings: dict[str, Any]) -> None:
    before = load(TASK, settings)
    assert validated(tomllib.loads(before.to_toml()), source="test") == before


def test_flags_override_the_file_and_the_file_overrides_the_task(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("primordia.runs.loop.drive", lambda *_: None)  # nothing need be lived
    file, run = tmp_path / "mine.toml", tmp_path / "run"
    values = {
        "task": TASK,
        "cells": 16,
        "mutation": {"scale": 0.5, "probability": 0.25},
        "brain": {"hidden": 4},
        "stop": {"ticks": 3},
    }
    file.write_text(tomli_w.dumps(values))
    flags = (
        "--cells", "8", "--mutation.scale=0.125", "--ticks", "2", "--until", "none",
        "--placement.rule", "empty-only",
        "--brain.biases", "true", "--mutation.blocks.input_bias.scale", "0.5",
        '--seasons=[{kind="schedule",setting="hazard",at=9,value=0}]',
    )  # fmt: skip
    done = here("run", file, *flags, "--out", run, "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    config = load(str(run / "config.toml"))
    assert config.cells == 8, "flag"
    assert (config.mutation["scale"], config.mutation["probability"]) == (0.125, 0.25), "flag, file"
    assert (config.stop.ticks, config.stop.until) == (2, None), "flags"
    assert config.placement.rule == "empty-only"
    assert (config.brain["hidden"], config.brain["biases"]) == (4, True), "file, flag"
    assert config.mutation["blocks"]["input_bias"]["scale"] == 0.5, "a flag of a block"
    assert config.mutation["founder_scale"] == tasks()[TASK]["mutation"]["founder_scale"], "task"
    assert config.seasons == (Schedule(kind="schedule", setting="hazard", at=9, value=0.0),)
    helped = " ".join(here("fork", run, "--help").stdout.split())
    for part in (f"values of {run}", "cells of one world [8]", "--habitat.angle_limit"):
        assert part in helped


def models(model: type[BaseModel]) -> list[type[BaseModel]]:
    """Return a model and the models of its fields."""
    inner = [field.annotation for field in model.model_fields.values()]
    nested = [each for each in inner if isinstance(each, type) and issubclass(each, BaseModel)]
    return [model, *(one for each in nested for one in models(each))]


BRAINS = [brains.find(name) for name in brains.KNOWN]
HABITATS = [find(name) for name in KNOWN if issubclass(find(name), Settings)]


@pytest.mark.parametrize("model", [Config, Gaussian, Block, Schedule, Ratchet, *BRAINS, *HABITATS])
def test_every_setting_is_explained_frozen_and_strict(model: type[Settings]) -> None:
    for path, field in setting_fields(model).items():
        assert field.description, path
    for each in models(model):
        assert each.__doc__, each
        assert each.model_config["strict"]
        assert (each.model_config["frozen"], each.model_config["extra"]) == (True, "forbid")


def test_help_lists_every_setting_with_its_value_and_meaning() -> None:
    text = here("run", TASK, "--help").stdout
    hidden = {"task", "about", "habitat", "brain", "mutation", "fork.run", "fork.tick"}
    paths = set(setting_fields(Config)) - hidden | {"brain.kind", "brain.hidden", "brain.biases"}
    paths |= {f"habitat.{name}" for name in find("cartpole").model_fields} | {"habitat.name"}
    for path in paths:
        assert f"--{path} " in text, path
    squeezed = " ".join(text.split())
    assert "--saturation_ticks a full world without a death" in squeezed
    assert "is saturated [10000]" in squeezed
