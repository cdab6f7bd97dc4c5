"""The user's own code: it is part of a run, is executed only when trusted, and never by looking."""

import importlib
import importlib.util
import json
import py_compile
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
import tomli_w

import primordia
from primordia import files, own_code
from primordia.errors import InputError
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import code
from primordia.runs.archive import Archive
from tests.commands import COMMAND, complains, environment, here
from tests.trouble import newest, reseal

POND = """
from typing import Any

import jax.numpy as jnp

from pond_depth import DEPTH
from primordia.habitats import Discrete, JaxHabitat, Outcome
from primordia.settings.base import Settings


class Pond(JaxHabitat, Settings):
    depth: float = DEPTH
    senses_size: int = 1
    action: Any = Discrete(2)
    words: int = 1
    rate: float = 10.0

    def reset(self, words):
        return jnp.zeros((len(words), 1), jnp.float32)

    def sense(self, bodies):
        return bodies

    def step(self, bodies, action):
        bodies = bodies + 1
        return bodies, Outcome(fatal=bodies[:, 0] > 20, food=None, effort=None)
"""
TASK = """
task = "pond"
cells = 8
habitat = { name = "pond:Pond" }
replication = 0.3
[stop]
ticks = 60
until = "none"
"""
PARTS = ("pond.py", "pond_depth.py")
LIVING = [
    ["resume", "{run}", "--ticks", "70", "--quiet"],
    ["verify", "{run}"],
    ["fork", "{run}", "--at", "30", "--out", "{new}", "--quiet"],
    ["evaluate", "{run}", "--ticks", "30", "--games", "2"],
]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with a task and the code of its habitat; another user has no trust in it."""
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "pond.py").write_text(POND)
    (tmp_path / "mine" / "pond_depth.py").write_text("DEPTH = 3.0\n")
    (tmp_path / "mine" / "task.toml").write_text(TASK)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.chdir(tmp_path / "mine")
    forget()
    yield tmp_path / "mine"
    forget()


def forget() -> None:
    """Act as another process, which has not imported the code."""
    for name in ("pond", "pond_depth"):
        sys.modules.pop(name, None)
        own_code._admitted.sources.pop(name, None)
        code._trusted.clear()


def begun(folder: Path) -> Path:
    primordia.run(str(folder / "task.toml"), folder / "run")
    forget()
    return folder / "run"


def elsewhere(folder: Path, run: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give the run to another user, who works in an empty folder."""
    other = folder.parent / "other"
    other.mkdir()
    shutil.copytree(run, other / "run")
    monkeypatch.chdir(other)
    monkeypatch.setenv("XDG_STATE_HOME", str(other / "state"))
    return other / "run"


def words(command: list[str], run: Path) -> list[str]:
    return [word.format(run=run, new=run.parent / "new") for word in command]


