"""Environments of other libraries by name: `run gym:NAME`, `new` and `check`."""

import json
import shutil
import sys
import tomllib
from pathlib import Path
from unittest.mock import patch

import pytest

pytest.importorskip("gymnasium")

import gymnasium

from primordia import testing
from primordia.settings import doors
from tests.commands import begin, complains, flags, here
from tests.strangers import forget
from tests.worlds import HOSTED

MORE = ["--ticks", "24", "--quiet"]
SHORT = ["--quiet", *flags(HOSTED), "--habitat.workers", "0"]
POND = "gym:tests.ponds:Pond-v0"
SWAMP = """
import gymnasium
from swamp_depth import DEPTH
from tests.ponds import Pond


class Swamp(Pond):
    def __init__(self, **options):
        super().__init__(edge=DEPTH, **options)


gymnasium.register("Swamp-v0", entry_point=Swamp)
"""


def test_an_environment_is_lived_in_by_its_name_alone(tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert here("run", POND, "--out", run, *SHORT, "--ticks", "12").returncode == 0
    settings = tomllib.loads((run / "config.toml").read_text())
    assert settings["task"] == "Pond-v0"
    assert settings["habitat"]["saving"] == "snapshot"
    assert here("resume", run, *MORE).returncode == 0
    assert here("verify", run).returncode == 0
    assert here("replay", run, "--to", "5", "--out", tmp_path / "life.gif").returncode == 0
    assert (tmp_path / "life.gif").stat().st_size > 1000


def digest_of(run: Path) -> str:
    return json.loads(here("info", run, "--json").stdout)["digest"]


def test_a_new_task_file_says_what_can_be_changed_and_is_lived_by(tmp_path: Path) -> None:
    file = tmp_path / "new" / "pond.toml"
    assert here("new", file, "--env", POND).returncode == 0
    text = file.read_text()
    for part in ("obs[0] to obs[1]", 'info["age"]', "time_limit = 50", "from their saved states"):
        assert part in text
    assert here("run", file, "--out", tmp_path / "run", *SHORT, "--ticks", "20").returncode == 0
    complains(here("new", file, "--env", POND), 2, f"{file} exists")
    assert file.read_text() == text
    unknown = tmp_path / "other" / "unknown.toml"
    complains(here("new", unknown, "--env", "gym:CartPoll-v1"), 2, "Did you mean: `CartPole`")
    assert not unknown.parent.exists()


def test_check_says_what_is_wrong_by_its_status() -> None:
    sound, worn = here("check", POND), here("check", "tests.ponds:Worn-v0")
    assert (sound.returncode, worn.returncode) == (0, 1)
    assert "lives go on exactly from their saved states" in sound.stdout
    assert "Found: a life depends on earlier lives" in worn.stdout
    complains(here("check", "gym:tests.ponds:Talking-v0"), 2, "space['says'] is a Text")


@pytest.mark.slow
def test_an_environment_of_the_users_own_is_part_of_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its code is copied, asks for trust elsewhere, and is what workers execute, wherever they start."""
    mine, other = tmp_path / "mine", tmp_path / "other"
    mine.mkdir()
    other.mkdir()
    (mine / "swamp.py").write_text(SWAMP)
    (mine / "swamp_depth.py").write_text("DEPTH = 2.0\n")
    monkeypatch.chdir(mine)
    words = ["--quiet", "--cells", "6", "--ticks", "60", "--habitat.workers", "1"]
    process = begin("run", "gym:swamp:Swamp-v0", "--out", "run", *words)
    _, errors = process.communicate(timeout=120)
    assert (process.returncode, errors) == (0, "")
    held = {path.name for path in (mine / "run" / "code").rglob("*.py")}
    assert {"swamp.py", "swamp_depth.py"} <= held
    shutil.copytree(mine / "run", other / "run")
    monkeypatch.setenv("XDG_STATE_HOME", str(other))
    monkeypatch.chdir(other)
    resume = ["resume", "run", "--ticks", "90", "--quiet"]
    complains(here(*resume), 2, "executes code", "--trust")
    assert "swamp" not in sys.modules
    done = here(*resume, "--trust")
    assert (done.returncode, done.stderr) == (0, "")
    forget("swamp", "swamp_depth")
    gymnasium.registry.pop("Swamp-v0")
    (mine / "swamp_depth.py").write_text("DEPTH = 1.0\n")
    monkeypatch.chdir(mine)
    complains(here(*resume), 2, "swamp_depth.py has changed")


@pytest.mark.slow
def test_an_environment_in_jax_is_lived_in_by_its_name_alone(tmp_path: Path) -> None:
    run, whole = tmp_path / "run", tmp_path / "whole"
    walk = "run", "gymnax:tests.walks:Choice", "--quiet", "--cells", 6
    assert here(*walk, "--out", run, "--ticks", 40).returncode == 0
    assert here("resume", run, "--ticks", 90, "--quiet").returncode == 0
    assert here(*walk, "--out", whole, "--ticks", 90).returncode == 0
    assert digest_of(run) == digest_of(whole)
    assert here("replay", run, "--out", tmp_path / "life.gif").returncode == 0
    assert (tmp_path / "life.gif").stat().st_size > 1000


@pytest.mark.parametrize("faults", [[], ["it forgets"]])
def test_check_names_faults_of_the_environment_and_breaches_of_the_contract(
    faults: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A habitat in JAX must also keep the contract of habitats."""
    table = {"task": "Choice", "habitat": {"name": "gymnax", "env": "tests.walks:Choice"}}
    monkeypatch.setattr(doors, "task", lambda env: doors.Task(table, ["a fact"], faults))
    with patch.object(testing, "check_habitat", side_effect=testing.ContractError("it is broken")):
        done = here("check", "gymnax:tests.walks:Choice")
    assert done.returncode == 1
    found = [f"Found: {fault}." for fault in (*faults, "it is broken")]
    assert done.stdout.splitlines() == ["a fact", *found]
