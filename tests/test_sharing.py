"""Devices that share a run's worlds, and what a run records of its device."""

import os
import platform
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax
import pytest

from primordia import device
from primordia.errors import InputError


def devices(*kinds: str) -> list[Any]:
    return [
        SimpleNamespace(id=number, platform="gpu", device_kind=kind)
        for number, kind in enumerate(kinds)
    ]


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that gives this process devices; the default one is that of a number."""

    def given(default: int, *kinds: str) -> list[Any]:
        local = devices(*kinds)
        monkeypatch.setattr(device, "default", lambda: local[default])
        monkeypatch.setattr(jax, "local_devices", lambda backend: local if backend == "gpu" else [])
        return local

    return given


@pytest.mark.parametrize(
    ("worlds", "number"),
    [(1, 1), (2, 2), (3, 3), (4, 4), (5, 1), (6, 3), (7, 1), (8, 4), (9, 3), (10, 2), (12, 4)],
)
def test_all_devices_take_the_same_number_of_worlds(worlds: int, number: int, machine: Any) -> None:
    """Of four devices."""
    local = machine(0, *["a"] * 4)
    assert device.sharing(worlds) == local[:number]


def test_the_default_device_is_the_first_and_only_those_of_its_kind_share(machine: Any) -> None:
    local = machine(2, "a", "b", "a", "b", "a")
    assert device.sharing(6) == [local[2], local[0], local[4]]
    assert device.sharing(2) == [local[2], local[0]]
    local = machine(1, "a", "b", "a")
    assert device.sharing(6) == [local[1]]


@pytest.mark.parametrize(("name", "kind"), [("cpu", "cpu"), ("gpu", "H100")])
def test_a_run_records_the_kind_of_a_device_that_is_no_cpu(
    name: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = SimpleNamespace(platform=name, device_kind="H100")
    monkeypatch.setattr(device, "default", lambda: own)
    assert device.versions() == {
        **{each: version(each) for each in ("primordia", "jax", "jaxlib", "numpy")},
        "device": kind,
        "instruction_set": device.instruction_set(),
    }


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
    monkeypatch.setattr(device, "backends_are_initialized", lambda: False)
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


def test_faults_of_variables_are_told_and_the_option_is_restored(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail() -> None:
        raise RuntimeError("none")

    before = _is_asynchronous()
    monkeypatch.setattr(device, "backends_are_initialized", lambda: False)
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


def test_jax_that_has_started_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(device, "backends_are_initialized", lambda: True)
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
    config: Any = jax.config
    before = config.jax_default_device
    with device.selected("cpu"):
        assert config.jax_default_device == real(backend="cpu")[0]
    assert config.jax_default_device is before
    assert asked == ["cpu"]
