"""Flags are settings. No word is a traceback, and a word that is refused makes nothing."""

import inspect
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import primordia
from primordia.cli.evaluate import evaluate
from primordia.cli.evolve import fork, run
from primordia.config import Config
from primordia.habitats.contract import find
from primordia.organism.playing import evaluation
from primordia.runs import loop
from primordia.settings.fields import setting_fields
from tests.commands import complains, here
from tests.trouble import TASK


@pytest.fixture
def started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Config]]:
    """Let runs be started but not lived, in an empty folder; yield their settings."""
    configs: list[Config] = []

    def start(config: Config, run: Path, **_: Any) -> None:
        configs.append(config)

    monkeypatch.setattr(loop, "start", start)
    monkeypatch.chdir(tmp_path)
    yield configs
    assert not list(tmp_path.iterdir())


HABITATS = {TASK: "cartpole", "Pong-survival": "atari", "Reacher-forager": "mujoco"}
ANY = [
    (task, path)
    for task, name in HABITATS.items()
    for path in sorted({*setting_fields(Config), *setting_fields(find(name), "habitat.")})
]
"""Tasks with simulators of three kinds, and the settings of each."""


def accepted_or_refused(words: list[str], started: list[Config]) -> None:
    """Assert that `run` with these words starts a run or says in one line why not."""
    started.clear()
    done = here("run", *words)
    if done.returncode:
        complains(done, 2)
        assert not started
    else:
        assert done.stderr == ""
        assert done.stdout.startswith("Usage") or len(started) == 1


@pytest.mark.parametrize(
    ("flags", "expected"),
    [
        (["--about=a=b"], {"about": "a=b"}),
        (["--about", "a=b"], {"about": "a=b"}),
        (["--hazard", "-1e-3"], {"hazard": -0.001}),
        (["--about", "-x"], {"about": "-x"}),
        (["--about", "1\ncells = 3"], {"about": "1\ncells = 3"}),
        (["--about", ""], {"about": ""}),
        (["--a-b.c=1", "--a-b.d", "[1, 2]"], {"a-b": {"c": 1, "d": [1, 2]}}),
        (["--seed", "1", "--seed", "0"], {"seed": 0}),
        (["--ticks", "9", "--cells", "3"], {"cells": 3}),
    ],
    ids=str,
)
def test_a_flag_is_a_setting_with_its_value(flags: list[str], expected: dict[str, Any]) -> None:
    """The value is read as TOML; a value that is not TOML is a text."""
    assert run.make_context("run", [TASK, *flags]).obj == expected


def test_a_name_that_is_too_long_is_no_file(started: list[Config]) -> None:
    for name in ("x" * 300, f"{'x' * 300}.toml"):
        complains(here("run", name), 2, name)
    accepted_or_refused(["Reacher-forager", "--habitat.file", "x" * 300], started)


PATHS = sorted({*setting_fields(Config), *setting_fields(find("cartpole"), "habitat.")})
API = [primordia.run, primordia.Run.fork, primordia.Run.resume, evaluation.evaluate]
KEYWORDS = sorted({name for function in API for name in inspect.signature(function).parameters})
OPTIONS = sorted({name for command in (run, fork) for each in command.params for name in each.opts})

