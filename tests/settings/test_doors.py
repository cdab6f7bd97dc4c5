"""Doors (`gym:`, `gymnax:`) before names of environments, and the text of a task file."""

import tomllib
from unittest.mock import call, patch

import pytest

from primordia.settings import doors, parts


@pytest.mark.parametrize(
    ("name", "full", "behind"),
    [
        ("gym:CartPole-v1", "gym:CartPole-v1", True),
        ("gymnax:Catch-bsuite", "gymnax:Catch-bsuite", True),
        ("CartPole-v1", "gym:CartPole-v1", False),
        ("my.ponds:Pond-v0", "gym:my.ponds:Pond-v0", False),
        ("gymnastics:Pole-v0", "gym:gymnastics:Pole-v0", False),
        ("gym", "gym:gym", False),
        ("gym:", "gym:", True),
    ],
)
def test_a_name_without_a_door_gets_that_of_gymnasium(name: str, full: str, behind: bool) -> None:
    assert doors.is_door(name) == behind
    assert doors.full(name) == full


@pytest.mark.parametrize(
    ("env", "asked"),
    [
        ("gymnax:Catch", ("primordia.habitats.gymnax.task:task", "Catch")),
        ("my.ponds:Pond-v0", ("primordia.habitats.gymnasium.task:task", "my.ponds:Pond-v0")),
    ],
)
def test_a_task_file_has_the_facts_then_the_faults_then_the_settings(
    env: str, asked: tuple[str, str]
) -> None:
    table = {"task": "pond", "habitat": {"name": "gymnasium", "fatal": "obs[0] > 7"}}
    facts = ["Seven senses.", " ".join(["word"] * 60)]
    task = doors.Task(table, facts, ["it sinks", "it leaks"])
    with patch.object(parts, "load") as load:
        load.return_value.return_value = task
        text = doors.text(env)
    path, name = asked
    assert load.mock_calls == [call("door", path, {}), call()(name)]
    assert tomllib.loads(text) == table
    comments, _, _ = text.partition("\n\n")
    lines = comments.splitlines()
    assert max(map(len, lines)) <= doors.WIDTH
    unwrapped = comments.replace("\n#   ", " ").splitlines()
    assert unwrapped[:5] == [
        f"# A task in {env}: `primordia run FILE` runs it. Change any setting.",
        "# Seven senses.",
        f"# {facts[1]}",
        "# Found: it sinks.",
        "# Found: it leaks.",
    ]
    assert "such as: obs[0] > 7 or obs[0] < -1." in unwrapped[5]
    assert len(lines) > len(unwrapped) == 7
