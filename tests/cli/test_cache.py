"""Compiled code on disk: kept by default, apart for each kind of processor, and left alone on demand.

Then variables of JAX with which no command can work; `tests/test_device.py` has others.
"""

import os
import subprocess
import sys
from pathlib import Path
from unittest.mock import MagicMock

import pytest

from primordia import own_code
from primordia.cli import cache
from primordia.errors import InputError
from primordia.runs import code
from tests.commands import COMMAND, complains, environment


@pytest.mark.slow
def test_a_command_keeps_its_compiled_code(tmp_path: Path) -> None:
    home = {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    others = ("JAX_COMPILATION_CACHE", "JAX_PERSISTENT_CACHE", "JAX_DISABLE_MOST", "XLA_FLAGS")
    variables = {
        name: value for name, value in environment().items() if not name.startswith(others)
    }

    def run(name: str, **more: str) -> set[str]:
        task = ["run", "CartPole-survival", "--ticks", "1", "--cells", "4", "--quiet"]
        done = subprocess.run(
            [*COMMAND, *task, "--out", str(tmp_path / name)],
            env=variables | home | more,
            capture_output=True,
            text=True,
        )
        assert (done.returncode, done.stderr) == (0, "")
        files = (tmp_path / "cache").rglob("*-cache")
        return {str(file.relative_to(tmp_path / "cache")) for file in files}

    assert run("first", JAX_ENABLE_COMPILATION_CACHE="false") == set()
    kept = run("second", JAX_PLATFORMS="cpu")
    assert kept
    assert all(file.startswith(f"primordia/compiled/{cache.processor()}/") for file in kept)
    assert run("third") == kept


def test_without_a_folder_nothing_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A container may start a process of a user that the system does not know."""
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR", raising=False)
    cache.keep_compiled_code()
    unknown = MagicMock(side_effect=RuntimeError("could not determine the home directory"))
    monkeypatch.setattr(cache, "user_cache_path", unknown)
    monkeypatch.setattr(code, "_store", unknown)
    monkeypatch.setattr(code, "_trusted", set())
    cache.keep_compiled_code()
    assert "JAX_COMPILATION_CACHE_DIR" not in os.environ
    code.trust(code.Code({"a.py": own_code.Source(Path("a.py"), b"")}))
    assert code._stored() == set()


@pytest.mark.parametrize("given", [True, False])
def test_the_users_own_settings_of_the_cache_stay(
    given: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without such settings, code that took 0.05 s to compile is kept, up to 1 GiB."""
    folder = tmp_path / "primordia" / "compiled" / cache.processor()
    defaults = {
        "JAX_COMPILATION_CACHE_DIR": str(folder),
        "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0.05",
        "JAX_COMPILATION_CACHE_MAX_SIZE": "1073741824",
    }
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    for name in defaults:
        monkeypatch.setenv(name, "7")
        if not given:
            monkeypatch.delenv(name)
    cache.keep_compiled_code()
    expected = dict.fromkeys(defaults, "7") if given else defaults
    assert {name: os.environ[name] for name in defaults} == expected


def test_the_folder_is_set_before_jax_checks_the_users_variables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR", raising=False)
    monkeypatch.setenv("JAX_PLATFORMS", "cpu")
    monkeypatch.setitem(sys.modules, "jax", None)
    with pytest.raises(ImportError):
        cache.prepare_jax()
    assert os.environ["JAX_COMPILATION_CACHE_DIR"].startswith(str(tmp_path))


def test_each_kind_of_processor_has_its_own_folder(tmp_path: Path) -> None:
    """Arm and Intel have different names for features. Only the features of the first core count."""

    def named(line: str, value: str, clock: int = 2000, other: str = "x") -> str:
        core = f"processor : 0\n{line} : {value}\nBogoMIPS : {clock}\n"
        (tmp_path / "cpuinfo").write_text(f"{core}\nprocessor : 1\n{line} : {other}\n")
        return cache.processor(tmp_path / "cpuinfo")

    for line in ("model name", "flags", "CPU implementer", "CPU part", "Features"):
        one = named(line, "x")
        assert named(line, "y") != one
        assert named(line, "x", clock=3000, other="y") == one
        assert cache.processor(tmp_path / "missing") != one


def test_a_variable_that_jax_refuses_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """JAX reads its variables when it is imported, which is done here only if one of them is set."""
    (tmp_path / "jax.py").write_text("raise ValueError('invalid truth value')")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "jax")
    for name in [name for name in os.environ if name.startswith("JAX_")]:
        monkeypatch.delenv(name)
    cache.prepare_jax()
    monkeypatch.setenv("JAX_ENABLE_X64", "maybe")
    with pytest.raises(InputError, match=r"^JAX does not start: invalid truth value; correct or"):
        cache.prepare_jax()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("JAX_ENABLE_X64", "maybe", "JAX does not start: invalid truth value 'maybe'"),
        ("JAX_PLATFORMS", "abacus", "JAX_PLATFORMS=abacus allows"),
    ],
)
def test_a_wrong_variable_is_an_error(name: str, value: str, says: str, tmp_path: Path) -> None:
    words = "run", "CartPole-survival", "--ticks", "5", "--quiet", "--out", str(tmp_path / "run")
    variables = environment() | {name: value}
    done = subprocess.run([*COMMAND, *words], env=variables, capture_output=True, text=True)
    complains(done, 2, says)
