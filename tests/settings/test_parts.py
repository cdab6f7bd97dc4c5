"""Replaceable parts in settings: a table names the part and holds its settings."""

import tomllib
from pathlib import Path
from typing import Any, cast
from unittest.mock import MagicMock, call

import pytest
import tomli_w

from primordia.config import load, parsed
from primordia.errors import InputError
from primordia.settings.making import make
from primordia.settings.tables import PARTS, merged
from tests.commands import here
from tests.worlds import MEADOW, MILL, config

TASK = "CartPole-survival"


def test_a_brain_has_its_own_settings_with_defaults_filled_in() -> None:
    common = {"efference": False, "interoception": False, "biases": False}
    assert config(MEADOW).brain == {"kind": "recurrent", "hidden": 32, **common}
    assert config(MEADOW, brain={"kind": "linear"}).brain == {"kind": "linear", **common}
    other = config(MEADOW, brain={"kind": "tests.toys:Sliding", "width": 1})
    own = {"kind": "tests.toys:Sliding", "width": 1, "channels": 3}
    assert other.brain == {**own, "efference": False, "interoception": False}
    assert tomllib.loads(other.to_toml())["brain"] == other.brain


@pytest.mark.parametrize("error", [LookupError("no"), TypeError("no"), ValueError("no")])
def test_an_error_of_a_part_is_one_line_with_the_name_of_its_table(error: Exception) -> None:
    """If there is no such part, the line also has the setting that names the part."""

    def fail(*_: Any, **own: Any) -> Any:
        assert own in ({}, {"depth": 0})
        raise error

    table, part = {"name": "pond", "depth": 0}, cast("Any", fail)
    with pytest.raises(InputError, match=r"^habitat: no$"):
        make("habitat", table, lambda _: part)
    if isinstance(error, LookupError):
        with pytest.raises(InputError, match=r"^habitat\.name: no$"):
            make("habitat", table, part)
    assert table == {"name": "pond", "depth": 0}


@pytest.mark.parametrize(
    ("what", "kind"), [("habitat", ""), ("brain", "recurrent"), ("mutation", "gaussian")]
)
def test_a_table_without_a_name_describes_the_default_part(what: str, kind: str) -> None:
    find = MagicMock(return_value=dict)
    assert make(what, {"depth": 0}, find) == {"depth": 0}
    assert make(what, {PARTS[what]: "own", "depth": 0}, find) == {"depth": 0}
    assert find.mock_calls == [call(kind), call("own")]


def test_settings_are_read_without_the_code_of_the_brain() -> None:
    table = {"kind": "no.such:Brain", "width": 7}
    assert parsed({**MEADOW, "brain": table}, source="test").brain == table


def test_a_part_does_not_take_settings_of_the_part_that_it_replaces() -> None:
    made = load(TASK, {"brain": {"kind": "linear"}}).brain
    assert made == {"kind": "linear", "efference": False, "interoception": False, "biases": False}
    base = {"brain": {"kind": "gated", "hidden": 4}, "motor": {"kind": "direct", "sd": 0.5}}
    same = {"kind": "gated", "biases": True}
    assert merged(base, {"brain": same})["brain"] == {**same, "hidden": 4}
    assert merged(base, {"brain": {"kind": "linear"}})["brain"] == {"kind": "linear"}
    assert merged(base, {"motor": {"kind": "gaussian"}})["motor"] == {"kind": "gaussian", "sd": 0.5}
    unnamed = {"mutation": {"scale": 0.5}}  # of the default mutation, the Gaussian
    own = {"mutation": {"kind": "my:Own"}}
    assert merged(unnamed, own) == own
    same = {"kind": "gaussian"}
    assert merged(unnamed, {"mutation": same})["mutation"] == {**same, "scale": 0.5}
    hidden = load("CartPole-survival-hidden", {"habitat": {"name": "tests.toys:Meadow"}})
    assert hidden.habitat == {"name": "tests.toys:Meadow"}


def test_blocks_of_any_name_are_settings() -> None:
    seasons = [
        {"kind": "schedule", "setting": f"mutation.blocks.{block}.scale", "at": 9, "value": 0.5}
        for block in ("slide-2", "OUT_3d", "0")
    ]
    values = {**MILL, "brain": {"kind": "tests.toys:Sliding"}, "seasons": seasons}
    ready = config({**values, "mutation": {"blocks": {"slide-2": {"scale": 0.5}}}})
    law = ready.build_law(ready.build_habitat())
    assert [law.governed(season.setting) for season in law.seasons] == [
        [season.setting] for season in law.seasons
    ]
    assert law.governed("mutation.scale") == [
        f"mutation.blocks.{block}.scale" for block in ("OUT_3d", "0")
    ]


def test_help_shows_the_settings_of_the_brain_that_a_file_names(tmp_path: Path) -> None:
    brain = {"kind": "tests.toys:Sliding", "width": 7}
    (file := tmp_path / "mine.toml").write_text(
        tomli_w.dumps({"task": "own", "habitat": {"name": "cartpole"}, "brain": brain})
    )
    text = " ".join(here("run", file, "--help").stdout.split())
    assert 'or module:Class ["tests.toys:Sliding"]' in text
    assert "--brain.width [7]" in text
    assert "--brain.channels " in text
    assert "--brain.hidden " not in text
