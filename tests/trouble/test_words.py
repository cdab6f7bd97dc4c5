"""Wrong requests of a user: the exit status is 2, and no run directory is made."""

import json
import os
from pathlib import Path

import jax
import pytest

import primordia
from primordia import config, device
from primordia.errors import InputError
from tests.commands import complains, here, watched
from tests.trouble import TASK

WRONG = {
    ("CartPole-survivl",): ["no task 'CartPole-survivl'", "did you mean 'CartPole-survival'?"],
    (TASK, "--tick", "5"): ["no setting 'tick'", "did you mean 'stop.ticks'?"],
    (TASK, "--out", ""): ["--out", "the path is empty"],
    (TASK, "--mutation.scal=1"): ["'mutation.scal'", "did you mean 'mutation.scale'?"],
    (TASK, "--mutatoin.scale", "1"): ["'mutatoin'", "did you mean 'mutation'?"],
    (TASK, "--habitat.angle_limt", "1"): ["did you mean 'habitat.angle_limit'?"],
    (TASK, "--cells", "many"): ["cells", "integer", "'many'"],
    (TASK, "--seed", str(2**64)): ["seed", f"{2**64} does not fit into 64 bits"],
    (TASK, "--seed", str(2**64 - 1), "--seeds", "2"): ["seeds must be below 2^64"],
    (TASK, "--seed", "[1, 2]"): ["seed", "[1, 2]"],
    (TASK, "--seeds", "60000", "--cells", "60000"): ["cells x seeds", "2^26"],
    (TASK, "--replication", "nan"): ["replication", "finite"],
    (TASK, "--mutation", "5"): ["mutation", "5"],
    (TASK, "--mutation", "5", "--mutation.scale", "1"): ["--mutation already has a single value"],
    (TASK, "--mutation.blocks.inptu.scale", "1"): ["no block 'inptu'"],
    (TASK, "--brain.kind", "clever"): ["brain.kind", "'clever'"],
    (TASK, "--motor.kind", "gaussian"): ["motor.kind", "discrete"],
    (TASK, "--placement.topology", "torus4", "--cells", "7"): ["7 cells", "torus"],
    (TASK, "--seasons", '[{kind = "ratchet"}]'): ["seasons.0.ratchet.setting is missing"],
    (TASK, "--habitat.name", "pond"): ["no habitat named 'pond'", "cartpole", "module:Class"],
    (TASK, "--habitat.name", ":Pond"): ["no habitat named ':Pond'"],
    (TASK, "--habitat.name", "no.such:Pond"): ["'no.such:Pond'", "No module named 'no'"],
    (TASK, "--habitat.name", "tests.toys:Pond"): ["'tests.toys:Pond'", "no attribute 'Pond'"],
    (TASK, "--habitat.name", "json:JSONDecoder"): ["json", "standard library"],
    (TASK, "--habitat.name", "not-a-name:Pond"): ["'not-a-name' is not the name of a module"],
    (TASK, "--habitat.name", "numpy:ndarray"): [
        "ndarray is not a habitat",
        "JaxHabitat",
        "senses_size",
    ],
    (TASK, "--habitat", "pond"): ["habitat", "'pond'"],
    (TASK, "--cells"): ["--cells needs a value"],
    (TASK, "--cells", "--seed", "3"): ["--cells needs a value"],
    (TASK, "--ticks"): ["'--ticks' requires an argument"],
    (TASK, "--until", "bored"): ["stop.until", "'saturation'", "'bored'"],
    (TASK, "64"): ["unexpected extra argument (64)"],
    (TASK, "--device", "gpu"): ["--device", "finds no 'gpu' device"],
    (TASK, "--speed", "nan"): ["--speed", "nan"],
    (TASK, "--checkpoint-every", "nan"): ["--checkpoint-every", "nan"],
    (TASK, "--checkpoint-every", "often"): ["--checkpoint-every", "'often'"],
    (): ["Missing argument 'TASK|FILE.toml|gym:NAME'"],
    ("no/such/file.toml",): ["no/such/file.toml cannot be read", "No such file"],
}


@pytest.mark.parametrize("words", WRONG, ids=" ".join)
def test_a_wrong_word_on_the_command_line_is_an_error(
    words: tuple[str, ...], tmp_path: Path
) -> None:
    if "gpu" in words and any(each.platform == "gpu" for each in jax.devices()):
        pytest.skip("there is a GPU here")
    out = tmp_path / "run"
    complains(here("run", "--out", out, *words), 2, *WRONG[words])
    assert not out.exists()


def test_to_go_on_with_a_run_its_directory_is_needed() -> None:
    complains(
        here("run", TASK, "--resume", "--quiet"), 2, "--resume needs the directory of the run"
    )


FILES = {
    "cells = ": "not valid TOML",
    "[mutation\nscale = 1": "not valid TOML",
    "task = 'x'\ntask = 'y'": "not valid TOML",
    f"task = '{TASK}'\nceils = 4": "there is no setting 'ceils'; did you mean 'cells'?",
    f"task = '{TASK}'\n[mutation]\nscael = 4": "did you mean 'mutation.scale'?",
    f"task = '{TASK}'\ncells = '32'": "cells: input should be a valid integer, not '32'",
    f"task = '{TASK}'\nreplication = 2": "replication: input should be less than or equal to 1",
    "cells = 4": "task is missing (and 1 more)",
    "task = []": "task: input should be a valid string, not []",
    "task = 'own'": "habitat is missing",
    "task = 'CartPole-survivl'": "did you mean 'CartPole-survival'?",
    "task = 'own'\nhabitat = {}": "no habitat named ''",
}


