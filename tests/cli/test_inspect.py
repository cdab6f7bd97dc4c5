"""Commands on runs: each option reaches the Python interface, and each result is printed."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import ANY

import numpy as np
import pytest
from safetensors import safe_open
from safetensors.numpy import save_file

from primordia import api
from primordia.comparison import tables
from primordia.figures import comparison as pictures
from tests.commands import complains, here
from tests.worlds import MEADOW, config

PICTURES = [Path("out/compare.png"), Path("out/compare.svg")]


class Loaded:
    """A run that notes each call."""

    def __init__(self, asked: list[Any], differences: list[str]) -> None:
        self.asked, self.differences = asked, differences

    def __getattr__(self, name: str) -> Any:
        answers = {
            "plot": [Path("a.png"), Path("a.svg")],
            "oldest": self,
            "organism": self,
            "replay": Path("life.mp4"),
            "export": (7, 9),
            "verify": self.differences,
            "info": {"births": 3},
        }

        def answer(*values: object, **named: object) -> Any:
            self.asked.append((name, *values, *named.items()))
            return answers[name]

        return answer


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Return the calls of commands, in their order. `verify` finds differences in the run `wrong`."""
    noted: list[Any] = []

    def load(run: Any, trust: bool = False) -> Loaded:
        noted.append(("load", run, trust))
        return Loaded(noted, ["tick 3 of world 1", "tick 9"] if run == Path("wrong") else [])

    def compare(*runs: str, **horizons: int | None) -> Any:
        noted.append(("compare", runs, horizons))
        return SimpleNamespace(to_dict=lambda: {"runs": 2})

    def save(_: Any, out: Path) -> list[Path]:
        noted.append(("save", out))
        return PICTURES

    monkeypatch.setattr(api, "load", load)
    monkeypatch.setattr(api, "compare", compare)
    monkeypatch.setattr(tables, "comparison_tables", lambda _: "the tables")
    monkeypatch.setattr(pictures, "save", save)
    return noted


WHOLE = (None, None)
LINES: dict[str, list[tuple[Any, ...]]] = {
    "info run --json": [("load", (Path("run"),), False), ("info",)],
    "info one two --json": [("load", (Path("one"), Path("two")), False), ("info",)],
    "plot run": [("load", (Path("run"),), False), ("plot", None, 0, ())],
    "plot one two --out new --world 2 --figure ages --figure my:own": [
        ("load", (Path("one"), Path("two")), False),
        ("plot", Path("new"), 2, ("ages", "my:own")),
    ],
    "replay run": [("load", Path("run"), False), ("oldest", None), ("replay", None, WHOLE, [])],
    "replay run --world 0": [
        ("load", Path("run"), False), ("oldest", 0), ("replay", None, WHOLE, []),
    ],
    "replay run --world 3 --trust": [
        ("load", Path("run"), True), ("oldest", 3), ("replay", None, WHOLE, []),
    ],
    "replay run --organism 0": [
        ("load", Path("run"), False), ("organism", 0, 0), ("replay", None, WHOLE, []),
    ],
    "replay run --organism 5 --world 3 --beside 2 --beside 1 --from 4 --to 9 --out x.gif": [
        ("load", Path("run"), False), ("organism", 5, 3), ("replay", Path("x.gif"), (4, 9), [2, 1]),
    ],
    "replay run --beside 0 --beside other --trust": [
        ("load", Path("run"), True), ("oldest", None), ("load", Path("other"), True), ("oldest", None),
        ("replay", None, WHOLE, [0, ANY]),
    ],
    "export run file": [("load", Path("run"), False), ("export", Path("file"), ("world", 0))],
    "export run file --world 2 --organism 9 --organism 7 --trust": [
        ("load", Path("run"), True), ("export", Path("file"), 9, 7, ("world", 2)),
    ],
    "verify run": [("load", Path("run"), False), ("verify",)],
    "verify run --device cpu --trust": [("load", Path("run"), True), ("verify",)],
    "compare a=one two": [
        ("compare", ("a=one", "two"), {"births": None, "ticks": None, "island": None}), ("save", Path()),
    ],
    "compare one two three --births 1 --ticks 8 --out new": [
        ("compare", ("one", "two", "three"), {"births": 1, "ticks": 8, "island": None}),
        ("save", Path("new")),
    ],
    "compare one two --island i": [
        ("compare", ("one", "two"), {"births": None, "ticks": None, "island": "i"}),
        ("save", Path()),
    ],
}  # fmt: skip
"""Command lines, and what each asks of the Python interface."""


@pytest.mark.parametrize("line", LINES)
def test_every_option_reaches_the_python_interface(
    line: str, asked: list[Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = here(*line.split())
    assert (done.returncode, done.stderr) == (0, "")
    assert asked == LINES[line]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("info run --json", '{"births": 3}'),
        ("plot run", "a.png\na.svg"),
        ("replay run", "life.mp4"),
        ("export run file", "file: organism 7, 9"),
        ("verify run", "run is verified: every world was repeated from its beginning with the same"
                       " result."),
        ("compare one two", "the tables\nFigure: out/compare.png and out/compare.svg"),
    ],
)  # fmt: skip
def test_a_command_prints_the_result(
    line: str, says: str, asked: list[Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert here(*line.split()).stdout == says + "\n"


def test_a_comparison_as_json_is_one_object_and_still_draws(
    asked: list[Any], tmp_path: Path
) -> None:
    done = here("compare", "one", "two", "--json", "--out", tmp_path / "new")
    assert json.loads(done.stdout) == {"runs": 2}
    assert asked[-1] == ("save", tmp_path / "new")
    assert (tmp_path / "new").is_dir()


@pytest.mark.usefixtures("asked")
def test_the_first_difference_of_a_run_is_named() -> None:
    done = here("verify", "wrong")
    complains(done, 1, "wrong differs from its records when repeated: tick 3 of world 1\n")
    assert done.stdout == ""


@pytest.mark.usefixtures("asked")
@pytest.mark.parametrize("unit", ["births", "ticks"])
def test_a_horizon_is_at_least_one(unit: str) -> None:
    complains(here("compare", "one", "two", f"--{unit}", 0), 2, f"--{unit}", "0")


def test_imported_weights_name_their_task_and_the_run_that_takes_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file of settings names the task, and `run` takes this file."""
    monkeypatch.chdir(tmp_path)
    chosen = config(MEADOW, brain={"kind": "feed-forward", "hidden": 2})
    Path("mine.toml").write_text(chosen.to_toml(), encoding="utf-8")
    layout = chosen.build_layout(chosen.build_habitat())
    save_file({name: np.ones(shape, np.float32) for name, shape in layout.blocks}, "state")
    done = here("import", "state", "genome", "--task", "mine.toml")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "genome: primordia run mine.toml --ancestor genome\n"
    with safe_open("genome", "numpy") as genome:
        assert genome.metadata() == {"task": "meadow"}