def test_a_bundle_executes_nothing_until_it_is_trusted(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = begun(folder)
    file = primordia.load(run).bundle(folder / "sent.zip")
    shutil.move(file, folder.parent / "sent.zip")
    elsewhere(folder, run, monkeypatch)
    for command in (["info"], ["plot", "--out", "figures", "--figure", "ages"]):
        assert here(command[0], folder.parent / "sent.zip", *command[1:]).returncode == 0
    assert "pond" not in sys.modules
    stopped = here("revive", folder.parent / "sent.zip", 3)
    complains(stopped, 2, "executes code that is not part of Primordia")
    assert "pond" not in sys.modules
    done = here("revive", folder.parent / "sent.zip", 3, "--trust")
    assert done.returncode == 0, done.stderr


def test_a_run_holds_the_code_that_it_executes(folder: Path) -> None:
    run = begun(folder)
    for name in PARTS:
        assert (run / "code" / name).read_bytes() == (folder / name).read_bytes()
    assert sorted(path.name for path in (run / "code").rglob("*")) == sorted(PARTS)
    assert tuple(Archive(run).description.code) == PARTS
    assert (
        not (primordia.run("CartPole-survival", folder / "ours", stop={"ticks": 1}))
        .path.joinpath("code")
        .exists()
    )


def test_code_from_elsewhere_is_executed_only_when_trusted(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = elsewhere(folder, begun(folder), monkeypatch)
    for command in LIVING:
        complains(here(*words(command, run)), 2, f"{run / 'code' / 'pond.py'}", "--trust")
    assert "pond" not in sys.modules
    assert not (run.parent / "new").exists()
    with pytest.raises(InputError, match="trust=True"):
        primordia.load(run).policy()
    trusting = [*words(LIVING[0], run), "--trust"]
    assert here(*trusting).returncode == 0
    for command in LIVING[1:]:
        forget()
        done = here(*words(command, run))
        assert (done.returncode, done.stderr) == (0, "")
    assert Archive(run.parent / "new").description.code == Archive(run).description.code
    forget()
    (run / "code" / "pond_depth.py").write_text("DEPTH = 4.0\n")
    complains(here("verify", run), 1, "pond_depth.py was changed or damaged")


def test_a_life_of_code_from_elsewhere_is_lived_again(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = elsewhere(folder, begun(folder), monkeypatch)
    oldest = primordia.load(run, trust=True).oldest()
    life = RelivedLife.of(oldest.run, oldest.id, oldest.world)
    assert sum(len(each.tick) for each in life.stretches()) == oldest.age == 21


@pytest.mark.parametrize("name", PARTS)
def test_a_run_does_not_go_on_with_changed_code(folder: Path, name: str) -> None:
    run = begun(folder)
    text = (folder / name).read_text().replace("> 20", "> 5") + "# changed\n"
    (folder / name).write_text(text)
    more = "resume", run, "--ticks", 70, "--quiet"
    complains(here(*more), 2, f"{folder / name} has changed", "--inexact")
    complains(here(*more, "--inexact"), 2, f"{folder / name}", "--trust")
    assert here("verify", run).returncode == 0, "a run executes its own copy"
    forget()
    done = here(*more, "--inexact", "--trust")
    assert (done.returncode, done.stderr) == (0, "")
    assert not primordia.load(run).info()["exact"]


def test_looking_executes_no_code_of_a_run(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = elsewhere(folder, begun(folder), monkeypatch)
    twin = shutil.copytree(run, run.parent / "twin")
    text = (run / "config.toml").read_text().replace("[stop]", "[stopp]")
    for command in (
        ["info", run],
        ["info", run, "--json"],
        ["plot", run, "--out", run.parent / "figures"],
        ["report", run, "--out", run.parent / "report.html"],
        ["export", run, run.parent / "genome.safetensors"],
        ["lineage", run, "--out", run.parent / "lineage.csv"],
        ["compare", run, twin, "--out", run.parent],
    ):
        done = here(*command)
        assert done.returncode == 0, done.stderr
    opened = primordia.load(run)
    assert len(opened.lives()) == opened.table("births").num_rows > 8
    assert len(opened.rebuild(0)) == Archive(run).layout.length
    (run / "config.toml").write_text(text)
    complains(here("info", run), 2, "stopp")
    assert not {"pond", "pond_depth"} & set(sys.modules)


@pytest.mark.parametrize(
    ("start", "task"),
    [
        (COMMAND, "Pong-survival"),
        ([str(Path(sys.executable).with_name("primordia"))], "CartPole-survival"),
    ],
)
def test_no_file_of_the_current_folder_takes_the_place_of_an_installed_one(
    tmp_path: Path, start: list[str], task: str
) -> None:
    names = "numpy", "click", "jax", "tomllib", "platformdirs", "libtpu", "sitecustomize", "mmap"
    for name in names:
        (tmp_path / f"{name}.py").write_text("raise SystemExit('from the current folder')\n")
    small = ["--ticks", "1", "--cells", "2", "--quiet", "--out", "run"]
    done = subprocess.run(
        [*start, "run", task, *small],
        cwd=tmp_path,
        env={**environment(), "PRIMORDIA_CORES": "2"},
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_parts_in_several_files_are_trusted_together(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the trust cannot be stored, as in a home folder that is read-only."""
    mutation = (
        "from primordia.mutations.gaussian import Gaussian\n\n\nclass Own(Gaussian):\n    pass\n"
    )
    (folder / "pond_mutation.py").write_text(mutation)
    (folder / "task.toml").write_text(
        'mutation = { kind = "pond_mutation:Own" }\n' + (folder / "task.toml").read_text()
    )
    run = elsewhere(folder, begun(folder), monkeypatch)
    sys.modules.pop("pond_mutation")
    genome = run.parent / "genome.safetensors"
    complains(here("export", run, genome), 2, "pond_mutation.py", "--trust")
    monkeypatch.setenv("XDG_STATE_HOME", "/proc/nothing")
    for command in (["export", run, genome, "--trust"], [*words(LIVING[3], run), "--trust"]):
        done = here(*command)
        assert (done.returncode, done.stderr) == (0, "")


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


def test_edited_code_changes_no_life_on_record(folder: Path) -> None:
    run = begun(folder)
    before = primordia.load(run).oldest()
    lifespan = before.age
    forget()
    (folder / "pond.py").write_text(POND.replace("> 20", "> 5"))
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


def test_what_goes_to_another_process_is_what_a_module_imports(folder: Path) -> None:
    (folder / "lake.py").write_text("DEPTH = 1\n")
    for module in ("pond", "lake"):
        own_code.admit(own_code.found(module))
    assert set(own_code.admitted(["pond"])) == {"pond.py", "pond_depth.py"}
    assert own_code.admitted(["numpy", "primordia.cores"]) == {}
    own_code._admitted.sources.pop("lake")


def test_a_module_that_was_imported_before_goes_to_another_process_too(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(folder)
    importlib.import_module("pond")
    assert "pond" not in own_code._admitted.sources
    assert set(own_code.admitted(["pond"])) == {"pond.py", "pond_depth.py"}


def forged(run: Path, **habitat: str) -> None:
    """Let a run name another habitat and hold no code, and seal it again."""
    values = tomllib.loads((run / "config.toml").read_text())
    values["habitat"] = habitat
    (run / "config.toml").write_text(tomli_w.dumps(values))
    shutil.rmtree(run / "code")
    about = json.loads((run / "description.json").read_text())
    (run / "description.json").write_text(json.dumps({**about, "code": {}}))
    reseal(newest(run))


def test_a_run_of_a_stranger_chooses_no_function_of_an_installed_package(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = begun(folder)
    forged(run, name="gymnax", env="pytest:main")
    called: list[object] = []
    monkeypatch.setattr(pytest, "main", lambda: called.append(1))
    for command in LIVING:
        complains(here(*words(command, run)), 2, "pytest:main", "--trust")
    assert not called
    complains(here(*words(LIVING[0], run), "--trust"), 2, "pytest:main has no default_params")


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


@pytest.mark.parametrize("name", ["gymnasium", "gymnax"])
@pytest.mark.parametrize("env", ["evil:", "evil:Pond", "IPython.__main__:", "gymnax.utils:x"])
def test_every_module_that_a_run_of_a_stranger_names_is_asked_for(
    env: str, name: str, folder: Path
) -> None:
    run = begun(folder)
    forged(run, name=name, env=env)
    (folder / "evil.py").write_text("open('executed', 'w')")
    assert (
        here(*words(LIVING[0], run)).returncode == 2
    )  # the code is new, so `resume` stops earlier
    for command in LIVING[1:]:
        complains(here(*words(command, run)), 2, env.partition(":")[0], "--trust")
    assert not (folder / "executed").exists()
    assert "evil" not in sys.modules


HIDDEN = """
import importlib

importlib.import_module("pond_" + "depth")
"""


def test_code_that_is_imported_in_a_hidden_way_is_trusted_too(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run of the same stranger may hold the trusted file beside another one."""
    run = elsewhere(folder, begun(folder), monkeypatch)
    other = Path(shutil.copytree(run, run.parent / "second"))
    for each, depth in ((run, "DEPTH = 3.0"), (other, "DEPTH = 3.0; open('executed', 'w')")):
        (each / "code" / "pond.py").write_text(
            POND.replace("from pond_depth import DEPTH", HIDDEN).replace("= DEPTH", "= 3.0")
        )
        (each / "code" / "pond_depth.py").write_text(depth)
        about = json.loads((each / "description.json").read_text())
        code_ = {name: files.seal(each / "code" / name)["sha256"] for name in about["code"]}
        (each / "description.json").write_text(json.dumps({**about, "code": code_}))
        reseal(newest(each))
    assert here("evaluate", run, "--ticks", "9", "--games", "1", "--trust").returncode == 0
    forget()
    done = here("evaluate", other, "--ticks", "9", "--games", "1")
    complains(done, 2, str(other / "code" / "pond_depth.py"), "--trust")
    assert not Path("executed").exists()


def test_no_file_is_trusted_by_the_name_of_an_installed_part() -> None:
    text = "numpy:x"
    named = code.Code({}, frozenset([text]))
    held = code.Code({"a.py": own_code.Source(Path("a.py"), text.encode())})
    moved = code.Code({"b.py": own_code.Source(Path("a.py"), text.encode())})
    assert not named.marks & held.marks
    assert not held.marks & moved.marks
