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
from primordia.settings.tables import from_toml, merged, tasks
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
    law = loaded.build_law(loaded.build_habitat())
    assert law.heredity.layout.length == sum(law.heredity.layout.sizes) > 0


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


def test_a_file_that_names_a_task_changes_only_what_it_says(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(f'task = "{TASK}"\nhazard = 0.25\n[mutation]\nscale = 0.5\n')
    changed, built_in = load(str(file)), load(TASK)
    assert (changed.hazard, changed.mutation["scale"]) == (0.25, 0.5)
    mutation = {**built_in.mutation, "scale": 0.5}
    assert changed == built_in.model_copy(update={"hazard": 0.25, "mutation": mutation})


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
    expected = {
        "kind": "recurrent",
        "efference": False,
        "interoception": False,
        "hidden": 4,
        "biases": True,
    }
    assert config.brain == expected, "file, flag"
    assert config.mutation["blocks"]["input_bias"]["scale"] == 0.5, "a flag of a block"
    assert config.mutation["founder_scale"] == tasks()[TASK]["mutation"]["founder_scale"], "task"
    assert config.seasons == (Schedule(kind="schedule", setting="hazard", at=9, value=0.0),)
    helped = " ".join(here("fork", run, "--help").stdout.split())
    for part in (f"values of {run}", "cells of one world [8]", "--habitat.angle_limit"):
        assert part in helped


def test_merging_does_not_change_its_arguments() -> None:
    base, change = {"a": {"b": 1, "c": 2}, "d": 3}, {"a": {"b": 4}, "d": {"e": 5}}
    assert merged(base, change) == {"a": {"b": 4, "c": 2}, "d": {"e": 5}}
    assert base == {"a": {"b": 1, "c": 2}, "d": 3}


def models(model: type[BaseModel]) -> list[type[BaseModel]]:
    """Return a model and the models of its fields."""
    inner = [field.annotation for field in model.model_fields.values()]
    nested = [each for each in inner if isinstance(each, type) and issubclass(each, BaseModel)]
    return [model, *(one for each in nested for one in models(each))]


BRAINS = [brains.find(name) for name in brains.KNOWN]
HABITATS = [find(name) for name in KNOWN if issubclass(find(name), Settings)]


@pytest.mark.parametrize("model", [Config, Gaussian, Block, Schedule, Ratchet, *BRAINS, *HABITATS])
def test_every_setting_is_explained(model: type[Settings]) -> None:
    for path, field in setting_fields(model).items():
        assert field.description, path
    for each in models(model):
        assert each.__doc__, each


@pytest.mark.parametrize("model", [Config, *BRAINS, *HABITATS])
def test_settings_are_frozen_and_strict(model: type[Settings]) -> None:
    for each in models(model):
        assert each.model_config["frozen"]
        assert each.model_config["extra"] == "forbid"
        assert each.model_config["strict"]


def help_text(*words: object) -> str:
    done = here("run", *words, "--help")
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_help_lists_every_setting_with_its_value_and_meaning(tmp_path: Path) -> None:
    text = help_text(TASK)
    hidden = {"task", "about", "habitat", "brain", "mutation", "fork.run", "fork.tick"}
    paths = set(setting_fields(Config)) - hidden | {"brain.kind", "brain.hidden", "brain.biases"}
    paths |= {f"habitat.{name}" for name in find("cartpole").model_fields} | {"habitat.name"}
    for path in paths:
        assert f"--{path} " in text, path
    squeezed = " ".join(text.split())
    assert f"values of {TASK}" in squeezed
    assert "--saturation_ticks a full world without a death" in squeezed
    assert "is saturated [10000]" in squeezed
    assert "--stop.until" in squeezed
    assert '["saturation"]' in squeezed
    assert "--placement.rows number of rows of a torus" in squeezed
    assert "[none]" in squeezed


def test_help_names_the_values_of_every_choice() -> None:
    squeezed = " ".join(help_text(TASK).split()).replace("- ", "-")  # a word may be broken there
    for listed in (
        "(ring, torus4, torus8, well-mixed)",
        "(blind, empty-only, replacing)",
        "(direct, gaussian)",
        "(parent, founder)",
        "(one, fill)",
        "(saturation, none)",
        "(false, true)",
        "(x, x_dot, theta, theta_dot)",
    ):
        assert listed in squeezed
    with_pool = " ".join(help_text("Pong-survival").split())
    assert "senses are constant (a control) (false, true) [false]" in with_pool


def test_help_without_a_task_shows_what_all_tasks_have() -> None:
    """The settings of simulators differ; help on a task shows those of its own."""
    for command, named in (("run", "TASK|FILE.toml|gym:NAME"), ("fork", "RUN")):
        done = here(command, "--help")
        assert (done.returncode, done.stderr) == (0, "")
        habitat = [word for word in done.stdout.split() if word.startswith("--habitat.")]
        assert habitat == ["--habitat.name"]
        assert "--brain.hidden " in done.stdout
        squeezed = " ".join(done.stdout.split())
        assert (
            f"primordia {command} {named} --help` also shows the settings of the habitat"
            in squeezed
        )


def test_help_shows_the_values_of_a_file_or_else_the_defaults(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(f'task = "{TASK}"\nhazard = 0.25\n')
    assert "by accident in a tick [0.25]" in " ".join(help_text(file).split())
    assert "by accident in a tick [0.0]" in " ".join(help_text().split())
    assert "values of" not in help_text("--out", tmp_path)
    file.write_text('task = "own"\n[habitat]\nname = "no.such:Habitat"\n')
    assert "--cells" in help_text(file)
