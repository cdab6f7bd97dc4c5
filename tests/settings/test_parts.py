"""Replaceable parts in settings: a table names the part and holds its settings."""

import tomllib
from pathlib import Path
from typing import Any, cast

import pytest
import tomli_w

from primordia.brains.contract import find
from primordia.config import load, parsed, validated
from primordia.errors import InputError
from primordia.settings.making import make
from primordia.settings.tables import PARTS, merged
from tests.commands import complains, here
from tests.worlds import MEADOW, MILL, config

TASK = "CartPole-survival"


def test_a_brain_has_its_own_settings_with_defaults_filled_in() -> None:
    common = {"efference": False, "interoception": False, "biases": False}
    assert config(MEADOW).brain == {"kind": "recurrent", "hidden": 32, **common}
    assert config(MEADOW, brain={"kind": "linear"}).brain == {"kind": "linear", **common}
    other = config(MEADOW, brain={"kind": "tests.toys:Sliding", "width": 1})
    assert other.brain == {
        "kind": "tests.toys:Sliding",
        "efference": False,
        "interoception": False,
        "width": 1,
        "channels": 3,
    }
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
    asked: list[object] = []

    def find_part(name: object) -> Any:
        asked.append(name)
        return dict

    assert make(what, {"depth": 0}, find_part) == {"depth": 0}
    assert make(what, {PARTS[what]: "own", "depth": 0}, find_part) == {"depth": 0}
    assert asked == [kind, "own"]


def test_settings_of_an_older_version_are_read() -> None:
    """The older version had a kind and a number of neurons."""
    for kind in ("recurrent", "feed-forward"):
        old = {**MEADOW, "brain": {"kind": kind, "hidden": 5}}
        made = validated(old, source="test").brain
        assert made == {**old["brain"], "efference": False, "interoception": False, "biases": False}


def test_settings_are_read_without_the_code_of_the_brain() -> None:
    table = {"kind": "no.such:Brain", "width": 7}
    assert parsed({**MEADOW, "brain": table}, source="test").brain == table


def test_a_part_does_not_take_settings_of_the_part_that_it_replaces() -> None:
    made = load(TASK, {"brain": {"kind": "linear"}}).brain
    assert made == {"kind": "linear", "efference": False, "interoception": False, "biases": False}
    base = {"brain": {"kind": "gated", "hidden": 4}, "motor": {"kind": "direct", "sd": 0.5}}
    assert merged(base, {"brain": {"kind": "gated", "biases": True}})["brain"] == {
        "kind": "gated",
        "hidden": 4,
        "biases": True,
    }
    assert merged(base, {"brain": {"kind": "linear"}})["brain"] == {"kind": "linear"}
    assert merged(base, {"motor": {"kind": "gaussian"}})["motor"] == {"kind": "gaussian", "sd": 0.5}
    mutation = {"scale": 0.5}  # of the Gaussian, which a table describes that names no kind
    assert merged({"mutation": mutation}, {"mutation": {"kind": "my:Own"}})["mutation"] == {
        "kind": "my:Own"
    }
    assert merged({"mutation": mutation}, {"mutation": {"kind": "gaussian"}})["mutation"] == {
        "kind": "gaussian",
        "scale": 0.5,
    }
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


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--brain.kind", "clever"], "brain.kind: no brain named 'clever'; known: recurrent,"),
        (["--brain.kind", "gated", "--brain.hiden", "3"], "did you mean 'brain.hidden'?"),
        (["--brain.kind", "linear", "--brain.hidden", "3"], "no setting 'brain.hidden'"),
        (
            ["--brain.hidden", "0"],
            "brain.hidden: input should be greater than or equal to 1, not 0",
        ),
        (["--brain", "pond"], "brain: input should be a valid dictionary, not 'pond'"),
        (["--mutation.blocks.input_bias.scale", "1"], "this brain has no block 'input_bias'"),
    ],
)
def test_wrong_settings_of_a_part_are_errors_that_say_why(words: list[str], says: str) -> None:
    complains(here("run", TASK, *words), 2, f"{TASK}: ", says)


def helped(*words: object) -> str:
    done = here("run", *words, "--help")
    assert (done.returncode, done.stderr) == (0, "")
    return " ".join(done.stdout.split())


def test_help_shows_the_settings_of_the_brain_that_a_task_names(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    cases: list[tuple[dict[str, Any], set[str], set[str]]] = [
        ({"kind": "linear"}, {"biases"}, {"hidden"}),
        ({"kind": "tests.toys:Sliding", "width": 7}, {"width", "channels"}, {"hidden", "biases"}),
        ({}, {"hidden", "biases"}, {"width"}),
        ({"kind": "no.such:Brain"}, set(), {"hidden", "biases"}),
    ]
    for table, shown, others in cases:
        text = helped(_written(file, table))
        assert all(f"--brain.{name} " in text for name in {"kind", *shown}), table
        assert not any(f"--brain.{name} " in text for name in others), table
        assert f'or module:Class ["{table.get("kind", "recurrent")}"]' in text
        assert ("--brain.width [7]" in text) == ("width" in table)


def _written(file: Path, brain: dict[str, Any]) -> Path:
    file.write_text(tomli_w.dumps({"task": "own", "habitat": {"name": "cartpole"}, "brain": brain}))
    return file


def test_help_without_a_task_shows_the_settings_of_the_default_brain() -> None:
    text = helped()
    for name in find("recurrent").model_fields:
        assert f"--brain.{name} " in text
    assert ', or module:Class ["recurrent"]' in text


def test_a_part_that_is_no_table_leaves_help_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('task = "own"\nhabitat = "pond"\nbrain = 5\n')
    assert "--brain.hidden " in helped(file)
    with pytest.raises(InputError, match="habitat: input should be a valid dictionary"):
        load(str(file))
