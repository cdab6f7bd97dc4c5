"""Changes to a user's process: none when Primordia is imported, few when a run starts."""

import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

import jax
import pytest

import primordia
from primordia import device
from primordia.device import ISA_FLAG
from primordia.errors import InputError
from tests.commands import environment

TASK = "CartPole-survival"
LAW: dict[str, Any] = {"cells": 8, "hazard": 0.002, "stop": {"ticks": 50}}
SETTINGS = """
import os, sys
import jax
def settings():
    names = [name for name in dir(jax.config) if name.startswith("jax_")]
    read = {name: getattr(jax.config, name) for name in names}
    return read | {"async": jax.config.read("jax_cpu_enable_async_dispatch")}
variables, before, finders = dict(os.environ), settings(), list(sys.meta_path)
"""
LIVE = (
    SETTINGS
    + """
import primordia
primordia.load(sys.argv[1]).info()
assert (dict(os.environ), settings()) == (variables, before)
assert sys.meta_path == finders
from primordia.assays.subjects import of_run
of_run(primordia.load(sys.argv[1]).opened(), [(3, 0)])
assert settings() == before
assert {**os.environ, "XLA_FLAGS": ""} == {**variables, "XLA_FLAGS": ""}
law = {"cells": 8, "hazard": 0.002}
primordia.run("CartPole-survival", sys.argv[2], **law, stop={"ticks": 50})
primordia.load(sys.argv[2]).organism(3).genome()
assert settings() == before
print(primordia.load(sys.argv[2]).info()["versions"]["instruction_set"], os.environ["XLA_FLAGS"])
"""
)


X86 = platform.machine() in ("x86_64", "AMD64")
on_x86 = pytest.mark.skipif(not X86, reason="only there XLA has sets to choose from")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run in a law of other tests, whose code is kept for the processes that tests start."""
    path = tmp_path_factory.mktemp("device") / "run"
    return primordia.run(TASK, path, **LAW).path


def python(program: str, *words: object, flags: str = "") -> str:
    """Run a program in another process and return what it prints."""
    command = [sys.executable, "-c", program, *map(str, words)]
    flagged = environment() | {"XLA_FLAGS": flags}
    return subprocess.run(
        command, env=flagged, capture_output=True, text=True, check=True
    ).stdout.strip()


@pytest.mark.parametrize(
    ("flags", "allowed"),
    [
        pytest.param("--xla_force_host_platform_device_count=1", "AVX2", marks=pytest.mark.slow),
        ("", "AVX2"),
        pytest.param(f"{ISA_FLAG}=AVX", "AVX", marks=[pytest.mark.slow, on_x86]),
    ],
)
def test_a_run_is_limited_to_avx2_unless_the_user_chose_otherwise(
    run: Path, tmp_path: Path, flags: str, allowed: str
) -> None:
    """A run and a look at it change no other setting of the process."""
    printed = python(LIVE, run, tmp_path / "other", flags=flags)
    kept = flags if ISA_FLAG in flags else f"{flags} {ISA_FLAG}=AVX2".strip()
    if X86:
        assert printed.split(maxsplit=2)[1:] == [allowed, kept]


@pytest.mark.slow
@on_x86
def test_jax_that_the_user_started_is_left_alone_and_the_run_says_so(
    run: Path, tmp_path: Path
) -> None:
    printed = python("import jax; jax.devices()\n" + LIVE, run, tmp_path / "other")
    assert printed.split(maxsplit=2)[1:] == ["native"]


def test_a_run_without_optimisations_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its bits are others."""
    monkeypatch.delenv("XLA_FLAGS", raising=False)
    usual, name = device.instruction_set(), "jax_disable_most_optimizations"
    jax.config.update(name, True)
    try:
        assert device.instruction_set() == f"{usual} {name}"
    finally:
        jax.config.update(name, False)


