"""Changes to a user's process: none when Primordia is imported, few when a run starts."""

import platform
import subprocess
import sys
from pathlib import Path

import pytest

import primordia
from primordia import device
from primordia.device import ISA_FLAG
from tests.commands import environment

SETTINGS = """
import os, sys
import jax
def settings():
    names = [name for name in dir(jax.config) if name.startswith("jax_")]
    read = {name: getattr(jax.config, name) for name in names}
    return read | {"async": jax.config.read("jax_cpu_enable_async_dispatch")}
variables, before, finders = dict(os.environ), settings(), list(sys.meta_path)
"""
LOOK = (
    SETTINGS
    + """
import primordia
primordia.load(sys.argv[1]).info()
assert (dict(os.environ), settings()) == (variables, before)
assert sys.meta_path == finders
"""
)
LIVE = (
    SETTINGS
    + """
import primordia
primordia.load(sys.argv[1]).rebuild(3)
assert settings() == before
assert {**os.environ, "XLA_FLAGS": ""} == {**variables, "XLA_FLAGS": ""}
primordia.run("CartPole-survival", sys.argv[2], cells=8, stop={"ticks": 50})
assert settings() == before
print(primordia.load(sys.argv[2]).info()["versions"]["instruction_set"], os.environ["XLA_FLAGS"])
"""
)


on_x86 = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="only there XLA has sets to choose from"
)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("device") / "run"
    return primordia.run("CartPole-survival", path, cells=8, stop={"ticks": 50}).path


def python(program: str, *words: object, flags: str = "") -> str:
    """Run a program in another process and return what it prints."""
    command = [sys.executable, "-c", program, *map(str, words)]
    flagged = environment() | {"XLA_FLAGS": flags}
    return subprocess.run(
        command, env=flagged, capture_output=True, text=True, check=True
    ).stdout.strip()


def test_looking_at_a_run_changes_no_setting_of_the_process(run: Path) -> None:
    python(LOOK, run)


@on_x86
@pytest.mark.parametrize(
    ("flags", "allowed"),
    [("", "AVX2"), ("--xla_cpu_use_fusion_emitters=false", "AVX2"), (f"{ISA_FLAG}=AVX", "AVX")],
)
def test_a_run_is_limited_to_avx2_unless_the_user_chose_otherwise(
    run: Path, tmp_path: Path, flags: str, allowed: str
) -> None:
    printed = python(LIVE, run, tmp_path / "other", flags=flags)
    kept = flags if ISA_FLAG in flags else f"{flags} {ISA_FLAG}=AVX2".strip()
    assert printed.split(maxsplit=2)[1:] == [allowed, kept]


@on_x86
@pytest.mark.parametrize(
    ("flags", "recorded"),
    [
        ("", "native"),
        (f"{ISA_FLAG}=AVX {ISA_FLAG}=SSE4_2", "SSE4_2"),
        (f"--xla_dump_to=/tmp {ISA_FLAG}=AVX2 --xla_cpu_use_fusion_emitters=false", "AVX2"),
        (
            f"--xla_b=1 {ISA_FLAG}=AVX2  --xla_allow_excess_precision=false",
            "AVX2 --xla_allow_excess_precision=false --xla_b=1",
        ),
    ],
)
def test_flags_that_may_change_bits_are_part_of_the_instruction_set(
    monkeypatch: pytest.MonkeyPatch, flags: str, recorded: str
) -> None:
    monkeypatch.setenv("XLA_FLAGS", flags)
    assert device.instruction_set() == f"{platform.machine()} {recorded}"


@pytest.mark.slow
@on_x86
def test_jax_that_the_user_started_is_left_alone_and_the_run_says_so(
    run: Path, tmp_path: Path
) -> None:
    printed = python("import jax; jax.devices()\n" + LIVE, run, tmp_path / "other")
    assert printed.split(maxsplit=2)[1:] == ["native"]
