"""The user's own code: it is part of a run, and a changed file stops the run."""

import importlib
import importlib.util
import os
import py_compile
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia import own_code
from primordia.errors import InputError
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.archive import Archive
from tests.commands import COMMAND, complains, environment, here, hostile, watched
from tests.strangers import PARTS, POND, begun, forget
from tests.worlds import HOSTED, config

SIMULATED: dict[str, Any] = {
    "task": "pond",
    **HOSTED,
    "habitat": {"name": "gymnasium", "env": "tests.ponds:Pond-v0", "workers": 0},
}


@pytest.mark.slow
def test_a_run_holds_the_code_that_it_executes(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = begun(folder)
    for name in PARTS:
        assert (run / "code" / name).read_bytes() == (folder / name).read_bytes()
    assert sorted(path.name for path in (run / "code").rglob("*")) == sorted(PARTS)
    assert tuple(Archive(run).description.code) == PARTS
    monkeypatch.setattr("primordia.runs.loop.drive", lambda *_: None)  # nothing need be lived
    assert not (primordia.run("CartPole-survival", folder / "ours").path / "code").exists()


def test_a_run_does_not_go_on_with_changed_code(folder: Path) -> None:
    run, more = begun(folder), ("resume", folder / "run", "--ticks", 70, "--quiet")
    texts = {folder / name: (folder / name).read_text() for name in PARTS}
    for file, text in texts.items():
        file.write_text(text.replace("> 20", "> 5").replace("3.0", "4.0"))
        complains(here(*more), 2, f"{file} has changed", "--inexact")
        complains(here(*more, "--inexact"), 2, f"{file}", "--trust")
    forget()
    assert here("verify", run).returncode == 0, "a run executes its own copy"
    forget()
    for file, text in texts.items():
        file.write_text(text + "# changed, but only in words\n")
    done = here(*more, "--inexact", "--trust")
    assert (done.returncode, done.stderr) == (0, "")
    assert not primordia.load(run).info()["exact"]


@pytest.mark.parametrize(
    ("place", "refused"),
    [
        ("DEPTH, HERE = 3.0, __file__", True),
        ("DEPTH = 3.0  # not __file__", False),
        ("DEPTH = 3.0\nif __name__ == '__main__':\n    print(__file__)", False),
    ],
)
def test_code_that_looks_for_files_beside_it_is_refused(
    folder: Path, place: str, refused: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its copy has none, so that a run could not be resumed."""
    (folder / "pond_depth.py").write_text(f"{place}\n")
    if refused:
        complains(here("run", folder / "task.toml", "--out", "run"), 2, "pond_depth.py", "__file__")
        assert not (folder / "run").exists()
    else:
        monkeypatch.setattr("primordia.runs.loop.drive", lambda *_: None)
        assert primordia.run(str(folder / "task.toml"), folder / "run").path.exists()


def test_a_run_that_was_begun_with_such_code_can_be_forked(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "pond_depth.py").write_text("DEPTH, HERE = 3.0, __file__\n")
    with monkeypatch.context() as before:
        before.setattr(own_code.Source, "knows_its_place", False)
        run = begun(folder)
    monkeypatch.chdir(folder.parent)
    forget()
    done = here("fork", run, "--at", 30, "--out", folder.parent / "fork", "--quiet", "--trust")
    assert (done.returncode, done.stderr) == (0, "")


LOCALE = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}


def test_a_command_lives_in_any_folder_and_locale_and_with_closed_streams(tmp_path: Path) -> None:
    """No file of the folder is imported; `test_tree.py` has a process of simulators in such a folder.

    Standard input and the stream of messages are closed, and no file takes their place.
    """
    hostile(tmp_path)
    text = config(SIMULATED, about="é").to_toml().replace('"pond"', '"水\\u001b"')
    (tmp_path / "pond.toml").write_text(text, encoding="utf-8")
    words = [*COMMAND, "run", "pond.toml", "--ticks", "1", "--out", "run"]
    done = subprocess.run(
        ["sh", "-c", '"$@" <&- 2>&-', "sh", *words],
        cwd=tmp_path,
        env={**environment(), **LOCALE, "PRIMORDIA_CORES": "2"},
        capture_output=True,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.decode().startswith("水\\x1b: 1 world")
    assert "primordia plot run\n" in done.stdout.decode()
    assert here("info", tmp_path / "run").returncode == 0


@pytest.mark.slow
def test_a_cache_of_compiled_code_is_not_executed(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Python would take a file of bytes without looking at the source that was trusted."""
    run, forged = begun(folder), folder / "forged.py"
    forged.write_text("raise SystemExit('the cache was executed')\n")
    cache = Path(importlib.util.cache_from_source(str(folder / "pond.py")))
    mode = py_compile.PycInvalidationMode.UNCHECKED_HASH
    py_compile.compile(str(forged), str(cache), invalidation_mode=mode)
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    again = here("run", folder / "task.toml", "--quiet", "--out", folder / "again")
    assert (again.returncode, again.stderr) == (0, "")
    forget()
    assert here("verify", run).returncode == 0
    assert sorted(path.name for path in (run / "code").rglob("*")) == sorted(PARTS)
    shutil.copytree(cache.parent, run / "code" / "__pycache__")
    forget()
    complains(here("verify", run), 1, "was added after the run began")


def test_edited_code_changes_no_life_on_record(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = begun(folder)
    before = primordia.load(run).oldest()
    lifespan = before.age
    forget()
    (folder / "pond.py").write_text(POND.replace("> 20", "> 5"))
    with monkeypatch.context() as patch:
        patch.setattr("primordia.runs.loop.drive", lambda *_: None)  # nothing need be lived
        primordia.run(str(folder / "task.toml"), folder / "edited")
    with pytest.raises(InputError, match="is another module with that name; use another process"):
        primordia.load(run).policy()
    forget()
    life = RelivedLife.of(Archive(run), before.id, before.world)
    assert sum(len(each.tick) for each in life.stretches()) == lifespan


@pytest.mark.parametrize("end", ["SystemExit(3)", "SystemExit('enough')", "RuntimeError('no')"])
def test_a_module_that_ends_the_process_is_an_error(folder: Path, end: str) -> None:
    (folder / "pond.py").write_text(f"raise {end}\n")
    done = here("run", "task.toml", "--out", "run")
    complains(done, 2, "habitat.name: habitat 'pond:Pond' cannot be loaded: ")
    assert not (folder / "run").exists()


def test_a_module_that_was_imported_before_goes_to_another_process_too(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(folder)
    importlib.import_module("pond")
    assert "pond" not in own_code._admitted.sources
    assert set(own_code.admitted(["pond"])) == {"pond.py", "pond_depth.py"}


@pytest.mark.parametrize(
    ("command", "says"), [("verify", "is missing; put"), ("resume", "is not a regular file; put")]
)
def test_a_pipe_in_place_of_code_is_not_read(folder: Path, command: str, says: str) -> None:
    run = begun(folder)
    part = run / "code" / "pond_depth.py"
    part.unlink()
    os.mkfifo(part)
    with watched():
        done = here(command, run)
    complains(done, 1, f"pond_depth.py {says}")


@pytest.mark.parametrize("kind", ["deep", "link"])
def test_a_folder_of_code_is_not_searched_without_end(folder: Path, kind: str) -> None:
    run = begun(folder)
    if kind == "deep":
        deep = run / "code" / "/".join("d" * 500)
        for each in [*reversed(deep.parents), deep]:
            each.mkdir(exist_ok=True)
    else:
        (run / "code").rename(folder / "elsewhere")
        (run / "code").symlink_to(folder / "elsewhere")
    says = {"deep": "code/d is missing, or was added", "link": "code is a symbolic link"}[kind]
    complains(here("verify", run), 1, says)
