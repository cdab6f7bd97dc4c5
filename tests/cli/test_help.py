"""Settings under --help: each has the value that it would have, and its possible values."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import call, patch

import pytest

from primordia.cli import help as helping
from primordia.cli.help import habitat_rows, run_rows, setting_rows
from primordia.habitats.cartpole.habitat import CartPole
from tests.commands import here
from tests.trouble import TASK
from tests.worlds import MEADOW, config


def values(rows: list[tuple[str, str]]) -> dict[str, str]:
    """Return the value of each setting, which is in brackets at the end of its text."""
    return {name: text[text.rindex(" [") + 2 : -1] for name, text in rows}


def test_a_value_is_the_given_one_else_the_tasks_else_the_default() -> None:
    given = {"replication": 0, "mutation": {"scale": 0.5}, "brain": {"biases": False}}
    found = values(setting_rows(TASK, given))
    assert found["--habitat.name"] == '"cartpole"'
    assert found["--habitat.angle_limit"] == "12.0"
    assert (found["--replication"], found["--mutation.scale"]) == ("0", "0.5")
    assert found["--mutation.probability"] == "1.0"
    assert (found["--brain.biases"], found["--hazard"]) == ("false", "0.0")
    assert (found["--ancestors"], found["--mutation.blocks"]) == ("[]", "{}")
    assert (found["--stop.ticks"], found["--stop.until"]) == ("none", '"saturation"')
    unlimited = values(setting_rows(TASK, {"stop": {"until": "none"}, "habitat": {"spread": 0}}))
    assert (unlimited["--stop.until"], unlimited["--habitat.spread"]) == ('"none"', "0")


def test_the_settings_are_those_of_the_chosen_parts() -> None:
    brains = {
        kind: {name for name in dict(setting_rows(None, {"brain": given})) if "brain" in name}
        for kind, given in {
            "default": {},
            "linear": {"kind": "linear"},
            "hidden": {"kind": "feed-forward"},
            "wrong": {"kind": "no such brain"},
        }.items()
    }
    assert "--brain.hidden" in brains["hidden"]
    assert "--brain.hidden" not in brains["linear"]
    assert brains["wrong"] == {"--brain.kind"} < brains["default"]
    assert "--brain.kind" in dict(setting_rows(None, {"brain": 3}))
    assert [name for name, _ in setting_rows(None, {}) if "habitat" in name] == ["--habitat.name"]


def test_settings_that_a_user_cannot_choose_are_left_out() -> None:
    names = dict(setting_rows(TASK, {}))
    assert not {"--about", "--task", "--fork.run", "--fork.tick"} & {*names}
    assert names["--stop.until"].endswith(' (saturation, none) ["saturation"]')
    assert names["--brain.biases"].partition(" (")[2].startswith("false, true) ")


def test_the_settings_of_a_run_are_its_own(tmp_path: Path) -> None:
    (tmp_path / "config.toml").write_text(config(MEADOW, cells=13).to_toml())
    archive = SimpleNamespace(
        admit=lambda: None,
        habitat=CartPole(),
        config=SimpleNamespace(habitat={"angle_limit": 77.0, "spread": 0}),
    )
    with patch.object(helping, "Archive", return_value=archive) as opened:
        assert values(run_rows(tmp_path, {}))["--cells"] == "13"
        assert values(run_rows(tmp_path, {"cells": 7}))["--cells"] == "7"
        found = values(habitat_rows(tmp_path))
    assert opened.call_args == call(tmp_path)
    assert (found["--angle_limit"], found["--spread"]) == ("77.0", "0")
    assert (found["--track_limit"], "--cells" in found) == ("2.4", False)


@pytest.mark.parametrize(
    ("words", "place", "title"),
    [
        (("run",), None, "run TASK|FILE.toml|gym:NAME --help` also"),
        (("run", TASK), TASK, f"values of {TASK})"),
        (("run", "a.toml"), "a.toml", "values of a.toml)"),
        (("run", "gym:X-v0"), "gym:X-v0", "values of gym:X-v0)"),
        (("fork", "RUN", "--at", 3), Path("RUN"), "values of RUN)"),
        (("fork", "other", "--at", 3), None, "fork RUN --help` also"),
    ],
    ids=str,
)
def test_help_is_about_the_task_the_file_or_the_run_that_is_named(
    words: tuple[Any, ...],
    place: str | Path | None,
    title: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The values that are shown depend on the flags in front of --help."""
    monkeypatch.chdir(tmp_path)
    Path("RUN").mkdir()
    Path("RUN", "config.toml").touch()
    rows = [("--cells", "number of cells [7]")]
    with (
        patch.object(helping, "setting_rows", return_value=rows) as of_task,
        patch.object(helping, "run_rows", return_value=rows) as of_run,
    ):
        done = here(*words, "--cells", 7, "--help")
    asked, other = (of_run, of_task) if isinstance(place, Path) else (of_task, of_run)
    asked.assert_called_once_with(place, {"cells": 7})
    other.assert_not_called()
    section = " ".join(done.stdout.split()).partition("Settings, as in TOML (")[2]
    assert title in section
    assert section.startswith("defaults; ") == (place is None)
    assert "number of cells [7]" in done.stdout
