"""Code of a stranger's run: it is executed only when trusted, and never by looking."""

import json
import shutil
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
import tomli_w

import primordia
from primordia import files, own_code
from primordia.errors import InputError
from primordia.runs import code
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.report.unpacked import content_of
from tests.strangers import LIVING, POND, TASK, begun, elsewhere, forget, words
from tests.trouble import newest, reseal


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
    forget()
    done = here(*words(LIVING[2], run))
    assert (done.returncode, done.stderr) == (0, ""), "trust is kept for other commands"
    assert here("report", run).returncode == 0
    assert "draws no pictures" in content_of(run / "report.html")["films"]["missing"]
    assert Archive(run.parent / "new").description.code == Archive(run).description.code
    forget()
    (run / "code" / "pond_depth.py").write_text("DEPTH = 4.0\n")
    complains(here("verify", run), 1, "pond_depth.py was changed or damaged")


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
        ["phylogeny", run, "--out", run.parent / "phylogeny.csv"],
        ["compare", run, twin, "--out", run.parent],
        ["bundle", run, run.parent / "sent.zip"],
        ["info", run.parent / "sent.zip"],
    ):
        done = here(*command)
        assert done.returncode == 0, done.stderr
    films = content_of(run.parent / "report.html")["films"]
    assert films["films"] == []
    assert "--trust" in films["missing"]
    opened = primordia.load(run)
    assert len(opened.lives()) == opened.table("births").num_rows > 8
    assert len(opened.organism(0).genome()) == Archive(run).layout.length
    (run / "config.toml").write_text(text)
    complains(here("info", run), 2, "stopp")
    assert not {"pond", "pond_depth"} & set(sys.modules)


@pytest.mark.slow
def test_a_mutation_is_trusted_with_its_habitat(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the trust cannot be stored, as in a home folder that is read-only."""
    base = "from primordia.mutations.gaussian import Gaussian"
    (folder / "pond_mutation.py").write_text(f"{base}\n\n\nclass Own(Gaussian):\n    pass\n")
    (folder / "task.toml").write_text(
        TASK.replace("[mutation]\n", '[mutation]\nkind = "pond_mutation:Own"\n')
    )
    run = elsewhere(folder, begun(folder), monkeypatch)
    sys.modules.pop("pond_mutation")
    genome = run.parent / "genome.safetensors"
    complains(here("export", run, genome), 2, "pond_mutation.py", "--trust")
    monkeypatch.setenv("XDG_STATE_HOME", "/proc/nothing")
    for command in (["export", run, genome, "--trust"], [*words(LIVING[3], run), "--trust"]):
        done = here(*command)
        assert (done.returncode, done.stderr) == (0, "")


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


@pytest.mark.parametrize(
    ("name", "env"),
    [("gymnasium", "evil:"), ("gymnasium", "IPython.__main__:"), ("gymnax", "evil:Pond")],
)
def test_every_module_that_a_run_of_a_stranger_names_is_asked_for(
    name: str, env: str, folder: Path
) -> None:
    run = begun(folder)
    forged(run, name=name, env=env)
    (folder / "evil.py").write_text("open('executed', 'w')")
    assert here(*words(LIVING[0], run)).returncode == 2, "it is new, so `resume` stops earlier"
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
    assert here("verify", run, "--trust").returncode == 0
    forget()
    done = here("verify", other)
    complains(done, 2, str(other / "code" / "pond_depth.py"), "--trust")
    assert not Path("executed").exists()


def test_no_file_is_trusted_by_the_name_of_an_installed_part() -> None:
    text = "numpy:x"
    named = code.Code({}, frozenset([text]))
    held = code.Code({"a.py": own_code.Source(Path("a.py"), text.encode())})
    moved = code.Code({"b.py": own_code.Source(Path("a.py"), text.encode())})
    assert not named.marks & held.marks
    assert not held.marks & moved.marks


def test_an_installed_part_with_which_the_user_began_is_trusted(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kind = "primordia.mutations.gaussian:Gaussian"
    task = f"task = 'CartPole-survival'\ncells = 16\nmutation = {{ kind = '{kind}' }}"
    (folder / "task.toml").write_text(f"{task}\nstop = {{ ticks = 60, until = 'none' }}")
    monkeypatch.setattr("primordia.runs.loop.drive", lambda *_: None)  # nothing need be lived
    run = begun(folder)
    assert here(*words(LIVING[0], run)).returncode == 0
    run = elsewhere(folder, run, monkeypatch)
    complains(here(*words(LIVING[0], run)), 2, "gaussian:Gaussian", "--trust")
    assert here(*words(LIVING[0], run), "--trust").returncode == 0
    assert here(*words(LIVING[0], run)).returncode == 0, "once is enough"


def test_only_changed_and_new_files_are_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    texts = {"same.py": b"1", "new.py": b"2", "edited.py": b"3"}
    sources = {name: own_code.Source(Path("at", name), text) for name, text in texts.items()}
    monkeypatch.setattr(code, "found", lambda _: code.Code(sources))
    recorded = {"same.py": sources["same.py"].sha256, "edited.py": "0" * 64, "gone.py": "1" * 64}
    settings: Any = None
    assert code.changes(settings, recorded) == ["at/edited.py has changed", "at/new.py is new"]


def test_trust_is_stored_once_and_keeps_earlier_trust(folder: Path) -> None:
    first = code.Code({"a.py": own_code.Source(Path("a.py"), b"1")}, frozenset(["x:y"]))
    both = code.Code({**first.files, "b.py": own_code.Source(Path("b.py"), b"2")})
    assert len(first.marks) == len(both.marks) == 2
    for each, lines in ((first, 2), (first, 2), (both, 3), (both, 3)):
        code.trust(each)
        stored = code._store().read_text(encoding="utf-8").splitlines()
        assert len(stored) == len({*stored}) == lines
    assert {*stored} == first.marks | both.marks
    assert code._store() == folder.parent / "state" / "primordia" / "trusted"