@pytest.mark.parametrize("text", FILES)
def test_a_wrong_word_in_a_file_is_an_error(text: str, tmp_path: Path) -> None:
    file, out = tmp_path / "mine.toml", tmp_path / "run"
    file.write_text(text)
    complains(here("run", file, "--out", out), 2, str(file), FILES[text])
    assert not out.exists()


def test_a_file_may_begin_with_a_mark_of_its_byte_order(tmp_path: Path) -> None:
    (file := tmp_path / "mine.toml").write_text(f"task = '{TASK}'\ncells = 5", encoding="utf-8-sig")
    assert config.load(str(file)).cells == 5


def test_files_that_are_no_text_are_errors(tmp_path: Path) -> None:
    file, folder = tmp_path / "mine.toml", tmp_path / "folder.toml"
    file.write_bytes(b"\xff\x00\xfe")
    folder.mkdir()
    complains(here("run", file), 2, str(file), "not valid TOML")
    complains(here("run", folder), 2, str(folder), "not a regular file")


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (("PIPE",), "PIPE cannot be read: not a regular file"),
        ((TASK, "--ancestor", "PIPE"), "there is no genome file PIPE"),
    ],
)
def test_a_pipe_is_not_opened(words: tuple[str, ...], part: str, tmp_path: Path) -> None:
    """A command would wait until another program writes into it."""
    pipe, out = tmp_path / "mine.toml", tmp_path / "run"
    os.mkfifo(pipe)
    with watched():
        done = here("run", *(word.replace("PIPE", str(pipe)) for word in words), "--out", out)
    complains(done, 2, part.replace("PIPE", str(pipe)))
    assert not out.exists()


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        (["frobnicate"], ["No such command 'frobnicate'"]),
        (["info"], ["Missing argument 'RUN...'"]),
        (["info", ""], ["RUN", "the path is empty"]),
        (["plot", "x", "--out", ""], ["--out", "the path is empty"]),
        (["info", "--yaml", "x"], ["No such option '--yaml'"]),
        (["resume", "--cells", "4", "x"], ["No such option '--cells'"]),
        (["resume", "x", "--ticks"], ["'--ticks' requires an argument"]),
        (["resume", "x", "--ticks", "-5"], ["ticks", "greater than or equal to 1", "-5"]),
        (["resume", "x", "--births", "lots"], ["births", "integer", "'lots'"]),
        (["resume", "x", "--until", "bored"], ["until", "'saturation'", "'bored'"]),
        (["resume", "x", "--checkpoint-every", "-1"], ["--checkpoint-every", "-1"]),
        (["resume", "x", "--device", "nonsense"], ["--device", "'nonsense'"]),
        (["verify", "x", "--device", "nonsense"], ["--device", "'nonsense'"]),
        (["assay", "heredity", "x", "--after", "nan"], ["--after", "nan"]),
        (["assay", "garden", "x", "--after", "nan"], ["--after", "nan"]),
        (["assay", "garden", "x", "--each", str(2**31)], ["--each", str(2**31)]),
        (["assay", "ablate", "x", "3", "3"], ["an organism is given twice"]),
        (["assay", "compete", "x", f"{TASK}:{'9' * 5000}"], ["9" * 20]),
        (["compare", "x"], ["two or more runs"]),
        (["tasks", "more"], ["unexpected extra argument (more)"]),
    ],
)
def test_wrong_words_to_other_commands_are_errors(
    words: list[str], parts: list[str], run: Path
) -> None:
    """In these words, x is a run."""
    complains(here(*(run if word == "x" else word for word in words)), 2, *parts)


def test_a_command_without_words_prints_help() -> None:
    done = here()
    assert done.returncode == 2
    assert "primordia run CartPole-survival" in done.stderr
    assert len(done.stderr.splitlines()) > 10


def test_flags_may_stand_before_the_task(tmp_path: Path) -> None:
    run = tmp_path / "run"
    words = ("--cells", "8", "--hazard=0.002", TASK, "--quiet")
    done = here("run", *words, "--ticks", 10, "--out", run)
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(here("info", run, "--json").stdout)["cells"] == 8


def test_the_python_interface_raises_input_errors(run: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="did you mean 'cells'"):
        primordia.run(TASK, tmp_path / "new", celsl=3)
    with pytest.raises(InputError, match=r"ticks: .* not -1"):
        primordia.Run(run).resume(ticks=-1)
    with pytest.raises(InputError, match="is not a run"):
        primordia.Run(tmp_path / "none").info()
    assert primordia.Run(run).info() == primordia.Run(str(run)).info()
    assert device.versions() == {
        name: value for name, value in primordia.Run(run).info()["versions"].items()
        if name != "format"
    }  # fmt: skip


LONG = "9" * 300
"""A name that no file can have."""


@pytest.mark.parametrize(
    "words",
    [
        ("run", TASK, "--ancestor", LONG), ("run", TASK, "--out", LONG), ("info", LONG),
        ("plot", LONG), ("compare", LONG, "."), ("resume", LONG), ("verify", LONG),
        ("evaluate", LONG), ("shadow", LONG), ("experiment", LONG), ("track", LONG),
        ("assay", "heredity", LONG),
    ],
    ids=lambda words: words[0] if isinstance(words, tuple) else None,
)  # fmt: skip
def test_a_name_too_long_for_a_file_is_refused(
    words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    complains(here(*words), 2, "file name 999", "is too long")
    assert not os.listdir(tmp_path)
