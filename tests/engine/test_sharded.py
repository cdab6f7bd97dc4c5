"""Worlds on several devices: whatever lives, and whatever is written, is the same as on one."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import primordia
from tests import commands
from tests.engine.sharing import LIVED, TICKS

COUNTS = (4, 1, 2)
"""Numbers of devices of the processes, in the order in which they begin a run and go on with it."""
USED = {
    "seasons": {1: 1, 2: 2, 4: 3},
    "births": {1: 1, 2: 2, 4: 3},
    "crowd": {1: 1, 2: 2, 4: 4},
}
"""How many of so many devices a run takes: as many as divide its worlds."""


pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("sharded")


@pytest.fixture(scope="module")
def told(folder: Path) -> dict[int, dict[str, Any]]:
    """Return what processes with different numbers of devices print."""
    variables, command = commands.environment(), [sys.executable, "-m"]
    flags, results = variables.get("XLA_FLAGS", ""), {}
    for count in COUNTS:
        variables["XLA_FLAGS"] = f"{flags} --xla_force_host_platform_device_count={count}"
        done = subprocess.run(
            [*command, "tests.engine.sharing", str(folder)],
            env=variables,
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        results[count] = json.loads(done.stdout)
    return results


@pytest.mark.parametrize("name", LIVED)
def test_worlds_live_the_same_on_any_number_of_devices(told: dict, name: str) -> None:
    lived = {count: each["lived"][name] for count, each in told.items()}
    assert {count: each["devices"] for count, each in lived.items()} == USED[name]
    for what in ("digests", "ends", "births", *(["tables"] if name != "crowd" else [])):
        assert lived[1][what] == lived[2][what] == lived[4][what]
    assert min(lived[1]["births"]) > 5, "something happens in every world"
    assert len(set(lived[1]["ends"])) > 1 or name == "seasons", "worlds stop by themselves"


def test_a_crowd_fills_the_lists_of_each_device_in_another_tick(told: dict) -> None:
    crowd = {count: each["lived"]["crowd"] for count, each in told.items()}
    assert [len(set(crowd[count]["between"])) for count in (1, 2, 4)] == [1, 2, 4]
    assert max(crowd[4]["between"]) < min(crowd[4]["ends"])


def test_a_habitat_on_the_host_takes_one_device(told: dict) -> None:
    assert [each["host"] for each in told.values()] == [1, 1, 1]


def test_the_bytes_needed_are_those_of_all_devices(told: dict) -> None:
    needed = [each["bytes"] for each in told.values()]
    assert all(said == held for said, held in needed)
    assert len({said for said, _ in needed}) == len(needed)


def test_a_stored_state_goes_back_to_where_it_was(told: dict) -> None:
    assert all(each["reloaded"] for each in told.values())


def test_a_run_goes_on_with_any_number_of_devices(told: dict, folder: Path) -> None:
    """Checkpoints of four devices go on with one, then with two; the whole is that of this process."""
    assert [each["differences"] for each in told.values()] == [[], [], []]
    whole = primordia.run(
        str(folder / "run" / "config.toml"), folder / "whole", stop={"ticks": 3 * TICKS}
    )
    parts = primordia.load(folder / "run")
    for name in ("births", "deaths", "metrics"):
        assert parts.table(name).equals(whole.table(name))
        assert len(whole.table(name))
    assert digests(parts) == digests(whole)
    versions = [(each.path / "versions.json").read_text() for each in (parts, whole)]
    assert versions[0] == versions[1]


def test_a_fork_is_the_same_on_any_number_of_devices(told: dict) -> None:
    assert told[1]["fork"] == told[2]["fork"] == told[4]["fork"]


def digests(run: primordia.Run) -> list[str]:
    return [world["digest"] for world in run.info()["worlds"]]