@pytest.mark.parametrize(
    ("machine_", "flags", "cpu", "recorded"),
    [
        ("x86_64", "--xla_cpu_max_isa=AVX2", "sse avx2", "x86_64 AVX2"),
        ("AMD64", "--xla_b=1", "sse avx2", "AMD64 native --xla_b=1"),
        ("x86_64", "--xla_b=1 --xla_cpu_max_isa=AVX2", "sse avx",
         "x86_64 AVX2 (this machine has no AVX2) --xla_b=1"),
        ("x86_64", "--xla_cpu_max_isa=AVX2", None, "x86_64 AVX2"),
        ("aarch64", "--xla_cpu_max_isa=AVX2", "asimd", "aarch64"),
        ("aarch64", "--xla_c=1 --xla_a=2 --xla_dump_to=x", "asimd", "aarch64 --xla_a=2 --xla_c=1"),
        ("x86_64", "", "sse avx2", "x86_64 native"),
        ("x86_64", f"{ISA_FLAG}=AVX {ISA_FLAG}=SSE4_2", "sse avx2", "x86_64 SSE4_2"),
        ("x86_64", f"--xla_dump_to=/tmp {ISA_FLAG}=AVX2", "sse avx2", "x86_64 AVX2"),
        ("x86_64", "--xla_dump_hlo_as_text --xla_force_host_platform_device_count=2", "sse avx2",
         "x86_64 native"),
        ("x86_64", "--xla_backend_extra_options=-x --xla_cpu", "sse avx2",
         "x86_64 native --xla_backend_extra_options=-x --xla_cpu"),
        ("x86_64", f"--xla_b=1 {ISA_FLAG}=AVX2  --xla_allow_excess_precision=false", "sse avx2",
         "x86_64 AVX2 --xla_allow_excess_precision=false --xla_b=1"),
    ],
)  # fmt: skip
def test_the_instruction_set_is_that_of_the_machine_and_the_flags(
    machine_: str, flags: str, cpu: str | None, recorded: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(platform, "machine", lambda: machine_)
    monkeypatch.setenv("XLA_FLAGS", flags)
    monkeypatch.setattr(Path, "exists", lambda _: cpu is not None)
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: cpu)
    assert device.instruction_set() == recorded


@pytest.mark.parametrize(
    ("flags", "after"),
    [
        ("", "--xla_cpu_max_isa=AVX2"),
        (" --xla_b=1 ", "--xla_b=1 --xla_cpu_max_isa=AVX2"),
        ("--xla_cpu_max_isa=AVX --xla_b=1", "--xla_cpu_max_isa=AVX --xla_b=1"),
    ],
)
def test_the_limit_of_instructions_is_added_to_the_flags_unless_one_is_there(
    flags: str, after: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[bool] = []
    monkeypatch.setenv("XLA_FLAGS", flags)
    monkeypatch.setattr(device, "started", lambda: False)
    monkeypatch.setattr(jax, "devices", lambda: started.append(_is_asynchronous()))
    before = _is_asynchronous()
    try:
        jax.config.update("jax_cpu_enable_async_dispatch", True)
        device.prepare()
        assert _is_asynchronous(), "the option is restored"
    finally:
        jax.config.update("jax_cpu_enable_async_dispatch", before)
    assert os.environ["XLA_FLAGS"].strip() == after
    assert started == [False], "small calls are computed at once"


def _is_asynchronous() -> bool:
    return bool(jax.config.read("jax_cpu_enable_async_dispatch"))


def test_a_faulty_variable_is_an_error_and_the_option_is_restored(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail() -> None:
        raise RuntimeError("none")

    before = _is_asynchronous()
    monkeypatch.setattr(device, "started", lambda: False)
    monkeypatch.setenv("XLA_FLAGS", "flags.txt")
    with pytest.raises(InputError, match=r"^XLA_FLAGS: flags.txt names a file"):
        device.prepare()
    monkeypatch.setenv("XLA_FLAGS", "")
    monkeypatch.setattr(jax, "devices", fail)
    monkeypatch.setenv("JAX_PLATFORMS", "tpu")
    with pytest.raises(InputError, match=r"that the variable JAX_PLATFORMS=tpu allows"):
        device.prepare()
    monkeypatch.delenv("JAX_PLATFORMS")
    with pytest.raises(RuntimeError, match=r"^none$"):
        device.prepare()
    assert _is_asynchronous() == before


STARTING = """
import jax
from contextlib import suppress
from pathlib import Path
from primordia import device
devices = jax.config.jax_num_cpu_devices
assert not device.started() and not device.started()
device.prepare()
assert device.started() and jax.config.jax_num_cpu_devices == devices
names = []
for task in Path("/proc/self/task").iterdir():
    with suppress(OSError):  # a thread may end while its name is read
        names.append(task.joinpath("comm").read_text())
print(sum("XLA" in name for name in names))
"""


def test_jax_is_found_to_have_started_with_a_thread_for_each_core(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if not Path("/proc/self/task").is_dir():
        pytest.skip("needs Linux")
    monkeypatch.setenv("PRIMORDIA_CORES", "3")
    assert int(python(STARTING)) == 3


def test_jax_that_has_started_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(device, "started", lambda: True)
    monkeypatch.setenv("XLA_FLAGS", "flags.txt")
    device.prepare()
    assert os.environ["XLA_FLAGS"] == "flags.txt"


def test_the_selected_platform_is_the_default_in_a_block_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[str] = []
    real = jax.local_devices

    def local(backend: str) -> list[Any]:
        asked.append(backend)
        return real(backend=backend)

    monkeypatch.setattr(jax, "local_devices", local)
    monkeypatch.setattr(device, "default", lambda: None)  # a device of another platform
    config: Any = jax.config
    before = config.jax_default_device
    with device.selected("cpu"):
        assert config.jax_default_device == real(backend="cpu")[0]
    assert config.jax_default_device is before
    assert asked == ["cpu"]
