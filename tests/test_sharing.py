"""Devices that share the worlds of a run, and the device that a run records."""

from importlib.metadata import version
from types import SimpleNamespace
from typing import Any

import jax
import pytest

from primordia import device


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