digits = st.integers(0, 5000).map(lambda count: "9" * count)
brackets = st.builds(
    lambda pair, depth: pair[0] * depth + pair[1] * depth,
    st.sampled_from(["[]", "{}", "()"]),
    st.integers(0, 5000),
)
VALUES = st.one_of(
    st.sampled_from(
        ["none", "true", "1", "0", "-1", "0.5", "nan", "inf", "-inf", "1e39", "1e400", "1e-60",
         "ring", "torus4", "replacing", "gaussian", "saturation", "[]", "{}", "{a = 1}", "[1, 'x']",
         "2001-01-01", "1\ncells = 3", "1 # x", "'", '"\\u0000"', "\0", "\ud800", "é", "gated",
         "no.such:Part", ":", "..:x", "module:", "{input = {scale = 1e300}}",
         '[{kind = "schedule", setting = "hazard", at = 9, value = 0}]']
    ),
    st.integers().map(str),
    st.integers(0, 2**70).map(hex),
    st.floats().map(str),
    digits,
    brackets,
    st.text(max_size=12),
)  # fmt: skip
mangled = st.builds(
    lambda name, at, new: name[:at] + new + name[at + 1 :],
    st.sampled_from(PATHS + OPTIONS),
    st.integers(0, 20),
    st.sampled_from(["", ".", "_", "-", "x", "é", "\0", "="]),
)
NAMES = st.one_of(
    st.sampled_from(PATHS),
    st.sampled_from([name for name in OPTIONS if name not in ("--out", "--quiet")]),
    st.sampled_from(OPTIONS).map(lambda name: name[2:].replace("-", "_")),
    st.sampled_from(KEYWORDS),
    mangled,
    st.integers(0, 3000).map(lambda count: "a" + ".a" * count),
    st.text(max_size=8),
)
FLAGS = st.one_of(
    st.tuples(NAMES.map(lambda name: f"--{name.removeprefix('--')}"), VALUES),
    st.tuples(st.builds(lambda name, value: f"--{name}={value}", NAMES, VALUES)),
    st.tuples(st.one_of(VALUES, st.sampled_from(["--", "---", "-", "-x", "--=", "-h", "--help"]))),
).filter(lambda words: not any(word.startswith("--out") for word in words))
EXPRESSIONS = st.sampled_from(
    ["ram[17] == 0", "points", "lives * lives", "not " * 500 + "game_over", "1", "['1']", "reached",
     "['qpos[1:]', 'qvel']", "[127, 128]", "[-1]", "norm(qpos) < 1", "full", "NOOP UP", "combat",
     "space_invaders", "nothing", "gymnasium:ant.xml", "gymnasium:../x", "/dev/null", ".", "x" * 300,
     f"['{'x' * 300}']", "{body = 'x'}", "{fatal = 'nan < 1'}", "{scored = {scored = {}}}",
     "{food = '1e39'}"]
)  # fmt: skip
LINES = st.lists(FLAGS, max_size=4).map(lambda parts: [word for part in parts for word in part])


EXAMPLES = pytest.mark.parametrize("examples", [20, pytest.param(5000, marks=pytest.mark.slow)])


@EXAMPLES
def test_any_command_line_is_accepted_or_refused(examples: int, started: list[Config]) -> None:
    @settings(max_examples=examples)
    @given(LINES)
    def check(line: list[str]) -> None:
        accepted_or_refused([TASK, "--quiet", *line], started)

    check()


@EXAMPLES
def test_any_value_of_a_setting_is_accepted_or_refused(
    examples: int, started: list[Config]
) -> None:
    @settings(max_examples=examples)
    @given(st.sampled_from(ANY), VALUES | EXPRESSIONS)
    def check(setting: tuple[str, str], value: str) -> None:
        task, path = setting
        accepted_or_refused([task, "--quiet", f"--{path}={value}"], started)

    check()


@pytest.mark.parametrize(
    ("command", "line"),
    [
        (run, ["run", TASK, "--quiet", "--out", "run"]),
        (fork, ["fork", "none", "--at", "3", "--out", "run"]),
        (evaluate, ["evaluate", "none"]),
    ],
)
def test_no_flag_is_an_argument_of_a_python_function(
    command: click.Command, line: list[str], started: list[Config]
) -> None:
    """Flags are settings; what Python calls `self`, `listen` or `task` is none."""
    options = {option for each in command.params for option in each.opts}
    for name in KEYWORDS:
        if f"--{name}" not in options:
            complains(here(*line, f"--{name}", "3"), 2, name if command is run else "")
    assert not started


@pytest.mark.parametrize("command", [run, fork, evaluate])
def test_a_misspelt_option_is_corrected(command: click.Command) -> None:
    options = [name for each in command.params for name in each.opts if "-" in name[2:]]
    assert options
    for name in options:
        for misspelt in ("--" + name[2:].replace("-", "_"), name[:-1], name + "s"):
            complains(here(command.name, "x", misspelt, "3"), 2, f"Did you mean '{name}'?")


def test_an_argument_given_as_a_flag_is_explained() -> None:
    says = "give the argument without a flag:"
    complains(here("run", "--task", TASK), 2, says, "run TASK|FILE.toml")
    complains(here("fork", "--run", "x"), 2, says, "fork RUN")


def test_words_after_two_hyphens_are_no_flags(started: list[Config]) -> None:
    assert here("run", "--quiet", "--seed", "3", "--", TASK).returncode == 0
    assert started[0].seed == 3
    complains(here("run", "--", TASK, "--cells", "3"), 2, "unexpected extra arguments")
